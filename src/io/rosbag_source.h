// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "beautymap/io/scan_source.h"
#include "cloud_read_ahead.h"
#include "rosbag_files.h"
#include "scan_poses.h"

namespace beautymap {

/// The PointCloud2 messages of one topic of one or more bags, with poses from /tf and /tf_static or
/// from odometry in the same bags. Reads the files directly: no master, no clock.
class RosbagSource : public ScanSource {
 public:
  /// @throws InputError when the bags cannot be used, with what to do about it.
  RosbagSource(const std::vector<std::string>& paths, const SourceOptions& options);

  bool next(SourceScan& scan) override;
  void rewind() override;
  std::size_t size() const override;
  std::vector<std::string> describe() const override { return description_; }

 private:
  std::unique_ptr<ScanPoses> loadPoses(const SourceOptions& options) const;
  /// The scan of a cloud that can be used; the others are skipped.
  bool use(const RecordedCloud& recorded, SourceScan& scan);
  void describeFirstScan(rosbag::View& view);

  RosbagFiles files_;
  RosbagFiles::Topic topic_;
  std::size_t stride_;
  std::string cloud_frame_;  // of the first cloud
  std::unique_ptr<ScanPoses> poses_;
  std::size_t size_ = 0;
  std::vector<std::string> description_;
  std::optional<CloudReadAhead> clouds_;
};

}  // namespace beautymap
