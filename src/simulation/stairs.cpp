// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "beautymap/simulation/props.h"
#include "beautymap/simulation/random.h"
#include "beautymap/simulation/scene.h"
#include "beautymap/simulation/traffic.h"
#include "beautymap/simulation/walkers.h"

namespace beautymap::simulation {
namespace {

using Eigen::AlignedBox2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kSteps = 10;  // per flight, the last of them being the landing or the floor
constexpr double kRise_m = 0.17;
constexpr double kTread_m = 0.30;
constexpr double kLanding_m = kSteps * kRise_m;
constexpr double kUpper_m = 2.0 * kLanding_m;
constexpr double kCeiling_m = kUpper_m + 3.2;
constexpr double kSlab_m = 0.3;
constexpr double kRun_m = (kSteps - 1) * kTread_m;  // the flights lie between x = 0 and this
constexpr double kWellEnd_m = kRun_m + 1.7;         // the landing is behind them
constexpr double kNear_m = 0.1;                     // the flights' inner and outer |y|
constexpr double kFar_m = 1.8;
// The building's inner corners.
constexpr double kHalfLength_m = 9.0;
constexpr double kHalfWidth_m = 6.0;

/// The first flight rises along x at negative y, the second one back at positive y.
void addFlights(Shapes& shapes) {
  for (int i = 1; i < kSteps; ++i) {
    const double x = (i - 1) * kTread_m;
    const double top = i * kRise_m;
    shapes.push_back(makeBlock({x, -kFar_m, -0.2}, {x + kTread_m, -kNear_m, top}, kConcrete));
    const double back = kRun_m - i * kTread_m;
    shapes.push_back(makeBlock({back, kNear_m, kLanding_m + top - 0.36},
                               {back + kTread_m, kFar_m, kLanding_m + top}, kConcrete));
  }
  shapes.push_back(
      makeBlock({kRun_m, -kFar_m, kLanding_m - 0.25}, {kWellEnd_m, kFar_m, kLanding_m}, kConcrete));
}

void addRail(const Vector3d& from, const Vector3d& to, Shapes& shapes) {
  const int posts = std::max(2, static_cast<int>((to - from).norm() / 0.9) + 1);
  const Vector3d hand(0.0, 0.0, 0.95);
  for (int i = 0; i < posts; ++i) {
    const Vector3d foot = from + (to - from) * i / (posts - 1);
    shapes.push_back(makeCylinder(foot - Vector3d(0, 0, 0.1), foot + hand, 0.02, kSteel));
  }
  shapes.push_back(makeCapsule(from + hand, to + hand, 0.03, kSteel));
  shapes.push_back(makeCapsule(from + 0.5 * hand, to + 0.5 * hand, 0.015, kSteel));
}

void addStoreys(Shapes& shapes) {
  const double x = kHalfLength_m;
  const double y = kHalfWidth_m;
  const double low = kUpper_m - kSlab_m;
  // The upper floor leaves the stairwell open.
  shapes.push_back(makeBlock({-x, -y, low}, {0.0, y, kUpper_m}, kConcrete));
  shapes.push_back(makeBlock({kWellEnd_m, -y, low}, {x, y, kUpper_m}, kConcrete));
  shapes.push_back(makeBlock({0.0, -y, low}, {kWellEnd_m, -kFar_m, kUpper_m}, kConcrete));
  shapes.push_back(makeBlock({0.0, kFar_m, low}, {kWellEnd_m, y, kUpper_m}, kConcrete));
  shapes.push_back(makeBlock({-x - 1.0, -y - 1.0, kCeiling_m},
                             {x + 1.0, y + 1.0, kCeiling_m + kSlab_m}, kConcrete));
  for (const double side : {-1.0, 1.0}) {
    shapes.push_back(makeBox({0.0, side * (y + 0.15), 0.5 * kCeiling_m},
                             {2.0 * x + 0.6, 0.3, kCeiling_m + 1.0}, 0.0, kPlaster));
    shapes.push_back(makeBox({side * (x + 0.15), 0.0, 0.5 * kCeiling_m},
                             {0.3, 2.0 * y, kCeiling_m + 1.0}, 0.0, kPlaster));
    for (const double floor : {0.0, kUpper_m}) {
      for (const double at : {-6.5, -2.5, 2.5, 6.5}) {
        shapes.push_back(makeBlock({at - 0.7, std::min(side * y, side * (y - 0.04)), floor + 1.0},
                                   {at + 0.7, std::max(side * y, side * (y - 0.04)), floor + 2.3},
                                   kGlass));
      }
    }
  }
}

/// Walls around the landing, with a gap to walk below it, and a balustrade around the well.
void addWell(Shapes& shapes) {
  shapes.push_back(
      makeBlock({kWellEnd_m, -kFar_m - 0.2, -0.2}, {kWellEnd_m + 0.2, 0.2, kCeiling_m}, kPlaster));
  shapes.push_back(makeBlock({kWellEnd_m, 0.2, kLanding_m - 0.25},
                             {kWellEnd_m + 0.2, kFar_m, kCeiling_m}, kPlaster));
  shapes.push_back(
      makeBlock({0.6, -kFar_m - 0.2, -0.2}, {kWellEnd_m, -kFar_m, kUpper_m + 0.1}, kPlaster));
  const double y = kFar_m + 0.06;
  addRail({0.0, y, kUpper_m}, {kWellEnd_m, y, kUpper_m}, shapes);
  addRail({0.0, -y, kUpper_m}, {kWellEnd_m, -y, kUpper_m}, shapes);
  addRail({-0.06, -y, kUpper_m}, {-0.06, -0.05, kUpper_m}, shapes);
  addRail({0.1, -kNear_m, kRise_m}, {kRun_m, -kNear_m, kLanding_m}, shapes);
  addRail({kRun_m, kNear_m, kLanding_m}, {0.1, kNear_m, kUpper_m}, shapes);
}

void furnishFloor(double floor, Random& random, Shapes& shapes) {
  addTable({-6.5, 4.6, floor}, {1.6, 0.8}, 0.1, shapes);
  addBench({6.5, -5.2, floor}, M_PI, shapes);
  addShelf({7.0, 5.4, floor}, 2.7, 0.0, random, shapes);
  shapes.push_back(makeBox({-8.4, -4.8, floor + 0.9}, {0.9, 1.6, 1.8}, 0.0, kWood));
  shapes.push_back(makeBlock({-4.15, -4.15, floor}, {-3.85, -3.85, floor + 3.1}, kConcrete));
  shapes.push_back(makeBlock({-4.15, 3.85, floor}, {-3.85, 4.15, floor + 3.1}, kConcrete));
}

/// Up both flights on the right, a turn on the upper floor, down again on the right, a turn below.
Path round() {
  constexpr double kWall_m = 1.35;   // |y| of those who walk beside the wall
  constexpr double kMiddle_m = 0.5;  // |y| of the others
  const double outer = kRun_m + 1.2;
  const double inner = kRun_m + 0.45;
  return Path({{-1.8, -kWall_m, 0.0},
               {-0.2, -kWall_m, 0.0},
               {kRun_m, -kWall_m, kLanding_m},
               {outer, -0.7, kLanding_m},
               {outer, 0.7, kLanding_m},
               {kRun_m, kWall_m, kLanding_m},
               {-0.1, kWall_m, kUpper_m},
               {-2.0, 1.8, kUpper_m},
               {-5.5, 2.5, kUpper_m},
               {-6.5, 0.5, kUpper_m},
               {-5.0, -0.8, kUpper_m},
               {-2.0, kMiddle_m, kUpper_m},
               {-0.1, kMiddle_m, kUpper_m},
               {kRun_m, kMiddle_m, kLanding_m},
               {inner, 0.3, kLanding_m},
               {inner, -0.3, kLanding_m},
               {kRun_m, -kMiddle_m, kLanding_m},
               {-0.2, -kMiddle_m, 0.0},
               {-2.0, 0.3, 0.0},
               {-5.5, 1.0, 0.0},
               {-6.5, -1.0, 0.0},
               {-5.0, -2.2, 0.0}},
              true);
}

}  // namespace

/// Two storeys joined by a staircase with a landing; the sensor is carried up.
Scene makeStairs(double duration_s, std::uint64_t seed) {
  constexpr double kSpeed_m_s = 1.0;
  Random random(hashOf(seed, 0x57a1));
  Scene scene;
  scene.ground = Ground(Profile(), Profile(), {}, Material{0.25, 0.0, 0.004, 0.0});
  scene.carrier = Carrier::kHandheld;
  addFlights(scene.fixed);
  addStoreys(scene.fixed);
  addWell(scene.fixed);
  furnishFloor(0.0, random, scene.fixed);
  furnishFloor(kUpper_m, random, scene.fixed);
  scene.sensor = loopAlong(round(), kSpeed_m_s, 0.0);

  // The others on the stairs keep their distance by their common speed.
  const double length = round().length();
  for (const double share : {0.075, 0.30, 0.42, 0.55, 0.64, 0.73, 0.93}) {
    scene.actors.push_back(makePedestrian(randomHeight(random.bits()),
                                          loopAlong(round(), kSpeed_m_s, share * length)));
  }
  WalkerPlan plan;
  plan.area = AlignedBox2d(Vector2d(-8.9, -5.9), Vector2d(8.9, 5.9));
  plan.obstacles = {
      {Vector2d(-0.8, -2.1), Vector2d(4.7, 2.1)},   {Vector2d(-7.4, 4.0), Vector2d(-5.6, 5.2)},
      {Vector2d(5.4, -5.7), Vector2d(7.6, -4.8)},   {Vector2d(5.5, 4.8), Vector2d(8.5, 5.9)},
      {Vector2d(-8.9, -5.7), Vector2d(-7.9, -3.9)}, {Vector2d(-4.2, -4.2), Vector2d(-3.8, -3.8)},
      {Vector2d(-4.2, 3.8), Vector2d(-3.8, 4.2)}};
  plan.avoided = {{scene.sensor, 0.7}};
  plan.people = 3;
  plan.duration_s = duration_s;
  for (const double floor : {0.0, kUpper_m}) {
    plan.floor_z_m = floor;
    plan.seed = hashOf(seed, 0x57a2, floor > 0.0);
    for (Actor& actor : makeWalkers(plan)) scene.actors.push_back(std::move(actor));
  }
  return scene;
}

}  // namespace beautymap::simulation
