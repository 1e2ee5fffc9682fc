// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/io/scan_conversion.h"

namespace beautymap {
namespace {

void copyRelativeToSensor(const SourceScan& from, const PositionReader& position, Scan& to) {
  for (std::size_t i = 0; i < to.cloud.size(); ++i) {
    const Eigen::Vector3d p = position(i);
    // A point at the origin is a driver's "no return" and must stay recognizable.
    to.cloud[i].getVector3fMap() =
        p.isZero(0.0) ? Eigen::Vector3f(Eigen::Vector3f::Zero())
                      : Eigen::Vector3f((from.T_map_cloud * p - to.sensor_in_map).cast<float>());
  }
  to.T_map_cloud = Eigen::Translation3d(to.sensor_in_map);
}

}  // namespace

PositionReader::PositionReader(const pcl::PCLPointCloud2& cloud)
    : x_(cloud, "x"), y_(cloud, "y"), z_(cloud, "z"), point_step_(cloud.point_step) {
  constexpr std::uint8_t kFloat = pcl::PCLPointField::FLOAT32;
  const bool floats = x_.datatype() == kFloat && y_.datatype() == kFloat && z_.datatype() == kFloat;
  if (floats && !cloud.data.empty() && y_.offset() == x_.offset() + 4 &&
      z_.offset() == x_.offset() + 8) {
    floats_ = cloud.data.data() + x_.offset();
  }
}

void convertScan(const SourceScan& from, Scan& to) {
  to.cloud.resize(from.cloud.width);
  to.T_map_cloud = from.T_map_cloud;
  to.sensor_in_map = from.T_map_sensor.translation();
  const PositionReader position(from.cloud);
  if (!position.areFloats()) {
    copyRelativeToSensor(from, position, to);
    return;
  }
  for (std::size_t i = 0; i < to.cloud.size(); ++i) {
    to.cloud[i].getVector3fMap() = position.floatsOf(i);
  }
}

}  // namespace beautymap
