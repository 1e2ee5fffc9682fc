// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/simulation/streetside.h"

#include <algorithm>
#include <cmath>

#include "beautymap/simulation/houses.h"
#include "beautymap/simulation/props.h"
#include "beautymap/simulation/random.h"
#include "beautymap/simulation/world.h"

namespace beautymap::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kKerbHeight_m = 0.13;

Profile crossSection(const StreetPlan& plan) {
  constexpr double kCrown = 0.02;     // the road falls that much per metre from its middle
  constexpr double kSidewalk = 0.02;  // the sidewalk rises that much per metre from the kerb
  constexpr double kKerbWidth_m = 0.02;
  const double w = plan.kerb_y_m;
  std::vector<Vector2d> right;
  right.emplace_back(w, -kCrown * w);
  right.emplace_back(w + kKerbWidth_m, -kCrown * w + kKerbHeight_m);
  right.emplace_back(w + kSidewalkWidth_m, right.back().y() + kSidewalk * kSidewalkWidth_m);
  right.emplace_back(w + 40.0, right.back().y());
  std::vector<Vector2d> knots;
  for (auto knot = right.rbegin(); knot != right.rend(); ++knot)
    knots.emplace_back(-knot->x(), knot->y());
  knots.emplace_back(0.0, 0.0);
  knots.insert(knots.end(), right.begin(), right.end());
  for (Vector2d& knot : knots) knot.y() += plan.cross_slope * knot.x();
  return Profile(std::move(knots));
}

bool nearCrossing(double x_m, double reach_m) {
  const double period = 2.0 * kBlockLength_m;
  const double offset = x_m - kCrossingInBlock_m;
  return std::abs(offset - period * std::round(offset / period)) < reach_m;
}

/// One block on one side of the road.
class BlockSide {
 public:
  BlockSide(const StreetPlan& plan, const Ground& ground, int block, double side, Shapes& shapes)
      : plan_(plan),
        ground_(ground),
        begin_x_(block * kBlockLength_m),
        side_(side),
        random_(hashOf(plan.seed, 0xb10c, block, side > 0.0)),
        shapes_(shapes) {}

  void furnish(bool has_shelter) {
    for (const double along : {2.0, 13.0, 24.0}) {
      if (along < 20.0 || !has_shelter) addTreeAt(begin_x_ + along);
    }
    addLampPost(spot(begin_x_ + 8.0 + (side_ > 0.0 ? 15.0 : 0.0), 0.6), -side_ * M_PI / 2.0,
                shapes_);
    const double sign_x = begin_x_ + random_.uniform(16.0, 19.0);
    addSign(spot(sign_x, 0.5), random_.uniform(-0.3, 0.3), shapes_);
    addBin(spot(begin_x_ + random_.uniform(19.5, 20.5), 0.7), shapes_);
    if (has_shelter) addShelter(spot(begin_x_ + 27.0, 1.0), side_ > 0.0 ? 0.0 : M_PI, shapes_);
    for (int slot = 0; slot < 5; ++slot) parkAt(begin_x_ + 4.0 + 6.6 * slot);
    const HouseFront front{plan_.kerb_y_m + kSidewalkWidth_m, side_};
    addHouseRow(front, begin_x_, begin_x_ + kBlockLength_m, ground_, random_, shapes_);
  }

 private:
  Vector3d spot(double x, double from_kerb) const {
    const double y = side_ * (plan_.kerb_y_m + from_kerb);
    return {x, y, ground_.height(x, y)};
  }

  void addTreeAt(double x) {
    const double place = x + random_.uniform(0.0, 4.0);
    if (random_.chance(0.35) || nearCrossing(place, 4.0)) return;
    addTree(spot(place, 0.9), random_, shapes_);
  }

