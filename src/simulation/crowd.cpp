// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
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

constexpr double kLength_m = 26.0;
constexpr double kWidth_m = 20.0;
constexpr double kHeight_m = 6.0;

AlignedBox2d around(const Vector2d& center, const Vector2d& size) {
  return {center - 0.5 * size, center + 0.5 * size};
}

/// Solid walls along x, glass fronts along y; a coffered ceiling.
void addShell(Shapes& shapes) {
  shapes.push_back(makeBlock({0.0, -0.3, -0.5}, {kLength_m, 0.0, kHeight_m}, kPlaster));
  shapes.push_back(
      makeBlock({0.0, kWidth_m, -0.5}, {kLength_m, kWidth_m + 0.3, kHeight_m}, kPlaster));
  shapes.push_back(makeBlock({-8.0, -8.0, kHeight_m},
                             {kLength_m + 8.0, kWidth_m + 8.0, kHeight_m + 0.3}, kConcrete));
  for (double x = 2.0; x < kLength_m; x += 4.0) {
    shapes.push_back(
        makeBlock({x - 0.1, 0.0, kHeight_m - 0.35}, {x + 0.1, kWidth_m, kHeight_m}, kPlaster));
    shapes.push_back(makeBlock({x - 0.9, -0.02, 0.0}, {x + 0.2, 0.06, 2.2}, kWood));
  }
  for (const double x : {0.0, kLength_m}) {
    const double outside = x > 0.0 ? x + 5.0 : -5.0;
    for (double y = 0.0; y < kWidth_m - 0.1; y += 2.5) {
      addPane({x, y, 0.0}, {x, y + 2.5, 0.0}, 3.2, shapes);
    }
    shapes.push_back(makeBlock({x - 0.1, 0.0, 3.2}, {x + 0.1, kWidth_m, kHeight_m}, kPlaster));
    shapes.push_back(makeBlock({outside - 0.2, -4.0, -0.5},
                               {outside + 0.2, kWidth_m + 4.0, kHeight_m}, kPlaster));
  }
}

void addPlanter(const Vector2d& place, Random& random, Shapes& shapes) {
  const Vector3d foot(place.x(), place.y(), 0.0);
  shapes.push_back(makeBox(foot + Vector3d(0, 0, 0.25), {1.6, 1.6, 0.5}, 0.0, kConcrete));
  shapes.push_back(makeBox(foot + Vector3d(0, 0, 0.65), {1.3, 1.3, 0.3}, 0.0, kHedge));
  const double radius = random.uniform(0.8, 1.1);
  shapes.push_back(makeCylinder(foot, foot + Vector3d(0, 0, 3.0), 0.06, kWood));
  shapes.push_back(
      makeEllipsoid(foot + Vector3d(0, 0, 3.0), Vector3d(radius, radius, 0.9), kLeaves));
}

std::vector<AlignedBox2d> furnish(Random& random, Shapes& shapes) {
  std::vector<AlignedBox2d> obstacles;
  for (const double x : {4.0, 13.0, 22.0}) {
    for (const double y : {3.5, 16.5}) {
      shapes.push_back(makeCylinder({x, y, 0.0}, {x, y, kHeight_m}, 0.35, kConcrete));
      obstacles.push_back(around({x, y}, {0.8, 0.8}));
    }
  }
  for (const Vector2d& place : {Vector2d(10.5, 10.0), Vector2d(15.5, 10.0)}) {
    addPlanter(place, random, shapes);
    obstacles.push_back(around(place, {1.8, 1.8}));
  }
  addBench({13.0, 10.0, 0.0}, M_PI / 2.0, shapes);
  obstacles.push_back(around({13.0, 10.0}, {0.8, 2.1}));
  shapes.push_back(makeBlock({8.0, 18.2, 0.0}, {11.0, 19.4, 1.1}, kWood));  // a counter
  obstacles.push_back(around({9.5, 18.8}, {3.0, 1.3}));
  for (const double x : {16.5, 18.5}) {
    addTable({x, 1.6, 0.0}, {0.8, 0.8}, random.uniform(0.0, 1.0), shapes);
    obstacles.push_back(around({x, 1.6}, {1.2, 1.2}));
  }
  addBin({20.5, 19.0, 0.0}, shapes);
  obstacles.push_back(around({20.5, 19.0}, {0.7, 0.7}));
  return obstacles;
}

}  // namespace

/// A station's hall with many people around the robot, one of whom follows it.
Scene makeCrowd(double duration_s, std::uint64_t seed) {
  constexpr double kSpeed_m_s = 0.8;
  constexpr double kStart_m = 3.0;
  constexpr double kBehind_m = 1.8;
  Random random(hashOf(seed, 0xc40d));
  Scene scene;
  addShell(scene.fixed);
  scene.ground = Ground(Profile(), Profile(), {}, Material{0.25, 0.0, 0.004, 0.0});
  const Path way = PathPen({8.0, 6.0, 0.0}, 0.0)
                       .line(5.0)
                       .line(5.0)
                       .arc(2.0, M_PI / 2.0)
                       .line(4.0)
                       .arc(2.0, M_PI / 2.0)
                       .line(5.0)
                       .line(5.0)
                       .arc(2.0, M_PI / 2.0)
                       .line(4.0)
                       .arc(2.0, M_PI / 2.0)
                       .closed();
  scene.sensor = loopAlong(way, kSpeed_m_s, kStart_m);

  WalkerPlan plan;
  plan.area = AlignedBox2d(Vector2d(0.2, 0.2), Vector2d(kLength_m - 0.2, kWidth_m - 0.2));
  plan.obstacles = furnish(random, scene.fixed);
  const Motion follower = loopAlong(way, kSpeed_m_s, kStart_m - kBehind_m);
  plan.avoided = {{scene.sensor, 0.8}, {follower, 0.5}};
  plan.people = 32;
  plan.duration_s = duration_s;
  plan.seed = hashOf(seed, 0xc40e);
  scene.actors = makeWalkers(plan);
  scene.actors.push_back(makePedestrian(1.78, follower));
  return scene;
}

}  // namespace beautymap::simulation
