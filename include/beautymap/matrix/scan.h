// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "beautymap/config/config.h"
#include "beautymap/matrix/column_grid.h"

namespace beautymap {

/// A scan and where it was taken. Points may be NaN, zero or far away: placing the scan drops them.
struct Scan {
  pcl::PointCloud<pcl::PointXYZ> cloud;  ///< [m] in the cloud's frame
  Eigen::Isometry3d T_map_cloud = Eigen::Isometry3d::Identity();
  Eigen::Vector3d sensor_in_map = Eigen::Vector3d::Zero();  ///< where the beams start [m]
};

/// How many points of the scans were dropped, and why.
struct DroppedPoints {
  std::uint64_t non_finite = 0;
  std::uint64_t zero =
      0;  ///< exactly at the cloud's or the sensor's origin: what drivers write for no return
  std::uint64_t too_near = 0;
  std::uint64_t too_far = 0;
  std::uint64_t total() const { return non_finite + zero + too_near + too_far; }
  DroppedPoints& operator+=(const DroppedPoints& other) {
    non_finite += other.non_finite;
    zero += other.zero;
    too_near += other.too_near;
    too_far += other.too_far;
    return *this;
  }
};

/// Consecutive points of a placed scan that lie in the same column.
struct ColumnRun {
  std::int32_t x, y;         ///< column relative to the scan's anchor
  std::uint32_t begin, end;  ///< of its points
  float lowest, highest;     ///< of their heights: most runs lie in one cell, and these tell [m]
  std::uint32_t size() const { return end - begin; }
};

/// A scan's usable points, relative to a map column near the sensor, so that float32 keeps its
/// millimetres wherever in the world the map lies. One array per coordinate, and the columns found
/// once for runs of points: what a pass does with a column it does once per run.
struct PlacedScan {
  ColumnIndex
      anchor;  ///< its corner is the origin of x and y below; z counts from the map's z origin
  Eigen::Vector3f sensor;                   ///< [m]
  std::vector<float> x, y, z;               ///< of the points [m]
  std::vector<std::uint32_t> source_index;  ///< of each point in the cloud; not when it is whole
  std::vector<ColumnRun> runs;              ///< all points, in order
  std::size_t cloud_size = 0;               ///< points of the scan's cloud, usable or not
  float steepest_slope = 0.0F;              ///< of its beams, where the method asks for it

  std::size_t size() const { return z.size(); }
  /// Whether no point of the cloud was dropped.
  bool isWhole() const { return size() == cloud_size; }
  /// Where a point is in the scan's cloud.
  std::size_t sourceOf(std::size_t i) const { return isWhole() ? i : source_index[i]; }
  Eigen::Vector3f point(std::size_t i) const { return {x[i], y[i], z[i]}; }
};

/// The column that holds a position of the map frame [m].
ColumnIndex columnOf(const Eigen::Vector3d& position_in_map, double res_g);

/// Moves a scan into the map and drops unusable points.
/// @param z_origin  height of the map frame [m] that becomes z = 0
/// @param recycled  an earlier result whose memory is used again
/// @throws std::invalid_argument when the pose is not finite or beyond the range of column indices.
PlacedScan placeScan(const Scan& scan, double z_origin, double res_g, const ScanConfig& config,
                     DroppedPoints& dropped, PlacedScan recycled = {});

/// Finds the runs of a placed scan's points.
void findRuns(PlacedScan& placed, double res_g);

}  // namespace beautymap
