// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "beautymap/simulation/actor.h"
#include "beautymap/simulation/motion.h"

namespace beautymap::simulation {

/// Somebody whom walkers step aside for.
struct Avoided {
  Motion motion;
  double radius_m = 0.0;
};

/// A room full of people who walk from place to place.
struct WalkerPlan {
  Eigen::AlignedBox2d area;
  double floor_z_m = 0.0;
  std::vector<Eigen::AlignedBox2d> obstacles;
  std::vector<Avoided> avoided;
  int people = 0;
  double duration_s = 10.0;
  std::uint64_t seed = 0;
};

/// Simulates all walkers together (they keep their distance from each other, from obstacles and
/// from those to be avoided) and gives each a track.
std::vector<Actor> makeWalkers(const WalkerPlan& plan);

}  // namespace beautymap::simulation
