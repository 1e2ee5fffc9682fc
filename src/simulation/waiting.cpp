// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <vector>

#include "beautymap/simulation/random.h"
#include "beautymap/simulation/scene.h"
#include "beautymap/simulation/streetside.h"
#include "beautymap/simulation/traffic.h"

namespace beautymap::simulation {
namespace {

constexpr double kInnerLane_m = 1.75;
constexpr double kOuterLane_m = 5.25;
constexpr double kCarToCar_m = 6.6;
constexpr double kSpeed_m_s = 8.0;

/// Cars that stand one behind the other and leave one after the other.
/// @param path along the lane. @param stop_m where the first one stands on it.
void addQueue(const Path& path, double stop_m, int cars, double leave_s,
              std::vector<Actor>& actors) {
  constexpr double kReaction_s = 0.5;
  for (int i = 0; i < cars; ++i) {
    const CarKind kind = i == 1 ? CarKind::kVan : CarKind::kSedan;
    actors.push_back(makeCar(kind, standAndLeave(path, stop_m - i * kCarToCar_m,
                                                 leave_s + i * kReaction_s, kSpeed_m_s)));
  }
}

/// People who wait on the sidewalk and then walk on.
void addWaitingPeople(const StreetPlan& plan, const Ground& ground, double leave_s,
                      std::vector<Actor>& actors) {
  constexpr int kPeople = 5;
  Random random(hashOf(plan.seed, 0x3a17));
  for (int i = 0; i < kPeople; ++i) {
    const double side = i % 2 == 0 ? -1.0 : 1.0;
    const double y = side * (plan.kerb_y_m + random.uniform(kWalkNear_m, kWalkFar_m));
    const Path path = pathAlong(ground, plan.begin_x_m, plan.end_x_m, y);
    const double stand = 16.0 + 4.0 * i + random.uniform(0.0, 2.0) - plan.begin_x_m;
    actors.push_back(makePedestrian(
        randomHeight(random.bits()),
        standAndLeave(path, stand, leave_s + random.uniform(0.0, 1.0), random.uniform(1.0, 1.5))));
  }
}

}  // namespace

/// Four lanes. On the sensor's right and on its left cars stand at a light and leave in the middle
/// of the recording; on the far left others arrive and stay. The sensor rolls past them.
Scene makeWaiting(double duration_s, std::uint64_t seed) {
  StreetPlan plan;
  plan.kerb_y_m = 9.5;
  plan.begin_x_m = -100.0;
  plan.end_x_m = 190.0;
  plan.parked_share = 0.4;
  plan.seed = hashOf(seed, 0x3a17);
  Scene scene;
  scene.ground = makeStreetGround(plan, Profile());
  scene.fixed = furnishStreet(plan, scene.ground);
  const auto lane = [&](double y) {
    return y < 0.0 ? pathAlong(scene.ground, plan.begin_x_m, plan.end_x_m, y)
                   : pathAlong(scene.ground, plan.end_x_m, plan.begin_x_m, y);
  };
  const double zero = -plan.begin_x_m;  // where x = 0 is on the lanes in the sensor's direction
  const double speed = std::min(5.0, 70.0 / duration_s);
  const Path own = lane(-kInnerLane_m);
  scene.sensor = swayAlong(own, speed, zero, 0.0);
  scene.actors.push_back(makeCar(CarKind::kSedan, swayAlong(own, speed, zero + 26.0, 3.0)));

  addQueue(lane(-kOuterLane_m), zero + 52.0, 3, 0.5 * duration_s, scene.actors);
  addQueue(lane(kInnerLane_m), plan.end_x_m - 14.0, 3, 0.45 * duration_s, scene.actors);
  for (int i = 0; i < 3; ++i) {
    const double stop = plan.end_x_m - (9.0 + i * kCarToCar_m);
    scene.actors.push_back(makeCar(
        CarKind::kSedan,
        arriveAndStay(lane(kOuterLane_m), stop, (0.2 + 0.12 * i) * duration_s, kSpeed_m_s)));
  }
  std::vector<Motion> vehicles{scene.sensor};
  for (const Actor& actor : scene.actors) vehicles.push_back(actor.motion);
  addWaitingPeople(plan, scene.ground, 0.5 * duration_s, scene.actors);
  addSidewalkTraffic(plan, scene.ground, 18.0, scene.actors);
  addCrossingPeople(plan, scene.ground, duration_s, vehicles, scene.actors);
  return scene;
}

}  // namespace beautymap::simulation
