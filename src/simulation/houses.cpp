// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/simulation/houses.h"

#include <algorithm>
#include <cmath>

#include "beautymap/simulation/props.h"

namespace beautymap::simulation {
namespace {

using Eigen::Vector3d;

constexpr double kDepth_m = 9.0;
constexpr double kStorey_m = 3.1;
constexpr double kFoundation_m = 3.0;
/// A window before a dark room: few beams return, some are mirrored.
constexpr Material kWindow{0.08, 0.0, 0.02, 0.0};

/// One piece of land behind the front line; y is counted from the line away from the road.
class Lot {
 public:
  Lot(const HouseFront& front, double begin_x, double end_x, const Ground& ground, Shapes& shapes)
      : front_(front), begin_x_(begin_x), end_x_(end_x), ground_(ground), shapes_(shapes) {
    base_z_ = ground.height(0.5 * (begin_x + end_x), front.side * front.y_m);
  }

  void addHouse(double setback, int storeys, Random& random) {
    const double height = storeys * kStorey_m + 0.4;
    block(begin_x_, end_x_, setback, setback + kDepth_m, -kFoundation_m, height, kPlaster);
    addWindows(setback, 0, storeys, random);
    if (setback < 1.0) return;
    if (random.chance(0.5)) {
      block(begin_x_, end_x_ - 2.0, 0.1, 0.7, -0.5, random.uniform(0.9, 1.5), kHedge);
    } else {
      wallLine(begin_x_, end_x_ - 2.0, 0.2, random.uniform(0.5, 1.1), 0.2, kConcrete);
    }
  }

  void addShop(int storeys, Random& random) {
    constexpr double kRoom_m = 3.5;
    const double height = storeys * kStorey_m + 0.4;
    block(begin_x_, end_x_, 0.0, kDepth_m, kStorey_m, height, kPlaster);
    block(begin_x_, end_x_, kRoom_m, kDepth_m, -kFoundation_m, kStorey_m, kPlaster);
    block(begin_x_, begin_x_ + 0.3, 0.0, kRoom_m, -kFoundation_m, kStorey_m, kPlaster);
    block(end_x_ - 0.3, end_x_, 0.0, kRoom_m, -kFoundation_m, kStorey_m, kPlaster);
    block(begin_x_, end_x_, 0.0, 0.3, -kFoundation_m, 0.35, kConcrete);
    const double step = (end_x_ - begin_x_ - 0.6) / 3.0;
    for (int i = 0; i < 3; ++i) {
      const double x = begin_x_ + 0.3 + i * step;
      addPane(point(x, 0.15, 0.35), point(x + step, 0.15, 0.35), kStorey_m - 0.4, shapes_);
      const double table_x = x + random.uniform(0.3, 0.7) * step;
      block(table_x - 0.5, table_x + 0.5, 1.2, 2.0, 0.0, random.uniform(0.7, 1.4), kWood);
    }
    addWindows(0.0, 1, storeys, random);
  }

  void addGarden(Random& random) {
    if (random.chance(0.5)) {
      wallLine(begin_x_, end_x_, 0.3, 1.7, 0.04, kMesh);
    } else {
      block(begin_x_, end_x_, 0.2, 0.9, -0.5, random.uniform(1.2, 2.2), kHedge);
    }
    for (double x = begin_x_ + 2.0; x < end_x_ - 1.5; x += random.uniform(4.0, 7.0)) {
      addTree(point(x, random.uniform(3.0, 7.5), 0.0), random, shapes_);
    }
    wallLine(begin_x_, end_x_, 11.0, 3.0, 0.3, kConcrete);
  }

 private:
  Vector3d point(double x, double behind, double up) const {
    return {x, front_.side * (front_.y_m + behind), base_z_ + up};
  }

  void block(double x0, double x1, double y0, double y1, double z0, double z1,
             const Material& material) {
    const Vector3d a = point(x0, y0, z0);
    const Vector3d b = point(x1, y1, z1);
    shapes_.push_back(makeBlock(a.cwiseMin(b), a.cwiseMax(b), material));
  }

  void wallLine(double x0, double x1, double behind, double height, double thickness,
                const Material& material) {
    Vector3d a = point(x0, behind, 0.0);
    Vector3d b = point(x1, behind, 0.0);
    a.z() = ground_.height(a.x(), a.y());
    b.z() = ground_.height(b.x(), b.y());
    addWall(a, b, height, thickness, material, shapes_);
  }

  void addWindows(double setback, int first_storey, int storeys, Random& random) {
    constexpr double kProud_m = 0.04;
    const int columns = std::max(1, static_cast<int>((end_x_ - begin_x_) / 2.8));
    const double step = (end_x_ - begin_x_) / columns;
    const bool balconies = random.chance(0.4);
    for (int storey = first_storey; storey < storeys; ++storey) {
      const double z = storey * kStorey_m + 1.0;
      for (int column = 0; column < columns; ++column) {
        const double x = begin_x_ + (column + 0.5) * step;
        block(x - 0.6, x + 0.6, setback - kProud_m, setback, z, z + 1.5, kWindow);
        block(x - 0.7, x + 0.7, setback - 0.15, setback, z - 0.08, z, kConcrete);
        if (!balconies || storey == 0 || column % 2 == 1) continue;
        block(x - 1.2, x + 1.2, setback - 1.1, setback, z - 1.1, z - 0.95, kConcrete);
        block(x - 1.2, x + 1.2, setback - 1.1, setback - 1.06, z - 0.95, z + 0.1, kMesh);
      }
    }
  }

  HouseFront front_;
  double begin_x_;
  double end_x_;
  const Ground& ground_;
  Shapes& shapes_;
  double base_z_;
};

}  // namespace

void addHouseRow(const HouseFront& front, double begin_x_m, double end_x_m, const Ground& ground,
                 Random& random, Shapes& shapes) {
  double x = begin_x_m;
  while (x < end_x_m) {
    double next = x + random.uniform(9.0, 15.0);
    if (end_x_m - next < 7.0) next = end_x_m;
    Lot lot(front, x, next, ground, shapes);
    const double kind = random.uniform();
    const int storeys = 2 + static_cast<int>(3.0 * random.uniform());
    if (kind < 0.22) {
      lot.addShop(storeys, random);
    } else if (kind < 0.42) {
      lot.addGarden(random);
    } else {
      const double setback = random.chance(0.5) ? 0.0 : random.uniform(1.5, 3.5);
      lot.addHouse(setback, storeys, random);
    }
    x = next;
  }
}

}  // namespace beautymap::simulation
