// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "beautymap/simulation/actor.h"
#include "beautymap/simulation/ground.h"
#include "beautymap/simulation/path.h"
#include "beautymap/simulation/shape.h"

namespace beautymap::simulation {

/// A road along the scene's x axis. Blocks of a fixed length are furnished each by its own random
/// numbers, so a longer street begins like a shorter one.
struct StreetPlan {
  double begin_x_m = -120.0;
  double end_x_m = 120.0;
  double kerb_y_m = 6.5;       ///< half the width of the road, parking lanes included
  double cross_slope = 0.0;    ///< rise per metre to the left, over the road's whole width
  double parked_share = 0.55;  ///< of the parking places
  std::uint64_t seed = 0;
};

constexpr double kBlockLength_m = 35.0;
constexpr double kSidewalkWidth_m = 4.2;
/// Pedestrians walk between these distances from the kerb; trees and poles stand before them.
constexpr double kWalkNear_m = 2.0;
constexpr double kWalkFar_m = 3.7;
/// Where people cross, within each second block.
constexpr double kCrossingInBlock_m = 31.0;

/// No road is flat: adds bumps of a centimetre each few metres.
Profile withBumps(const Profile& hills, double begin_m, double end_m, std::uint64_t seed);

/// @param hills along the road; small bumps are added to it.
Ground makeStreetGround(const StreetPlan& plan, const Profile& hills);

/// Houses, shops, gardens, trees, lamps, signs, shelters and parked cars along both sides.
Shapes furnishStreet(const StreetPlan& plan, const Ground& ground);

/// A straight way at a constant y that follows the ground.
Path pathAlong(const Ground& ground, double from_x_m, double to_x_m, double y_m);
/// A straight way at a constant x that follows the ground.
Path pathAcross(const Ground& ground, double x_m, double from_y_m, double to_y_m);

}  // namespace beautymap::simulation
