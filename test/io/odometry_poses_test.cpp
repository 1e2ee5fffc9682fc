// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "rosbag_test_fixture.h"

namespace beautymap {
namespace test {
namespace {

using OdometryPoses = RosbagTest;

TEST_F(OdometryPoses, InterpolatesOdometry) {
  {
    BagWriter bag(bag_);
    bag.odometry(10.0, "odom", "lidar", poseAt(0, 0, 0, 0.0));
    bag.odometry(10.8, "odom", "lidar", poseAt(8, 0, 0, 0.8));
    bag.cloud(10.2, "lidar", makeCloud(kPoints)).cloud(10.8, "lidar", makeCloud(kPoints));
  }
  options_.odom_topic = "/odom";
  const auto scans = readAll(*open());
  ASSERT_EQ(scans.size(), 2U);
  EXPECT_TRUE(scans[0].T_map_cloud.isApprox(poseAt(2, 0, 0, 0.2), 1e-9));
  EXPECT_TRUE(scans[1].T_map_cloud.isApprox(poseAt(8, 0, 0, 0.8), 1e-9));
  EXPECT_TRUE(scans[1].T_map_sensor.isApprox(scans[1].T_map_cloud));
}

TEST_F(OdometryPoses, NeitherExtrapolatesOdometryNorBridgesGaps) {
  {
    BagWriter bag(bag_);
    for (const double stamp : {10.0, 10.5, 12.0}) {
      bag.odometry(stamp, "odom", "lidar", poseAt(stamp, 0, 0));
    }
    for (const double stamp : {9.9, 10.2, 11.0, 12.1}) {
      bag.cloud(stamp, "lidar", makeCloud(kPoints));
    }
  }
  options_.odom_topic = "odom";
  const auto source = open();
  EXPECT_EQ(readAll(*source).size(), 1U);
  const auto& skipped = source->skipped().at("no odometry at the scan's stamp");
  EXPECT_EQ(skipped.count, 3U);
  EXPECT_NE(skipped.example.find("covers 10.000 s to 12.000 s"), std::string::npos)
      << skipped.example;
}

TEST_F(OdometryPoses, PlacesRegisteredCloudsByOdometry) {
  {
    BagWriter bag(bag_);
    bag.odometry(1, "camera_init", "body", poseAt(3, 0, 0))
        .cloud(1, "camera_init", makeCloud(kPoints));
    bag.tf(1, "body", "lidar", poseAt(0, 0, 1), "/tf_static");
  }
  options_.odom_topic = "/odom";
  auto scans = readAll(*open());
  ASSERT_EQ(scans.size(), 1U);
  EXPECT_EQ(scans[0].T_map_cloud.matrix(), Eigen::Isometry3d::Identity().matrix());
  EXPECT_TRUE(scans[0].T_map_sensor.isApprox(poseAt(3, 0, 0)));
  options_.sensor_frame = "lidar";
  scans = readAll(*open());
  EXPECT_TRUE(scans.at(0).T_map_sensor.isApprox(poseAt(3, 0, 1)));
  options_.sensor_frame = "nowhere";
  expectError({"'nowhere'", "'body'"});
  options_.sensor_frame.clear();
  options_.map_frame = "map";
  expectError({"'map'", "'camera_init'"});
}

TEST_F(OdometryPoses, ConnectsOdometryAndCloudsByTf) {
  {
    BagWriter bag(bag_);
    bag.odometry(1, "odom", "base", poseAt(3, 0, 0)).cloud(1, "lidar", makeCloud(kPoints));
    bag.tf(1, "base", "lidar", poseAt(0, 0, 1), "/tf_static");
  }
  options_.odom_topic = "/odom";
  const auto scans = readAll(*open());
  ASSERT_EQ(scans.size(), 1U);
  EXPECT_TRUE(scans[0].T_map_cloud.isApprox(poseAt(3, 0, 1)));
  EXPECT_TRUE(scans[0].T_map_sensor.isApprox(poseAt(3, 0, 1)));
}

TEST_F(OdometryPoses, SaysWhenItTakesTheOdometryForTheCloudsPose) {
  {
    BagWriter bag(bag_);
    bag.odometry(1, "odom", "base", poseAt(3, 0, 0)).cloud(1, "lidar", makeCloud(kPoints));
  }
  options_.odom_topic = "/odom";
  const auto source = open();
  EXPECT_NE(joined(source->describe()).find("is taken as the pose of the clouds"),
            std::string::npos);
  EXPECT_TRUE(readAll(*source).at(0).T_map_cloud.isApprox(poseAt(3, 0, 0)));
}

TEST_F(OdometryPoses, ListsTheOdometryTopics) {
  {
    BagWriter bag(bag_);
    bag.odometry(1, "odom", "base", poseAt(3, 0, 0)).cloud(1, "lidar", makeCloud(kPoints));
  }
  options_.odom_topic = "/nothing";
  expectError({"/nothing", "/odom (nav_msgs/Odometry, frame 'odom', 1 messages)"});
}

}  // namespace
}  // namespace test
}  // namespace beautymap
