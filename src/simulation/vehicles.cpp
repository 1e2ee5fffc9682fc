// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <utility>

#include "beautymap/simulation/actor.h"

namespace beautymap::simulation {
namespace {

using Eigen::Vector3d;

void addWheels(double x_front, double x_rear, double y, double radius, Shapes& shapes) {
  constexpr double kWidth_m = 0.2;
  for (const double x : {x_front, x_rear}) {
    for (const double side : {-1.0, 1.0}) {
      shapes.push_back(makeCylinder(Vector3d(x, side * y, radius),
                                    Vector3d(x, side * (y - kWidth_m), radius), radius, kRubber));
    }
  }
}

Shapes sedan() {
  Shapes shapes{
      makeBlock({-2.15, -0.88, 0.22}, {2.15, 0.88, 0.70}, kPaint),
      makeBlock({-2.05, -0.82, 0.70}, {1.95, 0.82, 0.88}, kPaint),
      makeBlock({-1.55, -0.74, 0.88}, {0.75, 0.74, 1.36}, kCarGlass),
      makeBlock({-1.30, -0.68, 1.36}, {0.45, 0.68, 1.45}, kPaint),
      // Seats, seen through the windows.
      makeBlock({-0.35, -0.60, 0.88}, {-0.15, -0.15, 1.25}, kCloth),
      makeBlock({-0.35, 0.15, 0.88}, {-0.15, 0.60, 1.25}, kCloth),
      makeBlock({-1.25, -0.65, 0.88}, {-1.05, 0.65, 1.15}, kCloth),
  };
  for (const double side : {-0.71, 0.71}) {
    for (const double x : {-1.30, -0.45, 0.45}) {
      shapes.push_back(makeCapsule({x, side, 0.88}, {x, side, 1.36}, 0.03, kPaint));
    }
  }
  addWheels(1.35, -1.35, 0.89, 0.32, shapes);
  return shapes;
}

Shapes van() {
  Shapes shapes{
      makeBlock({-2.45, -0.95, 0.28}, {1.55, 0.95, 2.15}, kPaint),
      makeBlock({1.55, -0.92, 0.28}, {2.45, 0.92, 1.05}, kPaint),
      makeBlock({1.55, -0.88, 1.05}, {2.00, 0.88, 1.75}, kCarGlass),
  };
  addWheels(1.65, -1.60, 0.96, 0.34, shapes);
  return shapes;
}

Shapes truck() {
  Shapes shapes{
      makeBlock({-4.0, -1.20, 0.95}, {1.9, 1.20, 3.30}, kPaint),
      makeBlock({-3.8, -0.45, 0.55}, {3.6, 0.45, 0.95}, kSteel),
      makeBlock({2.1, -1.15, 0.45}, {3.9, 1.15, 1.60}, kPaint),
      makeBlock({2.1, -1.10, 1.60}, {3.8, 1.10, 2.40}, kCarGlass),
      makeBlock({2.1, -1.12, 2.40}, {3.6, 1.12, 2.60}, kPaint),
  };
  addWheels(2.9, -2.6, 1.20, 0.48, shapes);
  return shapes;
}

/// Distances between the wheels.
struct Footprint {
  double wheelbase_m;
  double track_m;
};

Actor makeVehicle(Shapes local, const Footprint& footprint, Motion motion) {
  Actor actor;
  actor.motion = std::move(motion);
  actor.body = [local = std::move(local), footprint](const Placement& place, const World& world,
                                                     Shapes& shapes) {
    const std::size_t first = shapes.size();
    addShapes(local, poseOnSurface(place, footprint.wheelbase_m, footprint.track_m, world), shapes);
    for (std::size_t i = first; i < shapes.size(); ++i) shapes[i].moving = place.moving;
  };
  return actor;
}

}  // namespace

Shapes carShapes(CarKind kind) {
  if (kind == CarKind::kVan) return van();
  return kind == CarKind::kTruck ? truck() : sedan();
}

Shapes cyclistShapes() {
  Shapes shapes;
  for (const double x : {-0.52, 0.52}) {
    shapes.push_back(makeCylinder({x, -0.02, 0.34}, {x, 0.02, 0.34}, 0.34, kRubber));
    // Spokes let half of the beams through, but cylinders are solid: the rim's share is close to
    // that.
    shapes.back().material.transmission = 0.5;
  }
  const Vector3d hip(-0.25, 0.0, 0.95);
  const Vector3d shoulder(0.2, 0.0, 1.45);
  shapes.push_back(makeCapsule({-0.52, 0.0, 0.34}, {0.35, 0.0, 0.80}, 0.03, kPaint));
  shapes.push_back(makeCapsule({0.52, 0.0, 0.34}, {0.40, 0.0, 1.00}, 0.03, kPaint));
  shapes.push_back(makeCapsule({0.42, -0.28, 1.02}, {0.42, 0.28, 1.02}, 0.02, kPaint));
  shapes.push_back(makeCapsule(hip, shoulder, 0.17, kCloth));
  shapes.push_back(makeCapsule({0.28, 0.0, 1.62}, {0.28, 0.0, 1.68}, 0.10, kCloth));
  for (const double side : {-1.0, 1.0}) {
    const Vector3d knee(0.15, side * 0.12, 0.75 - 0.1 * side);
    const Vector3d foot(-0.02, side * 0.12, 0.28 - 0.14 * side);
    shapes.push_back(makeCapsule(hip + Vector3d(0, side * 0.1, 0), knee, 0.08, kCloth));
    shapes.push_back(makeCapsule(knee, foot, 0.06, kCloth));
    shapes.push_back(makeCapsule(shoulder + Vector3d(0, side * 0.18, 0),
                                 Vector3d(0.42, side * 0.26, 1.05), 0.05, kCloth));
  }
  return shapes;
}

Shapes forkliftShapes() {
  Shapes shapes{
      makeBlock({-1.1, -0.55, 0.15}, {0.7, 0.55, 0.95}, kPaint),
      makeBlock({-1.1, -0.55, 0.95}, {-0.5, 0.55, 1.20}, kPaint),
      makeBlock({-0.5, -0.52, 2.05}, {0.6, 0.52, 2.12}, kSteel),
      makeBlock({0.80, -0.45, 0.08}, {0.92, -0.35, 2.20}, kSteel),
      makeBlock({0.80, 0.35, 0.08}, {0.92, 0.45, 2.20}, kSteel),
      makeBlock({0.95, -0.40, 0.06}, {2.05, -0.28, 0.12}, kSteel),
      makeBlock({0.95, 0.28, 0.06}, {2.05, 0.40, 0.12}, kSteel),
      makeBlock({1.00, -0.50, 0.14}, {2.00, 0.50, 1.00}, kWood),
      makeCapsule({-0.35, 0.0, 1.0}, {-0.35, 0.0, 1.45}, 0.17, kCloth),
      makeCapsule({-0.33, 0.0, 1.70}, {-0.33, 0.0, 1.76}, 0.10, kCloth),
  };
  for (const double side : {-0.5, 0.5}) {
    shapes.push_back(makeCapsule({-0.48, side, 1.2}, {-0.48, side, 2.05}, 0.04, kSteel));
    shapes.push_back(makeCapsule({0.58, side, 0.95}, {0.58, side, 2.05}, 0.04, kSteel));
  }
  addWheels(0.5, -0.8, 0.56, 0.25, shapes);
  return shapes;
}

Eigen::Isometry3d poseOnSurface(const Placement& place, double wheelbase_m, double track_m,
                                const World& world) {
  const Vector3d forward(std::cos(place.yaw_rad), std::sin(place.yaw_rad), 0.0);
  const Vector3d left(-forward.y(), forward.x(), 0.0);
  const auto height = [&](double along, double across) {
    return world.supportHeight(place.position + along * forward + across * left);
  };
  const double a = 0.5 * wheelbase_m;
  const double b = 0.5 * track_m;
  const double front_left = height(a, b);
  const double front_right = height(a, -b);
  const double rear_left = height(-a, b);
  const double rear_right = height(-a, -b);
  const double rise = 0.5 * (front_left + front_right - rear_left - rear_right);
  const double tilt = 0.5 * (front_left + rear_left - front_right - rear_right);
  const Vector3d x = (wheelbase_m * forward + rise * Vector3d::UnitZ()).normalized();
  const Vector3d across = track_m * left + tilt * Vector3d::UnitZ();
  const Vector3d z = x.cross(across).normalized();
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() << x, z.cross(x), z;
  pose.translation() = place.position;
  pose.translation().z() = 0.25 * (front_left + front_right + rear_left + rear_right);
  return pose;
}

void addShapes(const Shapes& local, const Eigen::Isometry3d& T_scene_local, Shapes& shapes) {
  for (Shape shape : local) {
    shape.center = T_scene_local * shape.center;
    shape.R_scene_local = T_scene_local.linear() * shape.R_scene_local;
    shapes.push_back(shape);
  }
}

Actor makeCar(CarKind kind, Motion motion) {
  if (kind == CarKind::kTruck) return makeVehicle(truck(), {5.5, 2.2}, std::move(motion));
  return makeVehicle(carShapes(kind), {2.7, 1.6}, std::move(motion));
}

Actor makeCyclist(Motion motion) {
  return makeVehicle(cyclistShapes(), {1.04, 0.3}, std::move(motion));
}

Actor makeForklift(Motion motion) {
  return makeVehicle(forkliftShapes(), {1.3, 1.1}, std::move(motion));
}

}  // namespace beautymap::simulation
