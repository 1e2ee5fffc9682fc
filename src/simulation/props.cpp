// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/simulation/props.h"

#include <algorithm>
#include <cmath>

namespace beautymap::simulation {
namespace {

using Eigen::Vector3d;

Vector3d up(double height_m) { return {0.0, 0.0, height_m}; }

Eigen::Isometry3d poseAt(const Vector3d& foot, double yaw_rad) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = foot;
  pose.linear() = Eigen::AngleAxisd(yaw_rad, Vector3d::UnitZ()).toRotationMatrix();
  return pose;
}

}  // namespace

void addTree(const Vector3d& foot, Random& random, Shapes& shapes) {
  const double trunk = random.uniform(2.0, 3.2);
  const double crown = random.uniform(1.3, 2.2);
  shapes.push_back(
      makeCylinder(foot - up(0.3), foot + up(trunk + crown), random.uniform(0.10, 0.22), kWood));
  const Vector3d fork = foot + up(trunk);
  const int parts = 4;
  for (int i = 0; i < parts; ++i) {
    const double yaw = 2.0 * M_PI * (i + random.uniform(-0.3, 0.3)) / parts;
    const Vector3d out(std::cos(yaw), std::sin(yaw), 0.0);
    const Vector3d middle = fork + 0.5 * crown * out + up(random.uniform(0.5, 1.1) * crown);
    shapes.push_back(makeCapsule(fork - up(0.2), middle, 0.04, kWood));
    const double radius = random.uniform(0.65, 0.95) * crown;
    shapes.push_back(makeEllipsoid(middle, Vector3d(radius, radius, 0.8 * radius), kLeaves));
  }
  shapes.push_back(makeEllipsoid(fork + up(1.5 * crown), Vector3d(0.8, 0.8, 0.7) * crown, kLeaves));
}

void addLampPost(const Vector3d& foot, double toward_yaw_rad, Shapes& shapes) {
  constexpr double kHeight_m = 7.0;
  const Vector3d arm(1.6 * std::cos(toward_yaw_rad), 1.6 * std::sin(toward_yaw_rad), 0.3);
  shapes.push_back(makeCylinder(foot - up(0.3), foot + up(1.0), 0.11, kSteel));
  shapes.push_back(makeCylinder(foot + up(1.0), foot + up(kHeight_m), 0.07, kSteel));
  shapes.push_back(makeCapsule(foot + up(kHeight_m), foot + up(kHeight_m) + arm, 0.05, kSteel));
}

void addSign(const Vector3d& foot, double yaw_rad, Shapes& shapes) {
  shapes.push_back(makeCylinder(foot - up(0.3), foot + up(2.9), 0.035, kSteel));
  shapes.push_back(makeBox(foot + up(2.5), Vector3d(0.03, 0.6, 0.6), yaw_rad, kSteel));
}

void addBin(const Vector3d& foot, Shapes& shapes) {
  shapes.push_back(makeCylinder(foot - up(0.2), foot + up(0.95), 0.28, kPaint));
}

void addBench(const Vector3d& foot, double yaw_rad, Shapes& shapes) {
  const Shapes local{
      makeBlock({-0.9, -0.25, 0.40}, {0.9, 0.25, 0.46}, kWood),
      makeBlock({-0.9, 0.20, 0.55}, {0.9, 0.25, 0.85}, kWood),
      makeBlock({-0.8, -0.22, -0.2}, {-0.72, 0.22, 0.40}, kSteel),
      makeBlock({0.72, -0.22, -0.2}, {0.8, 0.22, 0.40}, kSteel),
      makeBlock({-0.8, 0.20, 0.46}, {-0.74, 0.24, 0.55}, kSteel),
      makeBlock({0.74, 0.20, 0.46}, {0.8, 0.24, 0.55}, kSteel),
  };
  addShapes(local, poseAt(foot, yaw_rad), shapes);
}

void addTable(const Vector3d& foot, const Eigen::Vector2d& size, double yaw_rad, Shapes& shapes) {
  const double x = 0.5 * size.x();
  const double y = 0.5 * size.y();
  Shapes local{makeBlock({-x, -y, 0.71}, {x, y, 0.75}, kWood)};
  for (const double side_x : {-1.0, 1.0}) {
    for (const double side_y : {-1.0, 1.0}) {
      const Vector3d leg(side_x * (x - 0.06), side_y * (y - 0.06), 0.0);
      local.push_back(makeCylinder(leg, leg + up(0.71), 0.03, kSteel));
    }
  }
  addShapes(local, poseAt(foot, yaw_rad), shapes);
}

