// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "beautymap/simulation/houses.h"
#include "beautymap/simulation/props.h"
#include "beautymap/simulation/random.h"
#include "beautymap/simulation/scene.h"
#include "beautymap/simulation/streetside.h"
#include "beautymap/simulation/traffic.h"

namespace beautymap::simulation {
namespace {

using Eigen::Vector3d;

constexpr double kDeck_m = 4.2;      // height of the deck's surface
constexpr double kThick_m = 0.5;     // of deck and ramps
constexpr double kDeckHalf_m = 5.5;  // half of the deck's width, which runs along y at x = 0
constexpr double kDeckEnd_m = 62.0;  // it ends at this |y|
constexpr double kJoin_m = 25.75;    // |y| at which the ramps meet the deck
constexpr double kRampHalf_m = 3.0;
constexpr double kLane_m = 1.75;

/// A parapet: concrete below, a mesh above.
void addParapet(const Vector3d& from, const Vector3d& to, Shapes& shapes) {
  const Vector3d along = to - from;
  const double yaw = std::atan2(along.y(), along.x());
  const double length = along.head<2>().norm() + 0.05;
  const Vector3d middle = 0.5 * (from + to);
  shapes.push_back(makeBox(middle + Vector3d(0, 0, 0.1), {length, 0.2, 0.7}, yaw, kConcrete));
  shapes.push_back(makeBox(middle + Vector3d(0, 0, 0.8), {length, 0.03, 0.7}, yaw, kMesh));
}

/// A road on a ramp: short slabs along the path with walls down to the ground and parapets.
void addRamp(const Path& path, Shapes& shapes) {
  constexpr double kStep_m = 0.7;
  const int steps = static_cast<int>(std::ceil(path.length() / kStep_m));
  for (int i = 0; i < steps; ++i) {
    const Vector3d a = path.at(path.length() * i / steps);
    const Vector3d b = path.at(path.length() * (i + 1) / steps);
    const Vector3d forward = (b - a).normalized();
    const Vector3d left = Vector3d::UnitZ().cross(forward).normalized();
    Shape slab;
    slab.material = kConcrete;
    slab.R_scene_local << forward, left, forward.cross(left);
    // Longer than the step, so that no wedge stays open on the outer side of the curve.
    slab.half = Vector3d(0.5 * (b - a).norm() * 1.3, kRampHalf_m, 0.5 * kThick_m);
    slab.center = 0.5 * (a + b) - slab.half.z() * slab.R_scene_local.col(2);
    shapes.push_back(slab);
    const double top = std::min(a.z(), b.z()) - 0.3;
    if (top > 0.2) {
      shapes.push_back(makeBox({slab.center.x(), slab.center.y(), 0.5 * (top - 0.5)},
                               {(b - a).norm() * 1.3, 2.0 * kRampHalf_m - 0.3, top + 0.5},
                               std::atan2(forward.y(), forward.x()), kConcrete));
    }
    if (a.z() < 0.25) continue;
    for (const double side : {-kRampHalf_m, kRampHalf_m}) {
      const double longer = 0.1 * (b - a).norm();
      addParapet(a + side * left - longer * forward, b + side * left + longer * forward, shapes);
    }
  }
}

/// From the lower road's right lane up to the deck at y = -kJoin_m.
Path rampUp() {
  constexpr double kRadius_m = 12.0;
  constexpr double kLevel_rad = 0.6;  // level until it has left the lane
  const double way = (M_PI - kLevel_rad) * kRadius_m + 12.0 - kDeckHalf_m;
  const double grade = kDeck_m / way;
  return PathPen({12.0, -kLane_m, 0.0}, 0.0)
      .arc(kRadius_m, -kLevel_rad)
      .arc(kRadius_m, -(M_PI - kLevel_rad), grade)
      .line(12.0 - kDeckHalf_m, grade)
      .open();
}

/// From the deck at y = kJoin_m down to the lower road's right lane, over the other one.
Path rampDown() {
  constexpr double kRadius_m = 13.75;
  constexpr double kSlope_rad = 2.0;  // then it is level, before it meets the other lane
  const double way = kSlope_rad * kRadius_m + 12.0 - kDeckHalf_m;
  const double grade = -kDeck_m / way;
  return PathPen({-kDeckHalf_m, kJoin_m, kDeck_m}, M_PI)
      .line(12.0 - kDeckHalf_m, grade)
      .arc(kRadius_m, kSlope_rad, grade)
      .arc(kRadius_m, M_PI - kSlope_rad)
      .open();
}

/// The sensor's round: below the deck, up, over the deck, down.
Path round() {
  constexpr double kTurnIn_m = kDeckHalf_m - kLane_m;
  constexpr double kTurnOut_m = kDeckHalf_m + kLane_m;
  std::vector<Vector3d> points;
  const auto append = [&](const Path& path) {
    for (double s = 0.0; s < path.length(); s += 0.7) points.push_back(path.at(s));
  };
  append(Path({{-12.0, -kLane_m, 0.0}, {12.0, -kLane_m, 0.0}}));
  append(rampUp());
  append(PathPen({kDeckHalf_m, -kJoin_m, kDeck_m}, M_PI)
             .arc(kTurnIn_m, -M_PI / 2.0)
             .line(2.0 * kJoin_m - kTurnIn_m - kTurnOut_m)
             .arc(kTurnOut_m, M_PI / 2.0)
             .open());
  append(rampDown());
  return Path(std::move(points), true);
}

void addDeck(Shapes& shapes) {
  constexpr double kGap_m = 3.2;  // half of the opening at a ramp
  shapes.push_back(makeBlock({-kDeckHalf_m, -kDeckEnd_m, kDeck_m - kThick_m},
                             {kDeckHalf_m, kDeckEnd_m, kDeck_m}, kConcrete));
  for (const double x : {-3.5, 0.0, 3.5}) {  // girders
    shapes.push_back(makeBlock({x - 0.25, -kDeckEnd_m, kDeck_m - 1.0},
                               {x + 0.25, kDeckEnd_m, kDeck_m - kThick_m}, kConcrete));
  }
  for (const double side : {-1.0, 1.0}) {
    const double edge = side * (kDeckHalf_m - 0.1);
    const double gap = -side * kJoin_m;
    const double ends[][2] = {{-kDeckEnd_m, gap - kGap_m}, {gap + kGap_m, kDeckEnd_m}};
    for (const auto& end : ends) {
      addParapet({edge, end[0], kDeck_m}, {edge, end[1], kDeck_m}, shapes);
      const double inner = side * 3.9;
      shapes.push_back(makeBlock({std::min(edge, inner), end[0], kDeck_m - 0.1},
                                 {std::max(edge, inner), end[1], kDeck_m + 0.13}, kConcrete));
    }
    addParapet({-kDeckHalf_m, side * kDeckEnd_m, kDeck_m},
               {kDeckHalf_m, side * kDeckEnd_m, kDeck_m}, shapes);
    for (const double y : {9.8, 19.0, 34.0, 48.0, 61.0}) {
      for (const double x : {-3.5, 3.5}) {
        shapes.push_back(makeBlock({x - 0.6, side * y - 0.4, -0.5},
                                   {x + 0.6, side * y + 0.4, kDeck_m - 1.0}, kConcrete));
      }
    }
  }
}

void addSurroundings(const Ground& ground, Random& random, Shapes& shapes) {
  // Sidewalks end before the ramps.
  shapes.push_back(makeBlock({-75.0, -8.2, -0.5}, {9.5, -4.3, 0.13}, kConcrete));
  shapes.push_back(makeBlock({-9.5, 4.3, -0.5}, {75.0, 8.2, 0.13}, kConcrete));
  for (const double side : {-1.0, 1.0}) {
    const HouseFront front{38.0, side};
    addHouseRow(front, -75.0, -14.0, ground, random, shapes);
    addHouseRow(front, 14.0, 75.0, ground, random, shapes);
    addLampPost({-side * 18.0, side * 3.9 - side * 0.2, 0.0}, -side * M_PI / 2.0, shapes);
    addLampPost({side * 30.0, side * 4.6, 0.0}, -side * M_PI / 2.0, shapes);
    addBench({side * 22.0, side * 8.8, 0.0}, side > 0.0 ? 0.0 : M_PI, shapes);
    for (int i = 0; i < 6; ++i) {
      const Vector3d foot(side * (16.0 + 8.0 * i), side * random.uniform(11.0, 17.0), 0.0);
      addTree(foot, random, shapes);
    }
    addTree({side * 12.0, -side * 14.0, 0.0}, random, shapes);  // inside of the ramp's curve
    addWall({side * 12.0, side * 26.0, 0.0}, {side * 60.0, side * 26.0, 0.0}, 2.2, 0.2, kConcrete,
            shapes);
  }
}

/// A way there and back along one side of a level.
Path thereAndBack(const Vector3d& from, const Vector3d& to, double apart_m) {
  const Vector3d across = 0.5 * apart_m * Vector3d::UnitZ().cross((to - from).normalized());
  return Path({from - across, to - across, to + across, from + across}, true);
}

void addPeople(Random& random, std::vector<Actor>& actors) {
  const Path ways[] = {
      thereAndBack({-60.0, -6.2, 0.13}, {9.0, -6.2, 0.13}, 2.2),
      thereAndBack({-9.0, 6.2, 0.13}, {60.0, 6.2, 0.13}, 2.2),
      thereAndBack({4.65, -50.0, kDeck_m}, {4.65, 50.0, kDeck_m}, 0.7),
      thereAndBack({-4.65, -50.0, kDeck_m}, {-4.65, 50.0, kDeck_m}, 0.7),
  };
  for (const Path& way : ways) {
    for (double start = 0.0; start < way.length() - 6.0; start += random.uniform(8.0, 18.0)) {
      actors.push_back(makePedestrian(randomHeight(random.bits()), loopAlong(way, 1.25, start)));
    }
  }
}

}  // namespace

/// A road below a viaduct, with a ramp up to it on one side and one down on the other.
Scene makeBridge(std::uint64_t seed) {
  constexpr double kSpeed_m_s = 8.5;
  Random random(hashOf(seed, 0xb41d));
  Scene scene;
  const std::uint64_t bumps = random.bits();
  scene.ground = Ground(withBumps(Profile(), -140.0, 140.0, bumps),
                        withBumps(Profile(), -90.0, 90.0, bumps + 1),
                        {{{-22.0, 1.0}, {1.2, 0.5}}, {{20.0, 2.0}, {0.9, 0.4}}}, kAsphalt);
  addDeck(scene.fixed);
  addRamp(rampUp(), scene.fixed);
  addRamp(rampDown(), scene.fixed);
  addSurroundings(scene.ground, random, scene.fixed);

  scene.sensor = loopAlong(round(), kSpeed_m_s, 6.0);
  scene.actors.push_back(makeCar(CarKind::kSedan, loopAlong(round(), kSpeed_m_s, 6.0 + 20.0)));
  const Path below({{120.0, kLane_m, 0.0}, {-120.0, kLane_m, 0.0}});
  const Path above({{-kLane_m, kDeckEnd_m - 3.0, kDeck_m}, {-kLane_m, 3.0 - kDeckEnd_m, kDeck_m}});
  for (const double start : {10.0, 62.0, 95.0, 140.0, 190.0}) {
    scene.actors.push_back(makeCar(randomCarKind(random.bits()), loopAlong(below, 7.5, start)));
  }
  for (const double start : {8.0, 45.0, 80.0}) {
    scene.actors.push_back(makeCar(randomCarKind(random.bits()), loopAlong(above, 7.0, start)));
  }
  addPeople(random, scene.actors);
  return scene;
}

}  // namespace beautymap::simulation
