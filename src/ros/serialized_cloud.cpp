// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/ros/serialized_cloud.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace beautymap {

SerializedCloud CloudSerializer::serialize(
    sensor_msgs::PointCloud2 head, const std::vector<const std::vector<std::uint8_t>*>& parts) {
  std::size_t data_size = 0;
  for (const auto* part : parts) data_size += part->size();
  head.data.clear();
  const std::size_t length = ros::serialization::serializationLength(head) + data_size;
  if (length > kMaxBytes) {
    throw std::length_error(std::to_string(length / 1000000) + " MB are more than the " +
                            std::to_string(kMaxBytes / 1000000) + " MB of a ROS message");
  }
  head.height = 1;
  head.row_step = static_cast<std::uint32_t>(data_size);
  head.width = head.point_step == 0 ? 0 : head.row_step / head.point_step;

  SerializedCloud cloud;
  ros::SerializedMessage& message = cloud.message;
  message.num_bytes = sizeof(std::uint32_t) + length;
  message.buf = buffer(message.num_bytes);
  ros::serialization::OStream stream(message.buf.get(),
                                     static_cast<std::uint32_t>(message.num_bytes));
  stream.next(static_cast<std::uint32_t>(length));
  message.message_start = stream.getData();
  // As the generated serializer does, which needs all data in one piece.
  stream.next(head.header);
  stream.next(head.height);
  stream.next(head.width);
  stream.next(head.fields);
  stream.next(head.is_bigendian);
  stream.next(head.point_step);
  stream.next(head.row_step);
  stream.next(static_cast<std::uint32_t>(data_size));
  for (const auto* part : parts) {
    std::copy(part->begin(), part->end(), stream.advance(static_cast<std::uint32_t>(part->size())));
  }
  stream.next(head.is_dense);
  return cloud;
}

void CloudSerializer::release() {
  buffers_.erase(std::remove_if(buffers_.begin(), buffers_.end(),
                                [](const Buffer& b) { return b.bytes.unique(); }),
                 buffers_.end());
}

boost::shared_array<std::uint8_t> CloudSerializer::buffer(std::size_t size) {
  for (const Buffer& b : buffers_) {
    if (b.bytes.unique() && b.capacity >= size) return b.bytes;
  }
  release();  // they are too small
  // Room for the map to grow: memory that is never written to takes none of the machine's.
  const std::size_t capacity = size + size / 2;
  buffers_.push_back({boost::shared_array<std::uint8_t>(new std::uint8_t[capacity]), capacity});
  return buffers_.back().bytes;
}

}  // namespace beautymap
