// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstring>

#include "beautymap/io/cloud_fields.h"
#include "beautymap/io/scan_source.h"
#include "beautymap/matrix/scan.h"

namespace beautymap {

/// Reads the positions of a normalized cloud's points [m], fast where x, y, z are three float32 in
/// a row.
class PositionReader {
 public:
  /// @throws InputError when x, y or z is missing.
  explicit PositionReader(const pcl::PCLPointCloud2& cloud);
  Eigen::Vector3d operator()(std::size_t point) const {
    if (floats_ == nullptr) return {x_(point), y_(point), z_(point)};
    return floatsOf(point).cast<double>();
  }
  bool areFloats() const { return floats_ != nullptr; }
  /// The same without conversion; only where areFloats().
  Eigen::Vector3f floatsOf(std::size_t point) const {
    Eigen::Vector3f position;
    std::memcpy(position.data(), floats_ + point * point_step_, 3 * sizeof(float));
    return position;
  }

 private:
  FieldReader x_, y_, z_;
  const std::uint8_t* floats_ = nullptr;
  std::size_t point_step_;
};

/// What the core needs of a scan. float64 coordinates are taken relative to the sensor first, so
/// that a registered cloud at UTM-sized coordinates keeps its millimetres in float32.
void convertScan(const SourceScan& from, Scan& to);

}  // namespace beautymap
