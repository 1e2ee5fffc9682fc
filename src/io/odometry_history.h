// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nav_msgs/Odometry.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace beautymap {

/// The poses of an odometry topic, interpolated at any time between them. Never extrapolated (but
/// for a millisecond, for stamps that were rounded), nor interpolated over a gap of more than 1 s.
class OdometryHistory {
 public:
  /// Takes a message in any order of time; a stamp that is there already changes nothing.
  void insert(const nav_msgs::Odometry& message);
  /// To be called after the last insert().
  void finish();

  /// For a history that goes on: poses older than that are not needed any more.
  void forgetBefore(std::uint64_t stamp_ns);

  /// T_map_child at a time.
  /// @return nothing where it is not known; `why` then says why not
  std::optional<Eigen::Isometry3d> lookup(std::uint64_t stamp_ns, std::string& why) const;

  /// Whether messages that come may yet say where that was; otherwise lookup() has its last word.
  bool isStillToCome(std::uint64_t stamp_ns) const;

  std::size_t size() const { return samples_.size(); }
  /// header.frame_id and child_frame_id of the first message.
  const std::string& mapFrame() const { return map_frame_; }
  const std::string& childFrame() const { return child_frame_; }
  std::size_t unusable() const { return unusable_; }

 private:
  struct Sample {
    std::uint64_t stamp_ns;
    Eigen::Vector3d translation;
    Eigen::Vector4d rotation;  // x y z w
    bool operator<(const Sample& other) const { return stamp_ns < other.stamp_ns; }
  };

  std::vector<Sample> samples_;
  bool sorted_ = true;
  std::string map_frame_;
  std::string child_frame_;
  std::size_t unusable_ = 0;
};

}  // namespace beautymap
