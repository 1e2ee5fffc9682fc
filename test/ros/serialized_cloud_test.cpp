// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/ros/serialized_cloud.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace beautymap {
namespace {

using Bytes = std::vector<std::uint8_t>;

sensor_msgs::PointCloud2 headOfTest() {
  sensor_msgs::PointCloud2 head;
  head.header.frame_id = "map";
  head.header.stamp = ros::Time(12, 34);
  head.fields.resize(2);
  head.fields[0].name = "x";
  head.fields[1].name = "intensity";
  head.point_step = 8;
  head.is_dense = true;
  return head;
}

Bytes bytesOf(const ros::SerializedMessage& message) {
  return {message.buf.get(), message.buf.get() + message.num_bytes};
}

TEST(SerializedCloud, HoldsTheBytesThatRoscppMakesOfTheMessage) {
  const Bytes first(16, 1), none, last(24, 2);
  sensor_msgs::PointCloud2 whole = headOfTest();
  whole.height = 1;
  whole.width = 5;
  whole.row_step = 40;
  whole.data = first;
  whole.data.insert(whole.data.end(), last.begin(), last.end());

  CloudSerializer serializer;
  const SerializedCloud cloud = serializer.serialize(headOfTest(), {&first, &none, &last});
  EXPECT_EQ(bytesOf(cloud.message), bytesOf(ros::serialization::serializeMessage(whole)));
  sensor_msgs::PointCloud2 read;
  ros::serialization::deserializeMessage(cloud.message, read);
  EXPECT_EQ(read.data, whole.data);
}

TEST(SerializedCloud, AMapWithoutPointsAndFieldsIsAMessage) {
  CloudSerializer serializer;
  sensor_msgs::PointCloud2 read;
  ros::serialization::deserializeMessage(serializer.serialize({}, {}).message, read);
  EXPECT_EQ(read.width, 0u);
  EXPECT_TRUE(read.data.empty());
}

TEST(SerializedCloud, IsNotSerializedAgainWhenItIsPublished) {
  CloudSerializer serializer;
  const SerializedCloud cloud = serializer.serialize(headOfTest(), {});
  EXPECT_EQ(ros::serialization::serializeMessage(cloud).buf, cloud.message.buf);
}

TEST(CloudSerializer, LeavesTheBytesAloneThatSomebodyHolds) {
  CloudSerializer serializer;
  const Bytes ones(800, 1), twos(800, 2);
  const SerializedCloud held = serializer.serialize(headOfTest(), {&ones});
  const Bytes before = bytesOf(held.message);
  serializer.serialize(headOfTest(), {&twos});
  serializer.release();
  EXPECT_EQ(bytesOf(held.message), before);
}

TEST(CloudSerializer, UsesMemoryAgainAlsoWhenTheMapHasGrownALittle) {
  CloudSerializer serializer;
  const Bytes small(1000), larger(1200);
  const auto* memory = serializer.serialize(headOfTest(), {&small}).message.buf.get();
  EXPECT_EQ(serializer.serialize(headOfTest(), {&larger}).message.buf.get(), memory);
}

TEST(CloudSerializer, RefusesWhatSubscribersDoNotTake) {
  CloudSerializer serializer;
  const Bytes tenth(CloudSerializer::kMaxBytes / 10);
  EXPECT_THROW(serializer.serialize(headOfTest(), std::vector<const Bytes*>(10, &tenth)),
               std::length_error);
}

}  // namespace
}  // namespace beautymap