  void parkAt(double x) {
    const double place = x + random_.uniform(-0.5, 0.5);
    const bool taken = random_.chance(plan_.parked_share);
    const CarKind kind = random_.chance(0.75) ? CarKind::kSedan : CarKind::kVan;
    if (!taken || nearCrossing(place, 5.0)) return;
    Placement car;
    car.position = spot(place, -1.15 + random_.uniform(-0.1, 0.1));
    car.yaw_rad = (side_ > 0.0 ? M_PI : 0.0) + random_.uniform(-0.03, 0.03);
    const World bare({}, ground_);
    addParkedCar(poseOnSurface(car, 2.7, 1.6, bare), kind, shapes_);
  }

  const StreetPlan& plan_;
  const Ground& ground_;
  double begin_x_;
  double side_;
  Random random_;
  Shapes& shapes_;
};

}  // namespace

Profile withBumps(const Profile& hills, double begin_m, double end_m, std::uint64_t seed) {
  constexpr double kBump_m = 0.012;
  constexpr double kSpacing_m = 3.0;
  const int first = static_cast<int>(std::floor(begin_m / kSpacing_m));
  const int last = static_cast<int>(std::ceil(end_m / kSpacing_m));
  std::vector<Vector2d> knots;
  for (int i = first; i <= last; ++i) {
    Random random(hashOf(seed, 0x9e0, i));
    const double x = i * kSpacing_m;
    knots.emplace_back(x, hills.height(x) + random.uniform(-kBump_m, kBump_m));
  }
  return Profile(std::move(knots));
}

Ground makeStreetGround(const StreetPlan& plan, const Profile& hills) {
  constexpr double kPuddleEvery_m = 10.0;
  const double begin = plan.begin_x_m - 20.0;
  const double end = plan.end_x_m + 20.0;
  std::vector<Puddle> puddles;
  for (int i = static_cast<int>(begin / kPuddleEvery_m); i * kPuddleEvery_m < end; ++i) {
    Random random(hashOf(plan.seed, 0x3e7, i));
    const double x = (i + random.uniform()) * kPuddleEvery_m;
    const double y = (plan.kerb_y_m - 1.0) * random.uniform(-1.0, 1.0);
    puddles.push_back({{x, y}, {random.uniform(0.4, 1.3), random.uniform(0.2, 0.5)}});
  }
  return {withBumps(hills, begin, end, plan.seed), crossSection(plan), std::move(puddles),
          kAsphalt};
}

Shapes furnishStreet(const StreetPlan& plan, const Ground& ground) {
  Shapes shapes;
  const int first = static_cast<int>(std::floor(plan.begin_x_m / kBlockLength_m));
  const int last = static_cast<int>(std::floor(plan.end_x_m / kBlockLength_m));
  for (int block = first; block <= last; ++block) {
    const bool even = block % 2 == 0;
    BlockSide(plan, ground, block, 1.0, shapes).furnish(!even);
    BlockSide(plan, ground, block, -1.0, shapes).furnish(block % 4 == 1);
  }
  return shapes;
}

Path pathAlong(const Ground& ground, double from_x_m, double to_x_m, double y_m) {
  constexpr double kStep_m = 2.0;
  const int steps = std::max(1, static_cast<int>(std::abs(to_x_m - from_x_m) / kStep_m));
  std::vector<Vector3d> points;
  for (int i = 0; i <= steps; ++i) {
    const double x = from_x_m + (to_x_m - from_x_m) * i / steps;
    points.emplace_back(x, y_m, ground.height(x, y_m));
  }
  return Path(std::move(points));
}

Path pathAcross(const Ground& ground, double x_m, double from_y_m, double to_y_m) {
  constexpr int kSteps = 20;
  std::vector<Vector3d> points;
  for (int i = 0; i <= kSteps; ++i) {
    const double y = from_y_m + (to_y_m - from_y_m) * i / kSteps;
    points.emplace_back(x_m, y, ground.height(x_m, y));
  }
  return Path(std::move(points));
}

}  // namespace beautymap::simulation
