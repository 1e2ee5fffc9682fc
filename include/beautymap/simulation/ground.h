// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "beautymap/simulation/shape.h"

namespace beautymap::simulation {

/// A height over a coordinate that is linear between knots and constant beyond them.
class Profile {
 public:
  Profile() : Profile(std::vector<Eigen::Vector2d>(1, Eigen::Vector2d::Zero())) {}
  /// @param knots (coordinate [m], height [m]) in ascending order of the coordinate.
  explicit Profile(std::vector<Eigen::Vector2d> knots);

  double height(double coordinate) const;
  /// Index of the piece that holds the coordinate: 0 before the first knot.
  int piece(double coordinate) const;
  /// The knot that ends (step 1) or begins (step -1) the piece; infinite at the ends.
  double border(int piece, int step) const;
  double lowest() const { return lowest_; }
  double highest() const { return highest_; }

 private:
  std::vector<Eigen::Vector2d> knots_;
  double lowest_;
  double highest_;
};

/// A wet patch: an ellipse parallel to the axes in which the ground mirrors flat beams.
struct Puddle {
  Eigen::Vector2d center;
  Eigen::Vector2d radii;
};

/// The ground z = along(x) + across(y). Being linear between the knots of both, a ray's way to it
/// has a closed form on each piece. Kerbs are steep pieces of `across`, hills pieces of `along`.
class Ground {
 public:
  Ground() = default;
  Ground(Profile along, Profile across, std::vector<Puddle> puddles, Material material);

  double height(double x, double y) const { return along_.height(x) + across_.height(y); }
  std::optional<double> distance(const Ray& ray, double max_distance_m) const;
  Eigen::Vector3d normal(double x, double y) const;
  Material materialAt(double x, double y) const;

 private:
  Profile along_;
  Profile across_;
  std::vector<Puddle> puddles_;
  Material material_ = kAsphalt;
};

}  // namespace beautymap::simulation
