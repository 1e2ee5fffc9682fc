// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/PCLPointCloud2.h>

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include "beautymap/io/cloud_fields.h"
#include "beautymap/io/pcd_stream.h"

namespace beautymap {

/// A PCD file of the points of many scans, and the voxels that it has a point of.
class PointFile {
 public:
  /// @param voxel_m  0: every point has room
  PointFile(std::string path, double voxel_m) : path_(std::move(path)), voxel_m_(voxel_m) {}

  const std::string& path() const { return path_; }
  /// Whether a point's voxel is still free; it is taken then.
  bool takes(const Eigen::Vector3d& position) {
    return voxel_m_ <= 0.0 || voxels_.insert(voxelKey(position, voxel_m_)).second;
  }
  /// @param layout  of the records
  void append(const pcl::PCLPointCloud2& layout, const std::vector<std::uint8_t>& records) {
    if (!writer_) writer_ = std::make_unique<PcdStreamWriter>(path_, layout);
    writer_->append(records.data(), records.size() / layout.point_step);
  }
  void close() { writer_->close(); }

 private:
  std::string path_;
  double voxel_m_;
  std::unique_ptr<PcdStreamWriter> writer_;
  std::unordered_set<std::uint64_t> voxels_;
};

}  // namespace beautymap
