// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/simulation/traffic.h"

#include <cmath>
#include <optional>

#include "beautymap/simulation/random.h"

namespace beautymap::simulation {
namespace {

using Eigen::Vector3d;

/// From one sidewalk over the road to the other, and on along it.
Path crossingPath(const StreetPlan& plan, const Ground& ground, double x, double side) {
  constexpr double kApproach_m = 60.0;
  const double y = plan.kerb_y_m + 2.6;
  std::vector<Vector3d> points;
  const auto add = [&](double at_x, double at_y) {
    points.emplace_back(at_x, at_y, ground.height(at_x, at_y));
  };
  for (double along = kApproach_m; along > 0.0; along -= 3.0) add(x - side * along, -side * y);
  for (double across = -y; across <= y; across += 0.5) add(x, side * across);
  for (double along = 3.0; along <= kApproach_m; along += 3.0) add(x + side * along, side * y);
  return Path(std::move(points));
}

bool keepsClear(const Motion& person, const std::vector<Motion>& vehicles, double kerb_y_m,
                double from_s, double to_s) {
  constexpr double kClear_m = 4.5;
  constexpr double kStep_s = 0.2;
  for (double time_s = from_s; time_s < to_s; time_s += kStep_s) {
    const Vector3d position = person(time_s).position;
    if (std::abs(position.y()) > kerb_y_m + 1.0) continue;
    for (const Motion& vehicle : vehicles) {
      if ((vehicle(time_s).position - position).head<2>().norm() < kClear_m) return false;
    }
  }
  return true;
}

}  // namespace

double randomHeight(std::uint64_t key) { return 1.5 + 0.42 * unitFromBits(hashOf(key, 0x4e1)); }

CarKind randomCarKind(std::uint64_t key) {
  const double kind = unitFromBits(hashOf(key, 0xca2));
  if (kind < 0.03) return CarKind::kTruck;
  return kind < 0.2 ? CarKind::kVan : CarKind::kSedan;
}

void addLaneTraffic(const StreetPlan& plan, const Ground& ground, const Lane& lane,
                    std::vector<Actor>& actors) {
  const bool forward = lane.speed_m_s > 0.0;
  const Path path = forward ? pathAlong(ground, plan.begin_x_m, plan.end_x_m, lane.y_m)
                            : pathAlong(ground, plan.end_x_m, plan.begin_x_m, lane.y_m);
  Random random(hashOf(plan.seed, 0x1a4e, static_cast<std::int64_t>(lane.y_m * 100.0)));
  const double speed = std::abs(lane.speed_m_s);
  for (double start = 0.0; start < path.length() - 0.5 * lane.gap_m;
       start += lane.gap_m * random.uniform(0.6, 1.4)) {
    actors.push_back(makeCar(randomCarKind(random.bits()), loopAlong(path, speed, start)));
  }
}

void addSidewalkTraffic(const StreetPlan& plan, const Ground& ground, double spacing_m,
                        std::vector<Actor>& actors) {
  Random random(hashOf(plan.seed, 0x51de));
  for (const double side : {-1.0, 1.0}) {
    for (double start = 0.0; start < plan.end_x_m - plan.begin_x_m;
         start += spacing_m * random.uniform(0.2, 1.8)) {
      const double y = side * (plan.kerb_y_m + random.uniform(kWalkNear_m, kWalkFar_m));
      const double speed = random.uniform(0.8, 1.7);
      const Path path = random.chance(0.5) ? pathAlong(ground, plan.begin_x_m, plan.end_x_m, y)
                                           : pathAlong(ground, plan.end_x_m, plan.begin_x_m, y);
      actors.push_back(makePedestrian(randomHeight(random.bits()), loopAlong(path, speed, start)));
    }
  }
}

void addCrossingPeople(const StreetPlan& plan, const Ground& ground, double duration_s,
                       const std::vector<Motion>& vehicles, std::vector<Actor>& actors) {
  constexpr int kTries = 40;
  constexpr int kPeople = 3;
  const double period = 2.0 * kBlockLength_m;
  Random random(hashOf(plan.seed, 0xc405));
  const double first = std::ceil(plan.begin_x_m / period) * period + kCrossingInBlock_m;
  for (double x = first; x < plan.end_x_m; x += period) {
    int people = 0;
    for (int i = 0; i < kTries && people < kPeople; ++i) {
      const double side = random.chance(0.5) ? 1.0 : -1.0;
      const double speed = random.uniform(1.1, 1.6);
      const double middle_s = random.uniform(-2.0, duration_s + 2.0);
      Path path = crossingPath(plan, ground, x + random.uniform(-1.5, 1.5), side);
      const double start = 0.5 * path.length() - speed * middle_s;
      const Motion motion = swayAlong(std::move(path), speed, start, 0.0);
      const double half_s = (plan.kerb_y_m + 2.0) / speed;
      if (!keepsClear(motion, vehicles, plan.kerb_y_m, middle_s - half_s, middle_s + half_s)) {
        continue;
      }
      actors.push_back(makePedestrian(randomHeight(random.bits()), motion));
      ++people;
    }
  }
}

}  // namespace beautymap::simulation
