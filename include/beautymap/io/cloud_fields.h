// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/PCLPointCloud2.h>

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace beautymap {

/// Size in bytes of one element of a pcl::PCLPointField datatype; 0 for an unknown type.
std::size_t fieldTypeSize(std::uint8_t datatype);

/// Makes a cloud compact (height 1, no row padding, little-endian) without touching a value; a
/// field's count 0, which old drivers write, becomes 1. A cloud without points is consistent.
/// @return what is wrong with it, or nothing: an inconsistent size, fields outside the point, or no
/// numeric x, y, z.
std::optional<std::string> normalizeCloud(pcl::PCLPointCloud2& cloud);

/// Number of points of a normalized cloud.
inline std::size_t pointCount(const pcl::PCLPointCloud2& cloud) { return cloud.width; }

/// The names of a cloud's fields in one line: `x y z intensity`.
std::string fieldNames(const pcl::PCLPointCloud2& cloud);

/// Reads one field of every point of a normalized cloud, whatever its type (of an array: its first
/// element). Valid as long as the cloud's data are.
class FieldReader {
 public:
  /// @throws InputError when the cloud has no such field.
  FieldReader(const pcl::PCLPointCloud2& cloud, const std::string& name);
  static bool has(const pcl::PCLPointCloud2& cloud, const std::string& name);
  double operator()(std::size_t point) const;
  /// The same of `count` points.
  void read(std::size_t first, std::size_t count, double* values) const;
  /// The field's datatype (pcl::PCLPointField).
  std::uint8_t datatype() const { return datatype_; }
  /// Bytes from the start of a point's record to the field.
  std::uint32_t offset() const { return offset_; }

 private:
  const std::uint8_t* first_;
  std::size_t point_step_;
  std::uint32_t offset_;
  std::uint8_t datatype_;
};

/// Identifies the cube of a voxel grid that a position of the map lies in; 21 bits an axis.
std::uint64_t voxelKey(const Eigen::Vector3d& position, double voxel_m);

/// float32 rounds coordinates to less than half a millimetre up to here [m]; beyond it a map is
/// written in float64.
constexpr double kMaxFloat32Coordinate = 8192.0;

/// A normalized cloud with x, y, z moved by T_map_cloud (computed in double) and every other field
/// bit-exact. x, y, z become float64 when `as_float64`, float32 otherwise. A cloud whose x, y, z
/// have that type keeps its layout, and the identity then changes nothing; otherwise the fields
/// follow each other in their order without padding. Points that are not finite stay not finite.
pcl::PCLPointCloud2 moveCloud(pcl::PCLPointCloud2 cloud, const Eigen::Isometry3d& T_map_cloud,
                              bool as_float64);
/// The same without a copy where the layout stays: the two clouds then change their memory.
/// @param cloud  holds nothing meaningful afterwards
void moveCloud(pcl::PCLPointCloud2& cloud, const Eigen::Isometry3d& T_map_cloud, bool as_float64,
               pcl::PCLPointCloud2& moved);

}  // namespace beautymap
