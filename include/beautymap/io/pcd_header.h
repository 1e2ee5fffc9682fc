// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/PCLPointCloud2.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

namespace beautymap {

/// What the text at the beginning of a PCD file says.
struct PcdHeader {
  enum class Encoding { kAscii, kBinary, kBinaryCompressed };

  /// Fields and point_step, no points. Padding (fields called `_`) is part of the point only.
  pcl::PCLPointCloud2 layout;
  /// For each field of the layout, its first column in a line of an ascii file.
  std::vector<std::size_t> ascii_columns;
  std::uint64_t points = 0;
  /// VIEWPOINT: where the sensor was and how it was turned, as written (not normalized).
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  Encoding encoding = Encoding::kAscii;
  std::uint64_t data_offset = 0;  ///< where the points begin in the file [byte]
};

/// @throws InputError when the file cannot be read, is not a PCD file, or is shorter than its
/// header promises.
PcdHeader readPcdHeader(const std::string& path);

/// The header of a binary file, up to and including the line DATA, exactly `length` bytes long; the
/// comment in its first line is filled up with spaces. `length` 0: as short as it gets.
std::string writePcdHeader(const PcdHeader& header, std::size_t length = 0);

}  // namespace beautymap
