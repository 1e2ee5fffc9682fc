// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/PCLPointCloud2.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace beautymap {

/// An input that cannot be used at all. Tools print what() and exit with code 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One scan as its source delivered it: all fields of the input, untouched, and where it was taken.
struct SourceScan {
  /// Compact (height 1, no row padding) and little-endian; has numeric fields x, y, z [m].
  pcl::PCLPointCloud2 cloud;
  /// Pose of the cloud's frame in the map frame; the identity for clouds that are registered
  /// already.
  Eigen::Isometry3d T_map_cloud = Eigen::Isometry3d::Identity();
  /// Pose of the sensor in the map frame; its translation is where the beams start [m].
  Eigen::Isometry3d T_map_sensor = Eigen::Isometry3d::Identity();
  /// Time of the scan [ns]; 0 where the input has none (PCD folders).
  std::uint64_t stamp_ns = 0;
};

/// How often something was left out, and the first case in words.
struct Skipped {
  std::size_t count = 0;
  std::string example;
};

/// Scans in the order of time. Read as often as wanted: rewind() starts the same sequence again.
class ScanSource {
 public:
  virtual ~ScanSource() = default;

  /// The next usable scan; false at the end. Unusable scans are skipped and counted.
  virtual bool next(SourceScan& scan) = 0;
  virtual void rewind() = 0;

  /// How many scans next() will deliver at most.
  virtual std::size_t size() const = 0;

  /// What was understood of the input, a line each (topics, frames, first pose): shown to the user.
  virtual std::vector<std::string> describe() const = 0;

  /// What was skipped since the last rewind, by reason.
  const std::map<std::string, Skipped>& skipped() const { return skipped_; }

  /// Whether a value of the cloud's `label` field means a moving point.
  virtual bool isMoving(std::uint32_t label) const {
    return moving_labels_.empty() ? label > 0 : has(moving_labels_, label);
  }
  /// Whether it means neither moving nor static, so that the point is not scored.
  bool isIgnored(std::uint32_t label) const {
    return label > 0 && !moving_labels_.empty() && !has(moving_labels_, label);
  }

 protected:
  void skip(const std::string& reason, const std::string& example) {
    Skipped& s = skipped_[reason];
    if (s.count++ == 0) s.example = example;
  }

  std::map<std::string, Skipped> skipped_;
  /// The only values that mean moving, where all others but 0 are to be ignored; empty: no value
  /// is.
  std::vector<std::uint32_t> moving_labels_;

 private:
  static bool has(const std::vector<std::uint32_t>& labels, std::uint32_t label) {
    return std::find(labels.begin(), labels.end(), label) != labels.end();
  }
};

struct SourceOptions {
  std::string map_frame;  ///< empty: `map` where tf has it, otherwise the only root of the tf tree
  std::string cloud_topic;   ///< empty: the only PointCloud2 topic
  std::string sensor_frame;  ///< frame in which the beams start; empty: the cloud's own frame
  std::string odom_topic;    ///< nav_msgs/Odometry that gives the poses; empty: tf
  double start_s = 0.0;      ///< skip that much of the input's beginning [s]
  double duration_s = 0.0;   ///< use that much [s]; 0: all
  int stride = 1;            ///< use every n-th scan
  /// Values of `label` in bags and PCD folders that mean moving; 0 means static, and points with
  /// any other value are not scored.
  std::vector<std::uint32_t> moving_labels{1};
};

/// Opens rosbags (one or several as one input), a PCD folder or a SemanticKITTI folder.
/// @throws InputError when the input cannot be used, with what to do about it.
std::unique_ptr<ScanSource> openScanSource(const std::vector<std::string>& inputs,
                                           const SourceOptions& options);

}  // namespace beautymap
