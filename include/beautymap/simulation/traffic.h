// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "beautymap/simulation/actor.h"
#include "beautymap/simulation/ground.h"
#include "beautymap/simulation/streetside.h"

namespace beautymap::simulation {

/// One lane along the x axis on which cars follow each other at one speed, for ever.
struct Lane {
  double y_m = 0.0;
  double speed_m_s = 8.0;  ///< negative: towards negative x
  double gap_m = 30.0;     ///< mean distance from car to car
};

void addLaneTraffic(const StreetPlan& plan, const Ground& ground, const Lane& lane,
                    std::vector<Actor>& actors);

/// People on both sidewalks in both directions. @param spacing_m mean distance from one to the
/// next.
void addSidewalkTraffic(const StreetPlan& plan, const Ground& ground, double spacing_m,
                        std::vector<Actor>& actors);

/// People who cross the road, each at a moment at which no car and not the sensor's vehicle is
/// near.
/// @param vehicles the motions to keep clear of.
void addCrossingPeople(const StreetPlan& plan, const Ground& ground, double duration_s,
                       const std::vector<Motion>& vehicles, std::vector<Actor>& actors);

/// A height between 1.5 and 1.92 m; the sedan three times out of four.
double randomHeight(std::uint64_t key);
CarKind randomCarKind(std::uint64_t key);

}  // namespace beautymap::simulation
