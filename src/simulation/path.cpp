// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/simulation/path.h"

#include <algorithm>
#include <cmath>

namespace beautymap::simulation {

Path::Path(std::vector<Eigen::Vector3d> points, bool closed)
    : points_(std::move(points)), lengths_{0.0}, closed_(closed) {
  if (closed_) points_.push_back(points_.front());
  for (std::size_t i = 1; i < points_.size(); ++i) {
    lengths_.push_back(lengths_.back() + (points_[i] - points_[i - 1]).norm());
  }
}

Eigen::Vector3d Path::at(double distance_m) const {
  if (closed_) distance_m -= std::floor(distance_m / length()) * length();
  const auto after = std::upper_bound(lengths_.begin() + 1, lengths_.end() - 1, distance_m);
  const auto end = static_cast<std::size_t>(after - lengths_.begin());
  const double step = lengths_[end] - lengths_[end - 1];
  const double share = step > 0.0 ? (distance_m - lengths_[end - 1]) / step : 0.0;
  return points_[end - 1] + share * (points_[end] - points_[end - 1]);
}

double Path::yawAt(double distance_m) const {
  constexpr double kReach_m = 0.5;
  const Eigen::Vector3d step = at(distance_m + kReach_m) - at(distance_m - kReach_m);
  return std::atan2(step.y(), step.x());
}

PathPen& PathPen::line(double length_m, double grade) {
  position_ += length_m * Eigen::Vector3d(std::cos(yaw_), std::sin(yaw_), grade);
  points_.push_back(position_);
  return *this;
}

PathPen& PathPen::arc(double radius_m, double angle_rad, double grade) {
  constexpr double kStep_rad = M_PI / 60.0;
  const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(angle_rad) / kStep_rad)));
  const double step = angle_rad / steps;
  const double chord = 2.0 * radius_m * std::sin(0.5 * std::abs(step));
  for (int i = 0; i < steps; ++i) {
    yaw_ += 0.5 * step;
    line(chord, grade);
    yaw_ += 0.5 * step;
  }
  return *this;
}

}  // namespace beautymap::simulation
