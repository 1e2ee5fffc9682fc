// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/simulation/shape.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "beautymap/simulation/random.h"

namespace beautymap::simulation {
namespace {

using Eigen::Vector3d;
using Kind = Shape::Kind;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Where a line is inside of a convex body; empty if enter > exit.
struct Interval {
  double enter = kInfinity;
  double exit = -kInfinity;
};

Interval slab(double origin, double direction, double half) {
  if (direction == 0.0)
    return std::abs(origin) <= half ? Interval{-kInfinity, kInfinity} : Interval{};
  const double a = (-half - origin) / direction;
  const double b = (half - origin) / direction;
  return {std::min(a, b), std::max(a, b)};
}

Interval overlap(const Interval& a, const Interval& b) {
  return {std::max(a.enter, b.enter), std::min(a.exit, b.exit)};
}

/// Roots of a t^2 + 2 b t + c <= 0 for a > 0.
Interval quadratic(double a, double b, double c) {
  const double discriminant = b * b - a * c;
  if (discriminant < 0.0) return {};
  const double root = std::sqrt(discriminant);
  return {(-b - root) / a, (-b + root) / a};
}

Interval boxInterval(const Vector3d& o, const Vector3d& d, const Vector3d& half) {
  const Interval xy = overlap(slab(o.x(), d.x(), half.x()), slab(o.y(), d.y(), half.y()));
  return overlap(xy, slab(o.z(), d.z(), half.z()));
}

Interval tubeInterval(const Vector3d& o, const Vector3d& d, double radius) {
  const double a = d.head<2>().squaredNorm();
  const double c = o.head<2>().squaredNorm() - radius * radius;
  if (a < 1e-18) return c <= 0.0 ? Interval{-kInfinity, kInfinity} : Interval{};
  return quadratic(a, o.head<2>().dot(d.head<2>()), c);
}

Interval sphereInterval(const Vector3d& o, const Vector3d& d, double radius) {
  return quadratic(d.squaredNorm(), o.dot(d), o.squaredNorm() - radius * radius);
}

/// A capsule is the union of a cylinder and two spheres, and convex: the union of the intervals.
Interval capsuleInterval(const Vector3d& o, const Vector3d& d, const Vector3d& half) {
  const Interval tube = tubeInterval(o, d, half.x());
  if (tube.enter > tube.exit) return {};
  const Vector3d end(0.0, 0.0, half.z());
  Interval result = overlap(tube, slab(o.z(), d.z(), half.z()));
  if (result.enter > result.exit) result = Interval{};
  for (const Interval& cap :
       {sphereInterval(o - end, d, half.x()), sphereInterval(o + end, d, half.x())}) {
    if (cap.enter > cap.exit) continue;
    result = {std::min(result.enter, cap.enter), std::max(result.exit, cap.exit)};
  }
  return result;
}

Interval insideInterval(const Shape& shape, const Ray& ray) {
  const Vector3d o = shape.R_scene_local.transpose() * (ray.origin - shape.center);
  const Vector3d d = shape.R_scene_local.transpose() * ray.direction;
  switch (shape.kind) {
    case Kind::kBox:
      return boxInterval(o, d, shape.half);
    case Kind::kCylinder:
      return overlap(tubeInterval(o, d, shape.half.x()), slab(o.z(), d.z(), shape.half.z()));
    case Kind::kCapsule:
      return capsuleInterval(o, d, shape.half);
    case Kind::kEllipsoid:
      return sphereInterval(o.cwiseQuotient(shape.half), d.cwiseQuotient(shape.half), 1.0);
  }
  return {};
}

/// Leaves: clumps stay where they are from scan to scan, but a beam may slip between the leaves of
/// a clump.
std::optional<double> leafDistance(const Material& leaves, const Ray& ray, const Interval& inside) {
  constexpr double kClump_m = 0.25;
  constexpr double kStep_m = 0.1;
  constexpr double kStopInClump = 0.6;
  Random random(hashOf(ray.key, 0x1eaf));
  for (double t = std::max(inside.enter, 0.0) + kStep_m * random.uniform(); t < inside.exit;
       t += kStep_m) {
    const Eigen::Array3d clump = (ray.at(t) / kClump_m).array().floor();
    const std::uint64_t place =
        hashOf(static_cast<std::uint64_t>(static_cast<std::int64_t>(clump.x())),
               static_cast<std::int64_t>(clump.y()), static_cast<std::int64_t>(clump.z()));
    if (unitFromBits(place) < leaves.foliage && random.chance(kStopInClump)) return t;
  }
  return std::nullopt;
}

Shape withAxis(Kind kind, const Vector3d& from, const Vector3d& to, double radius,
               const Material& material) {
  Shape shape;
  shape.kind = kind;
  shape.material = material;
  shape.center = 0.5 * (from + to);
  const double length = (to - from).norm();
  shape.half = Vector3d(radius, radius, 0.5 * length);
  if (length > 0.0) {
    shape.R_scene_local =
        Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), (to - from) / length)
            .toRotationMatrix();
  }
  return shape;
}

}  // namespace

