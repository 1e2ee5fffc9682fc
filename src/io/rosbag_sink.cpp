// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "rosbag_sink.h"

#include <nav_msgs/Odometry.h>
#include <pcl_conversions/pcl_conversions.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_msgs/TFMessage.h>

#include <cstdint>
#include <filesystem>
#include <stdexcept>

#include "beautymap/io/cloud_fields.h"
#include "beautymap/io/moving_labels.h"
#include "stamps.h"
#include "text.h"

namespace beautymap {
namespace {

// tf takes time 0 for "the latest".
constexpr std::uint64_t kFirstStampNs = 1'000'000'000;
constexpr std::uint64_t kScanPeriodNs = 100'000'000;

/// The cloud in the sensor's frame; untouched where it is in that frame already.
pcl::PCLPointCloud2 inSensorFrame(const SourceScan& scan) {
  if (scan.T_map_cloud.matrix() == scan.T_map_sensor.matrix()) return scan.cloud;
  bool is_float64 = true;
  for (const char* axis : {"x", "y", "z"}) {
    is_float64 =
        is_float64 && FieldReader(scan.cloud, axis).datatype() == pcl::PCLPointField::FLOAT64;
  }
  return moveCloud(scan.cloud, scan.T_map_sensor.inverse() * scan.T_map_cloud, is_float64);
}

/// PointCloud2 has no 64-bit integers and no bool: they become arrays of bytes.
void useMessageTypes(pcl::PCLPointCloud2& cloud) {
  for (auto& field : cloud.fields) {
    if (field.datatype <= pcl::PCLPointField::FLOAT64) continue;
    field.count *= static_cast<std::uint32_t>(fieldTypeSize(field.datatype));
    field.datatype = pcl::PCLPointField::UINT8;
  }
}

}  // namespace

RosbagSink::RosbagSink(const std::string& path, const SinkOptions& options,
                       const ScanSource& source)
    : file_(path), options_(options), source_(source), bag_(std::make_unique<rosbag::Bag>()) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) throw InputError(path + ": is a folder");
  attempt([&] {
    bag_->open(file_.temporaryPath(), rosbag::bagmode::Write);
    bag_->setCompression(rosbag::compression::LZ4);
  });
}

RosbagSink::~RosbagSink() {
  if (bag_ == nullptr || closed_) return;
  try {
    attempt([&] { bag_->close(); });
  } catch (const std::exception&) {
    // The file is removed anyway.
  }
}

template <typename Step>
void RosbagSink::attempt(Step step) {
  try {
    if (bag_ == nullptr) throw std::runtime_error("an earlier write failed");
    step();
  } catch (const std::exception& exception) {
    // On a full disk the bag's destructor would fail as well, and end the process: it is left
    // alone.
    static_cast<void>(bag_.release());
    throw InputError("cannot write " + file_.path() + ": " + exception.what());
  }
}

void RosbagSink::write(const SourceScan& scan) {
  const std::uint64_t stamp_ns =
      scan.stamp_ns > 0 ? scan.stamp_ns : kFirstStampNs + scans_ * kScanPeriodNs;
  if (stamp_ns > kLatestStampNs) {
    throw InputError("a scan's stamp of " + inSeconds(stamp_ns) + " is too late for a bag");
  }
  ros::Time stamp;
  stamp.fromNSec(stamp_ns);
  pcl::PCLPointCloud2 cloud = inSensorFrame(scan);
  unifyLabels(cloud, source_);
  useMessageTypes(cloud);
  sensor_msgs::PointCloud2 message;
  pcl_conversions::moveFromPCL(cloud, message);
  message.header.stamp = stamp;  // PCL's has microseconds only
  message.header.frame_id = options_.sensor_frame;
  message.header.seq = static_cast<std::uint32_t>(scans_);
  attempt([&] {
    writePose(scan.T_map_sensor, stamp);
    bag_->write(options_.cloud_topic, stamp, message);
  });
  ++scans_;
}

void RosbagSink::writePose(const Eigen::Isometry3d& T_map_sensor, const ros::Time& stamp) {
  const Eigen::Vector3d t = T_map_sensor.translation();
  const Eigen::Quaterniond q(T_map_sensor.linear());
  nav_msgs::Odometry odometry;
  odometry.header.stamp = stamp;
  odometry.header.frame_id = options_.map_frame;
  odometry.child_frame_id = options_.sensor_frame;
  auto& pose = odometry.pose.pose;
  pose.position.x = t.x();
  pose.position.y = t.y();
  pose.position.z = t.z();
  pose.orientation.x = q.x();
  pose.orientation.y = q.y();
  pose.orientation.z = q.z();
  pose.orientation.w = q.w();

  geometry_msgs::TransformStamped transform;
  transform.header = odometry.header;
  transform.child_frame_id = options_.sensor_frame;
  transform.transform.translation.x = t.x();
  transform.transform.translation.y = t.y();
  transform.transform.translation.z = t.z();
  transform.transform.rotation = pose.orientation;
  tf2_msgs::TFMessage tf;
  tf.transforms.push_back(transform);
  bag_->write("/tf", stamp, tf);
  bag_->write("/odom", stamp, odometry);
}

void RosbagSink::close() {
  if (closed_) return;
  attempt([&] { bag_->close(); });
  file_.commit();
  closed_ = true;
}

}  // namespace beautymap
