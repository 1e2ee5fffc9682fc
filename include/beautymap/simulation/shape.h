// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

namespace beautymap::simulation {

/// What a laser beam meets.
struct Material {
  double reflectivity = 0.3;  ///< diffuse, 0 to 1
  double transmission = 0.0;  ///< share of the beams that pass as if the shape was not there
  double mirror = 0.0;   ///< share of the beams that are reflected and measured behind the surface
  double foliage = 0.0;  ///< > 0: a volume with that share of its space filled by clumps of leaves
};

constexpr Material kAsphalt{0.14, 0.0, 0.0, 0.0};
constexpr Material kConcrete{0.30, 0.0, 0.0, 0.0};
constexpr Material kPlaster{0.40, 0.0, 0.0, 0.0};
constexpr Material kWood{0.35, 0.0, 0.0, 0.0};
constexpr Material kPaint{0.35, 0.0, 0.0, 0.0};
constexpr Material kRubber{0.06, 0.0, 0.0, 0.0};
constexpr Material kCloth{0.30, 0.0, 0.0, 0.0};
constexpr Material kSteel{0.30, 0.0, 0.0, 0.0};
constexpr Material kMesh{0.40, 0.6, 0.0, 0.0};
constexpr Material kGlass{0.10, 0.85, 0.04, 0.0};
constexpr Material kCarGlass{0.10, 0.65, 0.0, 0.0};  // no mirror: its image would move with the car
constexpr Material kLeaves{0.40, 0.0, 0.0, 0.28};
constexpr Material kHedge{0.40, 0.0, 0.0, 0.75};

/// A convex body in the scene frame. Its local z axis is the axis of cylinders and capsules.
struct Shape {
  enum class Kind : std::uint8_t { kBox, kCylinder, kCapsule, kEllipsoid };

  Kind kind = Kind::kBox;
  bool moving = false;
  Material material;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R_scene_local = Eigen::Matrix3d::Identity();
  /// Box: half lengths [m]; ellipsoid: radii [m]; cylinder and capsule: radius, radius and half
  /// the length of the axis [m] (a capsule's rounded ends come on top).
  Eigen::Vector3d half = Eigen::Vector3d::Ones();
};

using Shapes = std::vector<Shape>;

/// A beam; the key makes its random decisions (does this beam pass the pane?) repeatable.
struct Ray {
  Ray(const Eigen::Vector3d& start, const Eigen::Vector3d& unit_direction, std::uint64_t random_key)
      : origin(start),
        direction(unit_direction),
        inverse(unit_direction.cwiseInverse()),
        key(random_key) {}

  Eigen::Vector3d at(double distance_m) const { return origin + distance_m * direction; }

  Eigen::Vector3d origin;
  Eigen::Vector3d direction;
  Eigen::Vector3d inverse;  ///< 1 / direction, infinite where it is 0
  std::uint64_t key;
};

/// Distance [m] to where the ray enters the body from outside, if it does.
std::optional<double> enterDistance(const Shape& shape, const Ray& ray);

/// Distance [m] at which this very beam is stopped: the same as enterDistance() but for materials
/// that let some beams pass, and leaves, which stop it inside of their volume.
std::optional<double> stopDistance(const Shape& shape, const Ray& ray, double max_distance_m);

/// Outward unit normal at a point of the surface.
Eigen::Vector3d surfaceNormal(const Shape& shape, const Eigen::Vector3d& point);

/// How far outside of the body a point lies [m]; about 0 on the surface, negative inside.
/// Exact for boxes, cylinders and capsules; for ellipsoids a bound.
double signedDistance(const Shape& shape, const Eigen::Vector3d& point);

/// Axis-aligned bounds in the scene frame.
Eigen::AlignedBox3d boundsOf(const Shape& shape);

Shape makeBox(const Eigen::Vector3d& center, const Eigen::Vector3d& size, double yaw_rad,
              const Material& material);
/// A box that spans from one corner to the other, parallel to the scene's axes.
Shape makeBlock(const Eigen::Vector3d& low, const Eigen::Vector3d& high, const Material& material);
Shape makeCylinder(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius_m,
                   const Material& material);
Shape makeCapsule(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius_m,
                  const Material& material);
Shape makeEllipsoid(const Eigen::Vector3d& center, const Eigen::Vector3d& radii,
                    const Material& material);

}  // namespace beautymap::simulation
