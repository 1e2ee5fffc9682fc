// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "rosbag_test_fixture.h"

namespace beautymap {
namespace test {
namespace {

using RosbagSource = RosbagTest;

TEST_F(RosbagSource, DeliversCloudsUntouchedWithTheirPoses) {
  {
    BagWriter bag(bag_);
    writeDrive(bag);
  }
  const auto source = open();
  EXPECT_EQ(source->size(), 5U);
  const auto scans = readAll(*source);
  ASSERT_EQ(scans.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(scans[i].cloud.data, makeCloud(kPoints, static_cast<std::uint8_t>(i)).data);
    EXPECT_TRUE(scans[i].T_map_cloud.isApprox(poseAt(0.1 * static_cast<double>(i), 0, 1)));
    EXPECT_TRUE(scans[i].T_map_sensor.isApprox(scans[i].T_map_cloud));
    EXPECT_EQ(scans[i].stamp_ns, 10'000'000'000 + i * 100'000'000);
  }
  EXPECT_TRUE(source->skipped().empty());
}

TEST_F(RosbagSource, GivesTheSameSequenceAfterRewind) {
  {
    BagWriter bag(bag_);
    writeDrive(bag).cloud(10.2, "lidar", makeCloud({}));
  }
  const auto source = open();
  const auto first = readAll(*source);
  EXPECT_EQ(source->skipped().size(), 1U);
  source->rewind();
  EXPECT_TRUE(source->skipped().empty());
  const auto second = readAll(*source);
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].stamp_ns, second[i].stamp_ns);
    EXPECT_EQ(first[i].cloud.data, second[i].cloud.data);
    EXPECT_EQ(first[i].T_map_cloud.matrix(), second[i].T_map_cloud.matrix());
  }
  EXPECT_EQ(source->skipped().begin()->second.count, 1U);
}

TEST_F(RosbagSource, KeepsTheOrderOfCompressedCloudsThatThreadsReadAhead) {
  constexpr int kScans = 101;
  {
    BagWriter bag(bag_, rosbag::compression::BZ2);
    writeDrive(bag, 10.0, kScans);
  }
  const auto stampsOf = [](ScanSource& source) {
    std::vector<std::uint64_t> stamps;
    for (const SourceScan& scan : readAll(source)) stamps.push_back(scan.stamp_ns);
    return stamps;
  };
  for (const int stride : {1, 3}) {
    options_.stride = stride;
    const auto source = open();
    const std::vector<std::uint64_t> stamps = stampsOf(*source);
    ASSERT_EQ(stamps.size(), static_cast<std::size_t>((kScans + stride - 1) / stride));
    EXPECT_EQ(stamps.size(), source->size());
    for (std::size_t i = 0; i < stamps.size(); ++i) {
      EXPECT_NEAR(static_cast<double>(stamps[i]), 10e9 + 1e8 * stride * static_cast<double>(i),
                  1e3);
    }
    SourceScan scan;
    EXPECT_FALSE(source->next(scan)) << "the end stays the end";
    for (const int read : {1, 7}) {
      source->rewind();
      for (int i = 0; i < read; ++i) ASSERT_TRUE(source->next(scan));
      source->rewind();
      EXPECT_EQ(stampsOf(*source), stamps) << "rewound while threads read";
    }
  }
}

TEST_F(RosbagSource, CountsUnusableCloudsByReason) {
  {
    BagWriter bag(bag_);
    writeDrive(bag);
    auto no_z = makeCloud(kPoints);
    no_z.fields.erase(no_z.fields.begin() + 2);
    auto no_step = makeCloud(kPoints);
    no_step.point_step = 0;
    auto short_data = makeCloud(kPoints);
    short_data.data.resize(20);
    bag.cloud(10.2, "lidar", no_z).cloud(10.21, "lidar", no_step).cloud(10.22, "lidar", short_data);
    bag.cloud(10.23, "lidar", makeCloud({}))
        .cloud(0.0, "lidar", makeCloud(kPoints), "/points", 10.3);
    bag.cloud(10.24, "lidar", pcl::PCLPointCloud2());
  }
  const auto source = open();
  EXPECT_EQ(readAll(*source).size(), 5U);
  EXPECT_EQ(source->skipped().at("malformed cloud").count, 3U);
  EXPECT_NE(source->skipped().at("malformed cloud").example.find("no field 'z'"),
            std::string::npos);
  EXPECT_EQ(source->skipped().at("empty cloud").count, 2U);
  EXPECT_EQ(source->skipped().at("stamp 0").count, 1U);
}

TEST_F(RosbagSource, DeliversBigEndianOrganizedClouds) {
  auto cloud = makeCloud({{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {10, 11, 12}});
  const auto expected = cloud.data;
  for (std::size_t at = 0; at < cloud.data.size(); at += 16) {
    for (const std::size_t offset : {0, 4, 8}) {
      std::reverse(cloud.data.begin() + static_cast<std::ptrdiff_t>(at + offset),
                   cloud.data.begin() + static_cast<std::ptrdiff_t>(at + offset + 4));
    }
  }
  cloud.is_bigendian = true;
  cloud.width = cloud.height = 2;
  cloud.row_step = 40;
  cloud.data.insert(cloud.data.begin() + 32, 8, 0);
  {
    BagWriter bag(bag_);
    bag.tf(1, "map", "lidar", poseAt(0, 0, 0)).cloud(1, "lidar", cloud);
  }
  const auto scans = readAll(*open());
  ASSERT_EQ(scans.size(), 1U);
  EXPECT_EQ(scans[0].cloud.data, expected);
  EXPECT_EQ(scans[0].cloud.height, 1U);
}

TEST_F(RosbagSource, UsesStartDurationAndStride) {
  {
    BagWriter bag(bag_);
    writeDrive(bag, 10.0, 50);
  }
  options_.start_s = 1.05;
  options_.duration_s = 2.0;
  options_.stride = 4;
  const auto source = open();
  const auto scans = readAll(*source);
  ASSERT_EQ(scans.size(), 5U);  // 11.1, 11.5, ... 12.7 (of 11.1 to 13.0)
  EXPECT_EQ(source->size(), 5U);
  EXPECT_EQ(scans.front().stamp_ns, 11'100'000'000U);
  EXPECT_EQ(scans.back().stamp_ns, 12'700'000'000U);
  options_.start_s = 100.0;
  expectError({"start is 100", "4.9"});
}

TEST_F(RosbagSource, FindsStaticTransformsAndPosesOutsideTheChosenTime) {
  {
    BagWriter bag(bag_);
    bag.tf(1.0, "base", "lidar", poseAt(0, 0, 1), "/tf_static");
    bag.tf(190.0, "map", "base", poseAt(190, 0, 0)).tf(210.0, "map", "base", poseAt(210, 0, 0));
    bag.cloud(1.0, "lidar", makeCloud(kPoints)).cloud(200.0, "lidar", makeCloud(kPoints));
    bag.cloud(400.0, "lidar", makeCloud(kPoints));
  }
  options_.start_s = 198.0;
  options_.duration_s = 2.0;
  const auto scans = readAll(*open());
  ASSERT_EQ(scans.size(), 1U);
  EXPECT_TRUE(scans[0].T_map_cloud.isApprox(poseAt(200, 0, 1), 1e-9));
}

TEST_F(RosbagSource, DescribesWhatItUnderstood) {
  {
    BagWriter bag(bag_);
    writeDrive(bag);
  }
  const std::string text = joined(open()->describe());
  for (const char* word : {"/points", "5 scans", "'lidar'", "x y z label", "'map'",
                           "lidar < base_link < map", "first pose: x 0.00 y 0.00 z 1.00"}) {
    EXPECT_NE(text.find(word), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace test
}  // namespace beautymap