std::optional<double> enterDistance(const Shape& shape, const Ray& ray) {
  const Interval inside = insideInterval(shape, ray);
  if (inside.enter > inside.exit || inside.enter <= 0.0) return std::nullopt;
  return inside.enter;
}

std::optional<double> stopDistance(const Shape& shape, const Ray& ray, double max_distance_m) {
  Interval inside = insideInterval(shape, ray);
  if (inside.enter > inside.exit || inside.enter >= max_distance_m) return std::nullopt;
  const Material& material = shape.material;
  if (material.foliage > 0.0) {
    inside.exit = std::min(inside.exit, max_distance_m);
    return leafDistance(material, ray, inside);
  }
  if (inside.enter <= 0.0) return std::nullopt;
  if (material.transmission > 0.0) {
    // The place tells the panes of a scene apart.
    const auto place = static_cast<std::int64_t>(std::floor(shape.center.sum() * 1000.0));
    if (unitFromBits(hashOf(ray.key, place)) < material.transmission) return std::nullopt;
  }
  return inside.enter;
}

Vector3d surfaceNormal(const Shape& shape, const Vector3d& point) {
  const Vector3d p = shape.R_scene_local.transpose() * (point - shape.center);
  Vector3d normal = Vector3d::Zero();
  if (shape.kind == Kind::kEllipsoid) {
    normal = p.cwiseQuotient(shape.half.cwiseAbs2());
  } else if (shape.kind == Kind::kCapsule) {
    normal = p - Vector3d(0.0, 0.0, std::clamp(p.z(), -shape.half.z(), shape.half.z()));
  } else if (shape.kind == Kind::kCylinder && std::abs(p.z()) < shape.half.z() - 1e-9) {
    normal = Vector3d(p.x(), p.y(), 0.0);
  } else if (shape.kind == Kind::kCylinder) {
    normal.z() = p.z();
  } else {
    int axis = 0;
    (p.cwiseAbs() - shape.half).maxCoeff(&axis);
    normal[axis] = p[axis];
  }
  return shape.R_scene_local * normal.normalized();
}

double signedDistance(const Shape& shape, const Vector3d& point) {
  const Vector3d p = shape.R_scene_local.transpose() * (point - shape.center);
  const Vector3d& half = shape.half;
  const double radial = p.head<2>().norm() - half.x();
  const double axial = std::abs(p.z()) - half.z();
  switch (shape.kind) {
    case Kind::kBox: {
      const Vector3d q = p.cwiseAbs() - half;
      return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
    }
    case Kind::kCylinder:
      return std::hypot(std::max(radial, 0.0), std::max(axial, 0.0)) +
             std::min(std::max(radial, axial), 0.0);
    case Kind::kCapsule:
      return (p - Vector3d(0.0, 0.0, std::clamp(p.z(), -half.z(), half.z()))).norm() - half.x();
    case Kind::kEllipsoid:
      return (p.cwiseQuotient(half).norm() - 1.0) * half.minCoeff();
  }
  return kInfinity;
}

Eigen::AlignedBox3d boundsOf(const Shape& shape) {
  Vector3d half = shape.half;
  if (shape.kind == Kind::kCapsule) half.z() += half.x();
  const Vector3d extent = shape.R_scene_local.cwiseAbs() * half;
  return {shape.center - extent, shape.center + extent};
}

Shape makeBox(const Vector3d& center, const Vector3d& size, double yaw_rad,
              const Material& material) {
  Shape shape;
  shape.material = material;
  shape.center = center;
  shape.R_scene_local = Eigen::AngleAxisd(yaw_rad, Vector3d::UnitZ()).toRotationMatrix();
  shape.half = 0.5 * size;
  return shape;
}

Shape makeBlock(const Vector3d& low, const Vector3d& high, const Material& material) {
  return makeBox(0.5 * (low + high), high - low, 0.0, material);
}

Shape makeCylinder(const Vector3d& from, const Vector3d& to, double radius_m,
                   const Material& material) {
  return withAxis(Kind::kCylinder, from, to, radius_m, material);
}

Shape makeCapsule(const Vector3d& from, const Vector3d& to, double radius_m,
                  const Material& material) {
  return withAxis(Kind::kCapsule, from, to, radius_m, material);
}

Shape makeEllipsoid(const Vector3d& center, const Vector3d& radii, const Material& material) {
  Shape shape;
  shape.kind = Kind::kEllipsoid;
  shape.material = material;
  shape.center = center;
  shape.half = radii;
  return shape;
}

}  // namespace beautymap::simulation
