// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <rosbag/bag.h>

#include <memory>
#include <string>

#include "beautymap/io/new_file.h"
#include "beautymap/io/scan_sink.h"

namespace beautymap {

/// Writes an lz4 compressed bag: per scan the cloud in the sensor's frame, its pose on /tf and
/// /odom.
class RosbagSink : public ScanSink {
 public:
  /// @throws InputError when the file cannot be created.
  RosbagSink(const std::string& path, const SinkOptions& options, const ScanSource& source);
  ~RosbagSink() override;
  RosbagSink(const RosbagSink&) = delete;
  RosbagSink& operator=(const RosbagSink&) = delete;

  void write(const SourceScan& scan) override;
  void close() override;

 private:
  /// @throws InputError for whatever a step of writing throws
  template <typename Step>
  void attempt(Step step);
  void writePose(const Eigen::Isometry3d& T_map_sensor, const ros::Time& stamp);

  NewFile file_;
  SinkOptions options_;
  const ScanSource& source_;
  std::unique_ptr<rosbag::Bag> bag_;
  std::size_t scans_ = 0;
  bool closed_ = false;
};

}  // namespace beautymap
