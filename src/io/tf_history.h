// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <tf2/buffer_core.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace beautymap {

/// All transforms of a recording, looked up by tf2 at any time.
///
/// tf2's cache searches linearly and takes 200 bytes a transform, so it holds only the stretch of
/// time that was asked for last; the rest waits in sorted arrays.
class TfHistory {
 public:
  /// Takes a transform in any order of time. One with a child frame and stamp that is there already
  /// changes nothing (the same bag may be given twice), one that is no rigid transform is counted.
  void insert(const geometry_msgs::TransformStamped& transform, bool is_static);

  /// To be called after the last insert().
  void finish();

  /// T_target_source, interpolated at a time.
  /// @return nothing where tf does not know it; `why` then says so in tf2's words
  std::optional<Eigen::Isometry3d> lookup(const std::string& target, const std::string& source,
                                          std::uint64_t stamp_ns, std::string* why = nullptr);

  bool empty() const { return parents_.empty(); }
  bool knows(const std::string& frame) const;
  /// All frames, sorted.
  std::vector<std::string> frames() const;
  /// Frames that have children but no parent, sorted.
  std::vector<std::string> roots() const;
  /// The frame, its parent, and so on up to a root.
  std::vector<std::string> chain(std::string frame) const;
  /// Whether a frame moves in its parent frame, as far as tf is concerned.
  bool isDynamic(const std::string& frame) const { return dynamic_.count(frame) > 0; }
  /// Whether a dynamic frame lies below this one.
  bool hasDynamicDescendant(const std::string& frame) const;
  /// The time in which all dynamic transforms of the chain from a frame to a root are known [ns].
  std::optional<std::pair<std::uint64_t, std::uint64_t>> coverage(const std::string& frame) const;
  /// How many transforms were not usable, and the first of them in words.
  std::size_t unusable() const { return unusable_; }
  const std::string& unusableExample() const { return unusable_example_; }

 private:
  struct Sample {
    std::uint64_t stamp_ns;
    const std::string* parent;
    Eigen::Vector3d translation;
    Eigen::Vector4d rotation;  // x y z w
  };
  void loadStretch(std::uint64_t stretch);

  std::set<std::string> names_;  // the samples point to these
  std::map<std::string, std::string> parents_;
  std::map<std::string, Sample> static_;
  std::map<std::string, std::vector<Sample>> dynamic_;
  bool sorted_ = true;
  std::unique_ptr<tf2::BufferCore> buffer_;
  std::uint64_t loaded_stretch_ = 0;
  std::size_t unusable_ = 0;
  std::string unusable_example_;
};

/// tf knows no leading slashes any more, old bags still have them.
std::string stripSlash(const std::string& frame);

}  // namespace beautymap
