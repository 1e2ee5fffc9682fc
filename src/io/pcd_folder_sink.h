// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "beautymap/io/moving_labels.h"
#include "beautymap/io/pcd_stream.h"
#include "beautymap/io/scan_sink.h"

namespace beautymap {

/// Writes the dynamic-map benchmark's layout into a folder beside the target, renamed by close().
class PcdFolderSink : public ScanSink {
 public:
  /// @throws InputError when the target is a file or a folder that is not empty.
  PcdFolderSink(const std::string& path, const ScanSource& source);
  ~PcdFolderSink() override;
  PcdFolderSink(const PcdFolderSink&) = delete;
  PcdFolderSink& operator=(const PcdFolderSink&) = delete;

  void write(const SourceScan& scan) override;
  void close() override;

 private:
  void writeScan(const pcl::PCLPointCloud2& cloud, const Eigen::Isometry3d& T_map_sensor);
  void appendGroundTruth(const pcl::PCLPointCloud2& cloud, const std::vector<PointLabel>& labels);

  std::string path_;
  std::string temporary_path_;
  const ScanSource& source_;
  bool as_float64_ = false;
  std::size_t scans_ = 0;
  std::unique_ptr<PcdStreamWriter> ground_truth_;
  bool closed_ = false;
};

}  // namespace beautymap
