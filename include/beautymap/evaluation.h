// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <vector>

namespace beautymap {

/// Point-level counts of a cleaned map, and the dynamic-map benchmark's scores in percent.
struct Score {
  std::uint64_t static_points = 0;
  std::uint64_t dynamic_points = 0;
  std::uint64_t kept_static = 0;
  std::uint64_t kept_dynamic = 0;

  double SA() const;  ///< static accuracy: kept static / all static
  double DA() const;  ///< dynamic accuracy: removed dynamic / all dynamic
  double AA() const;  ///< sqrt(SA DA)
  double HA() const;  ///< 2 SA DA / (SA + DA)
};

/// Scores a cleaned map against labelled points: a ground-truth point is kept when the cleaned map
/// has a point nearer than the radius. First every ground-truth point is added, then the cleaned
/// map's points are shown. Memory grows with the points that are not known to be kept when they are
/// added.
class Evaluator {
 public:
  /// @param radius_m  [m], > 0
  explicit Evaluator(double radius_m = 0.05);

  /// A ground-truth point that the cleaned map holds itself.
  void addKept(bool moving);
  /// A ground-truth point [m] that may or may not have a point of the cleaned map near it.
  /// Non-finite ones count as removed.
  void addUnmatched(const Eigen::Vector3d& point, bool moving);
  /// A point of the cleaned map [m].
  void showCleaned(const Eigen::Vector3d& point);

  const Score& score() const { return score_; }

 private:
  struct Unmatched {
    Eigen::Vector3d point;
    std::uint32_t static_count = 0;
    std::uint32_t moving_count = 0;
  };

  std::uint64_t cellKey(const Eigen::Vector3d& point) const;
  bool nearUnmatched(const Eigen::Vector3d& point);
  void markNear(const Eigen::Vector3d& point);
  template <typename F>
  void forEachCellNear(const Eigen::Vector3d& point, double cell_m, F f) const;
  void matchInCell(std::uint64_t key, const Eigen::Vector3d& point);

  double radius_m_;
  Score score_;
  std::unordered_map<std::uint64_t, std::vector<Unmatched>> cells_;
  Eigen::Array3d last_cell_ = Eigen::Array3d::Constant(
      std::numeric_limits<double>::infinity());  ///< mostly the next point's, too
  bool last_near_ = false;
  std::vector<bool>
      near_;  ///< hashed coarse cells that reach into the radius of an unmatched point
};

}  // namespace beautymap