void addShelf(const Vector3d& foot, double length_m, double yaw_rad, Random& random,
              Shapes& shapes) {
  constexpr double kDepth_m = 0.8;
  constexpr double kLevel_m = 1.1;
  constexpr int kLevels = 3;
  const double x = 0.5 * length_m;
  const double y = 0.5 * kDepth_m;
  Shapes local;
  for (const double side_y : {-y, y}) {
    for (double along = -x; along <= x + 1e-9; along += length_m / 3.0) {
      local.push_back(makeBlock({along - 0.04, side_y - 0.04, 0.0},
                                {along + 0.04, side_y + 0.04, kLevels * kLevel_m + 0.2}, kSteel));
    }
  }
  for (int level = 0; level < kLevels; ++level) {
    const double z = 0.12 + level * kLevel_m;
    local.push_back(makeBlock({-x, -y, z - 0.05}, {x, y, z}, kSteel));
    for (double along = -x + 0.1; along < x - 0.9; along += random.uniform(0.8, 1.3)) {
      if (random.chance(0.3)) continue;
      const double width = random.uniform(0.4, 0.75);
      const double height = random.uniform(0.3, 0.85);
      local.push_back(makeBlock({along, -y + random.uniform(0.02, 0.15), z},
                                {along + width, y - random.uniform(0.02, 0.15), z + height},
                                kWood));
    }
  }
  addShapes(local, poseAt(foot, yaw_rad), shapes);
}

void addPane(const Vector3d& from, const Vector3d& to, double height_m, Shapes& shapes) {
  const Vector3d along = to - from;
  const double yaw = std::atan2(along.y(), along.x());
  const double length = along.head<2>().norm();
  const Vector3d middle = 0.5 * (from + to);
  shapes.push_back(makeBox(middle + up(0.5 * height_m), {length, 0.02, height_m}, yaw, kGlass));
  for (const double z : {0.04, height_m}) {
    shapes.push_back(makeBox(middle + up(z), {length, 0.06, 0.08}, yaw, kSteel));
  }
  for (const Vector3d& end : {from, to}) {
    shapes.push_back(makeBox(end + up(0.5 * height_m), {0.08, 0.08, height_m}, yaw, kSteel));
  }
}

void addShelter(const Vector3d& foot, double yaw_rad, Shapes& shapes) {
  const Eigen::Isometry3d pose = poseAt(foot, yaw_rad);
  const Vector3d corners[] = {pose * Vector3d(-2.0, -0.6, 0.0), pose * Vector3d(-2.0, 0.7, 0.0),
                              pose * Vector3d(2.0, 0.7, 0.0), pose * Vector3d(2.0, -0.6, 0.0)};
  for (int i = 0; i < 3; ++i) addPane(corners[i], corners[i + 1], 2.3, shapes);
  shapes.push_back(makeBox(foot + up(2.4), {4.4, 1.7, 0.1}, yaw_rad, kSteel));
  addShapes({makeBlock({-1.5, 0.2, 0.42}, {1.5, 0.55, 0.48}, kSteel)}, pose, shapes);
}

void addWall(const Vector3d& from, const Vector3d& to, double height_m, double thickness_m,
             const Material& material, Shapes& shapes) {
  constexpr double kDeep_m = 0.5;
  const Vector3d along = to - from;
  const double low = std::min(from.z(), to.z()) - kDeep_m;
  const double high = std::max(from.z(), to.z()) + height_m;
  Vector3d middle = 0.5 * (from + to);
  middle.z() = 0.5 * (low + high);
  shapes.push_back(makeBox(middle, {along.head<2>().norm(), thickness_m, high - low},
                           std::atan2(along.y(), along.x()), material));
}

void addParkedCar(const Eigen::Isometry3d& pose, CarKind kind, Shapes& shapes) {
  addShapes(carShapes(kind), pose, shapes);
}

}  // namespace beautymap::simulation
