// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/simulation/ground.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace beautymap::simulation {

Profile::Profile(std::vector<Eigen::Vector2d> knots) : knots_(std::move(knots)) {
  const auto lower = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.y() < b.y();
  };
  const auto extremes = std::minmax_element(knots_.begin(), knots_.end(), lower);
  lowest_ = extremes.first->y();
  highest_ = extremes.second->y();
}

int Profile::piece(double coordinate) const {
  const auto after = [](double value, const Eigen::Vector2d& knot) { return value < knot.x(); };
  return static_cast<int>(std::upper_bound(knots_.begin(), knots_.end(), coordinate, after) -
                          knots_.begin());
}

double Profile::border(int piece, int step) const {
  const int knot = step > 0 ? piece : piece - 1;
  if (knot < 0 || knot >= static_cast<int>(knots_.size())) {
    return step * std::numeric_limits<double>::infinity();
  }
  return knots_[static_cast<std::size_t>(knot)].x();
}

double Profile::height(double coordinate) const {
  const int index = piece(coordinate);
  if (index == 0) return knots_.front().y();
  if (index == static_cast<int>(knots_.size())) return knots_.back().y();
  const Eigen::Vector2d& a = knots_[static_cast<std::size_t>(index - 1)];
  const Eigen::Vector2d& b = knots_[static_cast<std::size_t>(index)];
  return a.y() + (b.y() - a.y()) * (coordinate - a.x()) / (b.x() - a.x());
}

Ground::Ground(Profile along, Profile across, std::vector<Puddle> puddles, Material material)
    : along_(std::move(along)),
      across_(std::move(across)),
      puddles_(std::move(puddles)),
      material_(material) {}

std::optional<double> Ground::distance(const Ray& ray, double max_distance_m) const {
  const double highest = along_.highest() + across_.highest();
  const int step_x = ray.direction.x() < 0.0 ? -1 : 1;
  const int step_y = ray.direction.y() < 0.0 ? -1 : 1;
  int piece_x = along_.piece(ray.origin.x());
  int piece_y = across_.piece(ray.origin.y());
  double t = 0.0;
  double above = ray.origin.z() - height(ray.origin.x(), ray.origin.y());
  if (above <= 0.0) return std::nullopt;
  while (t < max_distance_m) {
    if (ray.direction.z() >= 0.0 && ray.at(t).z() > highest) return std::nullopt;
    double next_x = (along_.border(piece_x, step_x) - ray.origin.x()) * ray.inverse.x();
    double next_y = (across_.border(piece_y, step_y) - ray.origin.y()) * ray.inverse.y();
    // A ray along an axis never leaves its piece of the other one (0 times infinity is no number).
    if (!(next_x >= t)) next_x = ray.direction.x() == 0.0 ? max_distance_m : t;
    if (!(next_y >= t)) next_y = ray.direction.y() == 0.0 ? max_distance_m : t;
    const double next = std::min({next_x, next_y, max_distance_m});
    const Eigen::Vector3d point = ray.at(next);
    const double next_above = point.z() - height(point.x(), point.y());
    if (next_above <= 0.0) return t + (next - t) * above / (above - next_above);
    if (next == next_x) piece_x += step_x;
    if (next == next_y) piece_y += step_y;
    t = next;
    above = next_above;
  }
  return std::nullopt;
}

Eigen::Vector3d Ground::normal(double x, double y) const {
  constexpr double kHalf_m = 0.005;
  const double slope_x = along_.height(x + kHalf_m) - along_.height(x - kHalf_m);
  const double slope_y = across_.height(y + kHalf_m) - across_.height(y - kHalf_m);
  return Eigen::Vector3d(-slope_x, -slope_y, 2.0 * kHalf_m).normalized();
}

Material Ground::materialAt(double x, double y) const {
  Material material = material_;
  for (const Puddle& puddle : puddles_) {
    const Eigen::Vector2d offset = Eigen::Vector2d(x, y) - puddle.center;
    if (offset.cwiseQuotient(puddle.radii).squaredNorm() > 1.0) continue;
    material.mirror = 0.3;
    material.reflectivity *= 0.5;  // water swallows what it does not mirror
    break;
  }
  return material;
}

}  // namespace beautymap::simulation
