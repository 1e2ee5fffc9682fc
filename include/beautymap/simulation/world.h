// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>

#include "beautymap/simulation/bvh.h"
#include "beautymap/simulation/ground.h"

namespace beautymap::simulation {

struct Hit {
  double distance_m = 0.0;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  Material material;
  bool moving = false;
};

/// All that a beam can meet at one instant.
class World {
 public:
  World(Shapes fixed, Ground ground);

  /// Replaces the shapes that are in other places in the next scan (some of them may stand still).
  void placeActors(Shapes shapes) { actors_ = Bvh(std::move(shapes)); }

  std::optional<Hit> cast(const Ray& ray, double max_distance_m) const;

  /// Height of the fixed surface under a point, so of the level on which somebody stands there [m].
  /// Starts a step's height above the point; the ground where nothing else is found.
  double supportHeight(const Eigen::Vector3d& point) const;

  const Shapes& fixedShapes() const { return fixed_.shapes(); }
  const Shapes& actorShapes() const { return actors_.shapes(); }

 private:
  Bvh fixed_;
  Bvh actors_;
  Ground ground_;
};

}  // namespace beautymap::simulation
