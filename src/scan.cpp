// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/scan.h"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace beautymap {
namespace {

// Half of what an int32 holds, so that windows around a column never overflow.
constexpr double kMaxColumn = 1e9;

void countDropped(const Eigen::Vector3f& point, float squared_range, float min_squared,
                  DroppedPoints& dropped) {
  if (!point.allFinite()) {
    ++dropped.non_finite;
  } else if (point.isZero(0.0F) || squared_range == 0.0F) {
    ++dropped.zero;
  } else {
    ++(squared_range < min_squared ? dropped.too_near : dropped.too_far);
  }
}

/// Appends without a branch on whether a point is usable: which ones are is hard to predict.
template <typename Move>
void movePoints(const Scan& scan, const ScanConfig& config, PlacedScan& placed,
                DroppedPoints& dropped, Move move) {
  const float min_squared = static_cast<float>(config.min_range * config.min_range);
  const float max_squared = static_cast<float>(config.max_range * config.max_range);
  const std::size_t size = scan.cloud.size();
  placed.cloud_size = size;
  placed.points.resize(size);
  placed.source_index.resize(size);
  std::size_t used = 0;
  // Three coordinates, or four of which the last is 0: then a point is one SSE register.
  using Moved = decltype(move(scan.cloud[0]));
  Moved sensor = Moved::Zero();
  sensor.template head<3>() = placed.sensor;
  for (std::size_t i = 0; i < size; ++i) {
    const pcl::PointXYZ& p = scan.cloud[i];
    const Moved moved = move(p);
    const float squared = (moved - sensor).squaredNorm();
    placed.points[used] = moved.template head<3>();
    placed.source_index[used] = static_cast<std::uint32_t>(i);
    // False for NaN, too. Without short circuits: each would be a branch.
    const int zero = static_cast<int>(p.x == 0.0F) & static_cast<int>(p.y == 0.0F) &
                     static_cast<int>(p.z == 0.0F);
    const int usable = static_cast<int>(squared >= min_squared) &
                       static_cast<int>(squared <= max_squared) & static_cast<int>(squared > 0.0F) &
                       (1 - zero);
    used += static_cast<std::size_t>(usable);
    if (usable == 0) countDropped(p.getVector3fMap(), squared, min_squared, dropped);
  }
  placed.points.resize(used);
  placed.source_index.resize(used);
}

}  // namespace

ColumnIndex columnOf(const Eigen::Vector3d& position_in_map, double res_g) {
  return {static_cast<std::int32_t>(std::floor(position_in_map.x() / res_g)),
          static_cast<std::int32_t>(std::floor(position_in_map.y() / res_g))};
}

PlacedScan placeScan(const Scan& scan, double z_origin, double res_g, const ScanConfig& config,
                     DroppedPoints& dropped, PlacedScan recycled) {
  const Eigen::Vector3d& sensor = scan.sensor_in_map;
  if (!sensor.allFinite() || !scan.T_map_cloud.matrix().allFinite() ||
      sensor.cwiseAbs().maxCoeff() / res_g > kMaxColumn) {
    throw std::invalid_argument("the scan's pose is not finite or too far from the map's origin");
  }
  PlacedScan placed = std::move(recycled);
  placed.anchor = columnOf(sensor, res_g);
  const Eigen::Vector3d origin(placed.anchor.x * res_g, placed.anchor.y * res_g, z_origin);
  placed.sensor = (sensor - origin).cast<float>();

  // The translation is made small in double before it meets the points.
  const Eigen::Vector3d shift = scan.T_map_cloud.translation() - origin;
  if (scan.T_map_cloud.linear().isIdentity(0.0)) {
    // A registered cloud may hold large coordinates: what is large in float is subtracted in
    // double.
    const double x = shift.x(), y = shift.y(), z = shift.z();
    movePoints(scan, config, placed, dropped, [&](const pcl::PointXYZ& p) {
      return Eigen::Vector3f(static_cast<float>(static_cast<double>(p.x) + x),
                             static_cast<float>(static_cast<double>(p.y) + y),
                             static_cast<float>(static_cast<double>(p.z) + z));
    });
  } else {
    Eigen::Matrix4f transform = Eigen::Matrix4f::Zero();
    transform.topLeftCorner<3, 3>() = scan.T_map_cloud.linear().cast<float>();
    transform.topRightCorner<3, 1>() = shift.cast<float>();
    const Eigen::Vector4f x = transform.col(0), y = transform.col(1), z = transform.col(2),
                          t = transform.col(3);
    movePoints(scan, config, placed, dropped, [&](const pcl::PointXYZ& p) {
      return Eigen::Vector4f(x * p.x + y * p.y + z * p.z + t);
    });
  }
  return placed;
}

}  // namespace beautymap
