// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/PCLPointCloud2.h>

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "beautymap/io/copy_runs.h"
#include "beautymap/io/new_file.h"
#include "beautymap/io/pcd_header.h"

namespace beautymap {

/// Writes a binary PCD file point by point, without knowing their number in advance and without
/// holding them. The records are packed (no padding, no fields of unknown type), the fields in the
/// order of the input. Written beside the target and renamed by close().
class PcdStreamWriter {
 public:
  /// @param like  a normalized cloud whose fields the file gets
  /// @param viewpoint  T_map_sensor
  /// @throws InputError when the file cannot be created.
  PcdStreamWriter(std::string path, const pcl::PCLPointCloud2& like,
                  const Eigen::Isometry3d& viewpoint = Eigen::Isometry3d::Identity());

  /// Appends points of a cloud that has the same fields and the same layout as `like`, one record
  /// after the other.
  /// @throws InputError when the disk is full.
  void append(const std::uint8_t* point_records, std::size_t count = 1);
  /// @throws InputError when the disk is full or the file cannot be renamed; the target is then
  /// unchanged.
  void close();
  std::uint64_t size() const { return header_.points; }
  /// Whether a cloud has the layout that append() expects.
  bool accepts(const pcl::PCLPointCloud2& cloud) const;

 private:
  void flush();

  NewFile file_;
  bool closed_ = false;
  std::vector<pcl::PCLPointField> input_fields_;
  std::size_t input_step_;
  PcdHeader header_;
  std::size_t header_length_ = 0;
  std::vector<CopyRun> runs_;
  std::vector<std::uint8_t> buffer_;
  std::size_t buffered_ = 0;
};

/// Points [begin, end) of a file; as many of them as there are.
struct PcdRange {
  std::uint64_t begin = 0;
  std::uint64_t end = std::numeric_limits<std::uint64_t>::max();
};

/// Streams a binary PCD file of any size in blocks (binary_compressed and ascii are read
/// whole). Calls `block` with normalized clouds of 1 to `block_points` points, in order.
/// @throws InputError when the file is not a PCD file, is truncated or has no numeric x, y, z.
void readPcdBlocks(const std::string& path,
                   const std::function<void(const pcl::PCLPointCloud2&)>& block,
                   std::size_t block_points = 1 << 20, PcdRange range = {});

/// The whole file as one normalized cloud.
/// @throws InputError as readPcdBlocks.
pcl::PCLPointCloud2 readPcd(const std::string& path);

}  // namespace beautymap
