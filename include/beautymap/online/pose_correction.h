// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <vector>

namespace beautymap {

/// Poses by time [ns].
using StampedPoses = std::map<std::uint64_t, Eigen::Isometry3d>;

/// How a loop closure moves the scans: at each corrected pose by what it differs from the pose that
/// was used, in between interpolated, before the first and after the last as that one.
class PoseCorrection {
 public:
  /// @param used       T_map_sensor of the scans in the map
  /// @param corrected  T_map_sensor of some of them, matched by stamp
  /// @param tolerance_ns  stamps that differ by less belong together
  PoseCorrection(const StampedPoses& used, const StampedPoses& corrected,
                 std::uint64_t tolerance_ns);

  /// What to multiply a scan's pose with, from the left.
  Eigen::Isometry3d at(std::uint64_t stamp_ns) const;
  /// How many corrected poses belong to scans.
  std::size_t matched() const { return moves_.size(); }
  /// The largest translation of a scan's position by it [m], and rotation [rad].
  double largestMove() const { return largest_move_; }
  double largestTurn() const { return largest_turn_; }

 private:
  StampedPoses moves_;
  double largest_move_ = 0.0;
  double largest_turn_ = 0.0;
};

}  // namespace beautymap
