// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <sensor_msgs/PointCloud2.h>

#include <boost/shared_array.hpp>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace beautymap {

/// A sensor_msgs/PointCloud2 as the bytes that are sent, for ros::Publisher::publish(). An ordinary
/// message is serialized in there, while every other publish() of the process waits: for a map of
/// hundreds of MB each scan's topics would be late.
struct SerializedCloud {
  ros::SerializedMessage message;
};

/// Makes them, in memory that is used again as soon as roscpp has let go of it: to get, clear and
/// return so many pages takes longer than to copy the points, and stops the other threads.
class CloudSerializer {
 public:
  /// A subscriber in C++ closes the connection when a message is larger.
  static constexpr std::size_t kMaxBytes = 1000000000;

  /// @param head   fields, point_step and header; what depends on the number of points is filled in
  /// @param parts  of the data, in their order
  /// @throws std::length_error beyond kMaxBytes
  SerializedCloud serialize(sensor_msgs::PointCloud2 head,
                            const std::vector<const std::vector<std::uint8_t>*>& parts);
  /// Frees what is not in use.
  void release();

 private:
  struct Buffer {
    boost::shared_array<std::uint8_t> bytes;
    std::size_t capacity;
  };
  boost::shared_array<std::uint8_t> buffer(std::size_t size);

  std::vector<Buffer> buffers_;
};

}  // namespace beautymap

namespace ros {
namespace message_traits {

template <>
struct MD5Sum<beautymap::SerializedCloud> {
  static const char* value() { return MD5Sum<sensor_msgs::PointCloud2>::value(); }
  static const char* value(const beautymap::SerializedCloud&) { return value(); }
};

template <>
struct DataType<beautymap::SerializedCloud> {
  static const char* value() { return DataType<sensor_msgs::PointCloud2>::value(); }
  static const char* value(const beautymap::SerializedCloud&) { return value(); }
};

}  // namespace message_traits

namespace serialization {

template <>
inline SerializedMessage serializeMessage(const beautymap::SerializedCloud& cloud) {
  return cloud.message;
}

}  // namespace serialization
}  // namespace ros
