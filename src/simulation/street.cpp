// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <utility>
#include <vector>

#include "beautymap/simulation/random.h"
#include "beautymap/simulation/scene.h"
#include "beautymap/simulation/streetside.h"
#include "beautymap/simulation/traffic.h"

namespace beautymap::simulation {
namespace {

constexpr double kLane_m = 2.0;
constexpr double kCycle_m = 3.9;

std::vector<Motion> motionsOf(const std::vector<Actor>& actors) {
  std::vector<Motion> motions;
  for (const Actor& actor : actors) motions.push_back(actor.motion);
  return motions;
}

/// A two-lane street in which the sensor's car drives at `speed_m_s` between two others.
Scene makeDrive(const StreetPlan& plan, const Profile& hills, double speed_m_s, double duration_s) {
  Scene scene;
  scene.ground = makeStreetGround(plan, hills);
  scene.fixed = furnishStreet(plan, scene.ground);
  const Path right = pathAlong(scene.ground, plan.begin_x_m, plan.end_x_m, -kLane_m);
  const double start = -plan.begin_x_m;
  scene.sensor = swayAlong(right, speed_m_s, start, 0.0);

  scene.actors.push_back(makeCar(CarKind::kSedan, swayAlong(right, speed_m_s, start + 24.0, 4.0)));
  scene.actors.push_back(makeCar(CarKind::kVan, swayAlong(right, speed_m_s, start - 26.0, 3.0)));
  addLaneTraffic(plan, scene.ground, {kLane_m, -8.5, 75.0}, scene.actors);
  std::vector<Motion> vehicles = motionsOf(scene.actors);
  vehicles.push_back(scene.sensor);

  const Path ride = pathAlong(scene.ground, plan.begin_x_m, plan.end_x_m, -kCycle_m);
  const Path ride_back = pathAlong(scene.ground, plan.end_x_m, plan.begin_x_m, kCycle_m);
  scene.actors.push_back(makeCyclist(loopAlong(ride, 4.5, start + 12.0)));
  scene.actors.push_back(makeCyclist(loopAlong(ride_back, 5.0, plan.end_x_m - 55.0)));
  addSidewalkTraffic(plan, scene.ground, 13.0, scene.actors);
  addCrossingPeople(plan, scene.ground, duration_s, vehicles, scene.actors);
  return scene;
}

}  // namespace

Scene makeStreet(double duration_s, std::uint64_t seed) {
  constexpr double kSpeed_m_s = 6.5;
  StreetPlan plan;
  plan.end_x_m = 130.0 + kSpeed_m_s * duration_s;
  plan.seed = hashOf(seed, 0x57e7);
  return makeDrive(plan, Profile(), kSpeed_m_s, duration_s);
}

/// Ramps of 10 % up and 8 % down with rounded crests and dips, again and again.
Scene makeSlope(double duration_s, std::uint64_t seed) {
  constexpr double kSpeed_m_s = 6.0;
  constexpr double kPeriod_m = 190.0;
  StreetPlan plan;
  plan.end_x_m = 130.0 + kSpeed_m_s * duration_s;
  plan.cross_slope = 0.025;
  plan.parked_share = 0.45;
  plan.seed = hashOf(seed, 0x510e);

  // The grade over one period; what it climbs it also descends.
  const Profile grade(
      {{10.0, 0.0}, {30.0, 0.10}, {75.0, 0.10}, {95.0, -0.08}, {156.25, -0.08}, {176.25, 0.0}});
  std::vector<Eigen::Vector2d> knots;
  double height = 0.0;
  for (double x = plan.begin_x_m - 40.0; x < plan.end_x_m + 40.0; x += 1.0) {
    knots.emplace_back(x, height);
    height += grade.height(x + 0.5 - kPeriod_m * std::floor((x + 0.5) / kPeriod_m));
  }
  const double level = Profile(knots).height(0.0);
  for (Eigen::Vector2d& knot : knots) knot.y() -= level;
  return makeDrive(plan, Profile(std::move(knots)), kSpeed_m_s, duration_s);
}

}  // namespace beautymap::simulation
