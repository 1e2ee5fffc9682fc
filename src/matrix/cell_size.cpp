// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/matrix/cell_size.h"

namespace beautymap {
namespace {

constexpr double kShareInRoom = 0.9;
constexpr int kFewestPoints = 100;

}  // namespace

std::optional<double> cellSizeFor(const Scan& scan, const Config& config) {
  const Eigen::Vector3d from_sensor = scan.T_map_cloud.translation() - scan.sensor_in_map;
  int usable = 0, in_room = 0;
  for (const pcl::PointXYZ& point : scan.cloud) {
    const Eigen::Vector3d p = point.getVector3fMap().cast<double>();
    if (p.isZero(0.0)) continue;  // what drivers write for no return
    const double range = (scan.T_map_cloud.linear() * p + from_sensor).norm();
    // False for NaN.
    if (!(range >= config.scan.min_range && range <= config.scan.max_range)) continue;
    ++usable;
    in_room += range <= config.matrix.room_range ? 1 : 0;
  }
  if (usable < kFewestPoints) return {};
  const bool is_room = in_room >= kShareInRoom * usable;
  return is_room ? config.matrix.resInRoom() : config.matrix.res_g;
}

}  // namespace beautymap
