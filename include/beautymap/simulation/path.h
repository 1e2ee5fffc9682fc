// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

namespace beautymap::simulation {

/// A way through the scene, measured by its length.
class Path {
 public:
  /// @param closed whether the way goes on from the last point to the first.
  explicit Path(std::vector<Eigen::Vector3d> points, bool closed = false);

  /// Position at a distance from the start [m]; beyond an open path's ends it goes straight on.
  Eigen::Vector3d at(double distance_m) const;
  /// Direction of travel over a short stretch around that place, so that corners are rounded.
  double yawAt(double distance_m) const;
  double length() const { return lengths_.back(); }

 private:
  std::vector<Eigen::Vector3d> points_;
  std::vector<double> lengths_;
  bool closed_;
};

/// Draws a path from lines and arcs, each of them level or at a constant grade.
class PathPen {
 public:
  PathPen(const Eigen::Vector3d& start, double yaw_rad) : position_(start), yaw_(yaw_rad) {
    points_.push_back(start);
  }
  PathPen& line(double length_m, double grade = 0.0);
  /// @param angle_rad positive to the left.
  PathPen& arc(double radius_m, double angle_rad, double grade = 0.0);
  const Eigen::Vector3d& position() const { return position_; }
  Path open() const { return Path(points_); }
  Path closed() const { return Path(points_, true); }

 private:
  std::vector<Eigen::Vector3d> points_;
  Eigen::Vector3d position_;
  double yaw_;
};

}  // namespace beautymap::simulation
