// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <gtest/gtest.h>
#include <nav_msgs/Odometry.h>
#include <pcl/PCLPointCloud2.h>
#include <pcl_conversions/pcl_conversions.h>
#include <rosbag/bag.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_msgs/TFMessage.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "beautymap/io/cloud_fields.h"
#include "beautymap/io/scan_source.h"

namespace beautymap {
namespace test {

namespace fs = std::filesystem;

/// A folder that is removed with everything in it.
class TempFolder {
 public:
  TempFolder() {
    std::string name = (fs::temp_directory_path() / "beautymap_test_XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~TempFolder() {
    std::error_code error;
    fs::remove_all(path_, error);
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// Collects fields, then values; offsets and point_step may leave gaps.
class CloudBuilder {
 public:
  CloudBuilder& field(const std::string& name, std::uint8_t datatype, std::uint32_t offset,
                      std::uint32_t count = 1) {
    pcl::PCLPointField f;
    f.name = name;
    f.datatype = datatype;
    f.offset = offset;
    f.count = count;
    cloud_.fields.push_back(f);
    return *this;
  }
  CloudBuilder& size(std::uint32_t points, std::uint32_t point_step) {
    cloud_.width = points;
    cloud_.height = 1;
    cloud_.point_step = point_step;
    cloud_.row_step = points * point_step;
    cloud_.is_bigendian = false;
    // Padding has a pattern, so that a test notices when it is touched.
    cloud_.data.resize(cloud_.row_step);
    for (std::size_t i = 0; i < cloud_.data.size(); ++i) {
      cloud_.data[i] = static_cast<std::uint8_t>(i * 37 + 11);
    }
    return *this;
  }
  template <typename T>
  CloudBuilder& set(std::size_t point, std::size_t offset, T value) {
    std::memcpy(cloud_.data.data() + point * cloud_.point_step + offset, &value, sizeof(T));
    return *this;
  }
  pcl::PCLPointCloud2 build() const { return cloud_; }

 private:
  pcl::PCLPointCloud2 cloud_;
};

/// x y z float32 and uint8 label in 16 bytes, one point per position.
inline pcl::PCLPointCloud2 makeCloud(const std::vector<Eigen::Vector3f>& points,
                                     std::uint8_t label = 0) {
  CloudBuilder builder;
  builder.field("x", 7, 0).field("y", 7, 4).field("z", 7, 8).field("label", 2, 12);
  builder.size(static_cast<std::uint32_t>(points.size()), 16);
  for (std::size_t i = 0; i < points.size(); ++i) {
    builder.set(i, 0, points[i].x()).set(i, 4, points[i].y()).set(i, 8, points[i].z());
    builder.set(i, 12, label);
  }
  return builder.build();
}

inline Eigen::Vector3d pointAt(const pcl::PCLPointCloud2& cloud, std::size_t i) {
  return {FieldReader(cloud, "x")(i), FieldReader(cloud, "y")(i), FieldReader(cloud, "z")(i)};
}

inline Eigen::Isometry3d poseAt(double x, double y, double z, double yaw_rad = 0.0) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(x, y, z);
  pose.linear() = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return pose;
}

/// Writes small bags; all times in seconds.
class BagWriter {
 public:
  explicit BagWriter(const std::string& path,
                     rosbag::CompressionType compression = rosbag::compression::Uncompressed)
      : bag_(path, rosbag::bagmode::Write) {
    bag_.setCompression(compression);
  }

  BagWriter& cloud(double stamp, const std::string& frame, pcl::PCLPointCloud2 cloud,
                   const std::string& topic = "/points", double record_time = 0.0) {
    sensor_msgs::PointCloud2 message;
    pcl_conversions::moveFromPCL(cloud, message);
    message.header.stamp = ros::Time(stamp);
    message.header.frame_id = frame;
    bag_.write(topic, ros::Time(record_time > 0.0 ? record_time : stamp), message);
    return *this;
  }

  BagWriter& tf(double stamp, const std::string& parent, const std::string& child,
                const Eigen::Isometry3d& pose, const std::string& topic = "/tf") {
    const Eigen::Quaterniond q(pose.linear());
    return rawTf(stamp, parent, child, pose.translation(), q.coeffs(), topic);
  }

  BagWriter& message(const std::string& topic, double record_time,
                     const geometry_msgs::TransformStamped& transform) {
    tf2_msgs::TFMessage message;
    message.transforms.push_back(transform);
    bag_.write(topic, ros::Time(record_time), message);
    return *this;
  }

  BagWriter& rawTf(double stamp, const std::string& parent, const std::string& child,
                   const Eigen::Vector3d& t, const Eigen::Vector4d& q,
                   const std::string& topic = "/tf") {
    geometry_msgs::TransformStamped transform;
    transform.header.stamp = ros::Time(stamp);
    transform.header.frame_id = parent;
    transform.child_frame_id = child;
    transform.transform.translation.x = t.x();
    transform.transform.translation.y = t.y();
    transform.transform.translation.z = t.z();
    transform.transform.rotation.x = q.x();
    transform.transform.rotation.y = q.y();
    transform.transform.rotation.z = q.z();
    transform.transform.rotation.w = q.w();
    tf2_msgs::TFMessage message;
    message.transforms.push_back(transform);
    bag_.write(topic, ros::Time(stamp), message);
    return *this;
  }

  BagWriter& odometry(double stamp, const std::string& frame, const std::string& child,
                      const Eigen::Isometry3d& pose, const std::string& topic = "/odom",
                      double record_time = 0.0) {
    const Eigen::Quaterniond q(pose.linear());
    nav_msgs::Odometry message;
    message.header.stamp = ros::Time(stamp);
    message.header.frame_id = frame;
    message.child_frame_id = child;
    message.pose.pose.position.x = pose.translation().x();
    message.pose.pose.position.y = pose.translation().y();
    message.pose.pose.position.z = pose.translation().z();
    message.pose.pose.orientation.x = q.x();
    message.pose.pose.orientation.y = q.y();
    message.pose.pose.orientation.z = q.z();
    message.pose.pose.orientation.w = q.w();
    bag_.write(topic, ros::Time(record_time > 0.0 ? record_time : stamp), message);
    return *this;
  }

  /// Without it the bag has its index when the writer is destroyed.
  void close() { bag_.close(); }

 private:
  rosbag::Bag bag_;
};

inline std::vector<SourceScan> readAll(ScanSource& source) {
  std::vector<SourceScan> scans;
  SourceScan scan;
  while (source.next(scan)) scans.push_back(scan);
  return scans;
}

/// what() of the InputError that a call throws; empty without one.
template <typename Call>
std::string inputErrorOf(const Call& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

inline void writeFile(const std::string& path, const std::string& content) {
  fs::create_directories(fs::path(path).parent_path());
  std::ofstream(path, std::ios::binary) << content;
}

inline std::string readFile(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

}  // namespace test
}  // namespace beautymap
