// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "beautymap/simulation/shape.h"

namespace beautymap::simulation {

/// Bounding volume hierarchy: finds the first shape on a ray without testing them all.
class Bvh {
 public:
  Bvh() = default;
  explicit Bvh(Shapes shapes);

  /// The shape that stops the ray first, nearer than `distance_m`, which is then shortened; or
  /// null.
  const Shape* firstOn(const Ray& ray, double& distance_m) const;

  const Shapes& shapes() const { return shapes_; }

 private:
  struct Node {
    Eigen::AlignedBox3d bounds;
    std::uint32_t first = 0;  ///< leaf: first shape; otherwise the second child (the first follows)
    std::uint32_t count = 0;  ///< shapes of a leaf; 0: inner node
  };

  void build(std::vector<std::uint32_t>& order, std::size_t begin, std::size_t end);

  Shapes shapes_;
  std::vector<Eigen::AlignedBox3d> bounds_;
  std::vector<Node> nodes_;
};

}  // namespace beautymap::simulation
