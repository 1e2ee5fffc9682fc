// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <utility>

#include "beautymap/simulation/props.h"
#include "beautymap/simulation/random.h"
#include "beautymap/simulation/scene.h"
#include "beautymap/simulation/walkers.h"

namespace beautymap::simulation {
namespace {

using Eigen::AlignedBox2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Inner corners of the hall; its floor is at z = 0.
const Vector3d kLow(0.0, 0.0, 0.0);
const Vector3d kHigh(30.0, 20.0, 5.0);

class Hall {
 public:
  explicit Hall(std::uint64_t seed) : random_(hashOf(seed, 0x4a11)) {}

  void build() {
    addShell();
    for (const double x : {6.0, 15.0, 24.0}) {
      for (const double y : {6.5, 13.5}) {
        blockOff({x, y}, {0.5, 0.5});
        shapes_.push_back(
            makeBlock({x - 0.25, y - 0.25, 0.0}, {x + 0.25, y + 0.25, 5.0}, kConcrete));
      }
    }
    for (const double x : {12.0, 17.5, 23.0}) {
      addShelf({x, 18.9, 0.0}, 4.0, 0.0, random_, shapes_);
      addShelf({x, 16.1, 0.0}, 4.0, 0.0, random_, shapes_);
      blockOff({x, 18.9}, {4.0, 0.8});
      blockOff({x, 16.1}, {4.0, 0.8});
    }
    addTables();
    addOffice();
    addCrates();
  }

  Shapes& shapes() { return shapes_; }
  const std::vector<AlignedBox2d>& obstacles() const { return obstacles_; }

 private:
  void blockOff(const Vector2d& center, const Vector2d& size) {
    obstacles_.emplace_back(Vector2d(center - 0.5 * size), Vector2d(center + 0.5 * size));
  }

  /// Four walls with pillars, a gate and high windows; a ceiling with beams and ducts.
  void addShell() {
    constexpr double kThick_m = 0.3;
    const double x = kHigh.x();
    const double y = kHigh.y();
    const double z = kHigh.z();
    shapes_.push_back(makeBlock({-kThick_m, -kThick_m, -0.5}, {x + kThick_m, 0.0, z}, kPlaster));
    shapes_.push_back(makeBlock({-kThick_m, y, -0.5}, {x + kThick_m, y + kThick_m, z}, kPlaster));
    shapes_.push_back(makeBlock({-kThick_m, 0.0, -0.5}, {0.0, y, z}, kPlaster));
    shapes_.push_back(makeBlock({x, 0.0, -0.5}, {x + kThick_m, y, z}, kPlaster));
    shapes_.push_back(makeBlock({-1.0, -1.0, z}, {x + 1.0, y + 1.0, z + 0.3}, kConcrete));
    for (double at = 3.0; at < x; at += 6.0) {
      shapes_.push_back(makeBlock({at - 0.15, 0.0, z - 0.4}, {at + 0.15, y, z}, kSteel));
      shapes_.push_back(makeBlock({at - 0.2, 0.0, 0.0}, {at + 0.2, 0.15, z - 0.4}, kConcrete));
      shapes_.push_back(makeBlock({at - 0.6, -0.02, 2.6}, {at + 1.8, 0.03, 3.8}, kGlass));
    }
    shapes_.push_back(makeCylinder({0.0, 10.0, 4.3}, {x, 10.0, 4.3}, 0.2, kSteel));
    shapes_.push_back(makeBlock({x - 0.08, 8.0, 0.0}, {x, 11.5, 3.2}, kSteel));
  }

  void addTables() {
    for (const Vector2d& place : {Vector2d(4.0, 2.2), Vector2d(9.5, 1.8), Vector2d(19.0, 2.4)}) {
      const Vector2d size(1.8, 0.8);
      const double yaw = random_.uniform(-0.2, 0.2);
      addTable({place.x(), place.y(), 0.0}, size, yaw, shapes_);
      shapes_.push_back(makeBox({place.x(), place.y(), 0.9}, {0.5, 0.35, 0.3}, yaw, kPaint));
      blockOff(place, {2.1, 1.3});
      addBench({place.x(), place.y() + 1.1, 0.0}, yaw, shapes_);
      blockOff(place + Vector2d(0.0, 1.1), {2.1, 0.8});
    }
  }

  /// A corner room behind glass.
  void addOffice() {
    addPane({5.0, 20.0, 0.0}, {5.0, 17.0, 0.0}, 2.8, shapes_);
    addPane({5.0, 17.0, 0.0}, {2.5, 17.0, 0.0}, 2.8, shapes_);
    addPane({2.5, 17.0, 0.0}, {0.0, 17.0, 0.0}, 2.8, shapes_);
    addTable({2.5, 18.8, 0.0}, {2.0, 1.0}, 0.0, shapes_);
    shapes_.push_back(makeBlock({0.3, 19.4, 0.0}, {1.5, 19.95, 2.0}, kWood));
    blockOff({2.5, 18.5}, {5.2, 3.2});
  }

  void addCrates() {
    const Vector2d places[] = {{27.5, 17.5}, {28.3, 3.0}, {26.6, 2.2}, {1.2, 10.5}, {13.0, 7.2}};
    for (const Vector2d& place : places) {
      const double size = random_.uniform(0.8, 1.2);
      const double yaw = random_.uniform(-0.5, 0.5);
      shapes_.push_back(
          makeBox({place.x(), place.y(), 0.35 * size}, {size, size, 0.7 * size}, yaw, kWood));
      blockOff(place, {1.5 * size, 1.5 * size});
      if (random_.chance(0.5)) {
        shapes_.push_back(makeBox({place.x(), place.y(), 0.9 * size},
                                  {0.7 * size, 0.6 * size, 0.4 * size}, yaw + 0.2, kWood));
      }
    }
  }

  Random random_;
  Shapes shapes_;
  std::vector<AlignedBox2d> obstacles_;
};

Path rounded(double x0, double y0, double x1, double y1, double radius) {
  PathPen pen({x0 + radius, y0, 0.0}, 0.0);
  for (int side = 0; side < 4; ++side) {
    const double length = side % 2 == 0 ? x1 - x0 : y1 - y0;
    pen.line(0.5 * (length - 2.0 * radius))
        .line(0.5 * (length - 2.0 * radius))
        .arc(radius, M_PI / 2.0);
  }
  return pen.closed();
}

}  // namespace

Scene makeHall(double duration_s, std::uint64_t seed) {
  Hall hall(seed);
  hall.build();
  Scene scene;
  // A smooth floor: it mirrors a little everywhere.
  scene.ground = Ground(Profile(), Profile(), {}, Material{0.25, 0.0, 0.004, 0.0});
  scene.sensor = loopAlong(rounded(4.0, 4.6, 26.0, 8.6, 1.5), 1.0, 3.0);
  const Motion forklift = loopAlong(rounded(8.0, 10.4, 26.8, 14.6, 1.6), 1.8, 24.0);

  WalkerPlan plan;
  plan.area = AlignedBox2d(Vector2d(0.2, 0.2), Vector2d(29.8, 19.8));
  plan.obstacles = hall.obstacles();
  plan.avoided = {{scene.sensor, 1.0}, {forklift, 2.3}};
  plan.people = 10;
  plan.duration_s = duration_s;
  plan.seed = hashOf(seed, 0x3a1c);
  scene.actors = makeWalkers(plan);
  scene.actors.push_back(makeForklift(forklift));
  scene.fixed = std::move(hall.shapes());
  return scene;
}

}  // namespace beautymap::simulation
