// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/simulation/world.h"

#include <utility>

namespace beautymap::simulation {

World::World(Shapes fixed, Ground ground) : fixed_(std::move(fixed)), ground_(std::move(ground)) {}

std::optional<Hit> World::cast(const Ray& ray, double max_distance_m) const {
  double distance = max_distance_m;
  const std::optional<double> to_ground = ground_.distance(ray, max_distance_m);
  if (to_ground) distance = *to_ground;
  const Shape* shape = fixed_.firstOn(ray, distance);
  const Shape* actor = actors_.firstOn(ray, distance);
  if (actor != nullptr) shape = actor;

  const Eigen::Vector3d point = ray.at(distance);
  Hit hit;
  hit.distance_m = distance;
  if (shape != nullptr) {
    hit.normal = surfaceNormal(*shape, point);
    hit.material = shape->material;
    hit.moving = shape->moving;
  } else if (to_ground) {
    hit.normal = ground_.normal(point.x(), point.y());
    hit.material = ground_.materialAt(point.x(), point.y());
  } else {
    return std::nullopt;
  }
  return hit;
}

double World::supportHeight(const Eigen::Vector3d& point) const {
  constexpr double kStepUp_m = 0.6;
  constexpr double kDrop_m = 5.0;
  const Eigen::Vector3d start = point + Eigen::Vector3d(0.0, 0.0, kStepUp_m);
  const Ray down(start, -Eigen::Vector3d::UnitZ(), 0);
  double distance = kDrop_m;
  if (const auto to_ground = ground_.distance(down, kDrop_m)) distance = *to_ground;
  fixed_.firstOn(down, distance);
  return distance < kDrop_m ? start.z() - distance : ground_.height(point.x(), point.y());
}

}  // namespace beautymap::simulation
