// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/online/pose_correction.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace beautymap {
namespace {

std::uint64_t between(std::uint64_t a, std::uint64_t b) { return a < b ? b - a : a - b; }

}  // namespace

PoseCorrection::PoseCorrection(const StampedPoses& used, const StampedPoses& corrected,
                               std::uint64_t tolerance_ns) {
  for (const auto& pose : corrected) {
    auto nearest = used.lower_bound(pose.first);
    if (nearest != used.begin() &&
        (nearest == used.end() ||
         between(std::prev(nearest)->first, pose.first) < between(nearest->first, pose.first))) {
      --nearest;
    }
    if (nearest == used.end() || between(nearest->first, pose.first) > tolerance_ns) continue;
    moves_[nearest->first] = pose.second * nearest->second.inverse();
    const Eigen::Isometry3d apart = nearest->second.inverse() * pose.second;
    largest_move_ = std::max(largest_move_, apart.translation().norm());
    largest_turn_ = std::max(largest_turn_, Eigen::AngleAxisd(apart.linear()).angle());
  }
}

Eigen::Isometry3d PoseCorrection::at(std::uint64_t stamp_ns) const {
  if (moves_.empty()) return Eigen::Isometry3d::Identity();
  const auto next = moves_.lower_bound(stamp_ns);
  if (next == moves_.end()) return moves_.rbegin()->second;
  if (next == moves_.begin() || next->first == stamp_ns) return next->second;
  const auto previous = std::prev(next);
  const double share = static_cast<double>(stamp_ns - previous->first) /
                       static_cast<double>(next->first - previous->first);
  Eigen::Isometry3d move = Eigen::Isometry3d::Identity();
  move.linear() = Eigen::Quaterniond(previous->second.linear())
                      .slerp(share, Eigen::Quaterniond(next->second.linear()))
                      .toRotationMatrix();
  move.translation() =
      (1.0 - share) * previous->second.translation() + share * next->second.translation();
  return move;
}

}  // namespace beautymap
