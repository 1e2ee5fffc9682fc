// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "rosbag_test_fixture.h"

namespace beautymap {
namespace test {
namespace {

using TfPoses = RosbagTest;

TEST_F(TfPoses, InterpolatesTransformsAtTheStampOfTheCloud) {
  {
    BagWriter bag(bag_);
    bag.tf(10.0, "map", "lidar", poseAt(0, 0, 0, 0.0));
    bag.tf(11.0, "map", "lidar", poseAt(4, 0, 0, 1.0));
    bag.cloud(10.25, "lidar", makeCloud(kPoints));
  }
  const auto scans = readAll(*open());
  ASSERT_EQ(scans.size(), 1U);
  EXPECT_TRUE(scans[0].T_map_cloud.isApprox(poseAt(1, 0, 0, 0.25), 1e-9));
}

TEST_F(TfPoses, InterpolatesAcrossGapsAndAcrossStretchesOfTime) {
  {
    BagWriter bag(bag_);
    for (const double stamp : {5.0, 19.9, 20.1, 105.0}) {
      bag.tf(stamp, "map", "lidar", poseAt(stamp, 0, 0));
    }
    for (const double stamp : {6.0, 15.0, 20.0, 30.0, 50.0, 104.0}) {
      bag.cloud(stamp, "lidar", makeCloud(kPoints));
    }
  }
  const auto scans = readAll(*open());
  ASSERT_EQ(scans.size(), 6U);
  for (const auto& scan : scans) {
    EXPECT_NEAR(scan.T_map_cloud.translation().x(), static_cast<double>(scan.stamp_ns) * 1e-9,
                1e-6);
  }
}

TEST_F(TfPoses, SkipsCloudsWithoutTransformAndCountsThem) {
  {
    BagWriter bag(bag_);
    writeDrive(bag);
    bag.cloud(9.5, "lidar", makeCloud(kPoints)).cloud(12.0, "lidar", makeCloud(kPoints));
  }
  const auto source = open();
  EXPECT_EQ(readAll(*source).size(), 5U);
  ASSERT_EQ(source->skipped().size(), 1U);
  const auto& [reason, skipped] = *source->skipped().begin();
  EXPECT_EQ(reason, "no transform from 'lidar' to 'map' at the scan's stamp");
  EXPECT_EQ(skipped.count, 2U);
  EXPECT_NE(skipped.example.find("9.500 s"), std::string::npos) << skipped.example;
  EXPECT_NE(skipped.example.find("covers 10.000 s to 10.400 s"), std::string::npos)
      << skipped.example;
}

TEST_F(TfPoses, EndsWithoutAScanWhenNoneHasAPose) {
  {
    BagWriter bag(bag_);
    writeDrive(bag);
  }
  {
    BagWriter bag(folder_ / "b.bag");
    bag.tf(10.0, "map", "base_link", poseAt(1, 0, 0)).cloud(10, "velodyne", makeCloud(kPoints));
  }
  const auto source = openScanSource({folder_ / "b.bag"}, options_);
  EXPECT_TRUE(readAll(*source).empty());
  ASSERT_EQ(source->skipped().size(), 1U);
  const std::string example = source->skipped().begin()->second.example;
  EXPECT_NE(example.find("no frame 'velodyne'"), std::string::npos) << example;
  EXPECT_NE(example.find("base_link, map"), std::string::npos) << example;
}

TEST_F(TfPoses, SaysWhenCloudsAndTfHaveDifferentClocks) {
  {
    BagWriter bag(bag_);
    bag.tf(1e9, "map", "lidar", poseAt(0, 0, 0)).tf(1e9 + 1, "map", "lidar", poseAt(1, 0, 0));
    bag.cloud(12.0, "lidar", makeCloud(kPoints), "/points", 1e9 + 0.5);
  }
  const auto source = open();
  EXPECT_TRUE(readAll(*source).empty());
  const std::string example = source->skipped().begin()->second.example;
  EXPECT_NE(example.find("another clock"), std::string::npos) << example;
}

TEST_F(TfPoses, StripsLeadingSlashes) {
  {
    BagWriter bag(bag_);
    bag.tf(1, "/map", "/lidar", poseAt(1, 0, 0)).cloud(1, "/lidar", makeCloud(kPoints));
  }
  options_.map_frame = "/map";
  options_.cloud_topic = "points";
  const auto scans = readAll(*open());
  ASSERT_EQ(scans.size(), 1U);
  EXPECT_EQ(scans[0].T_map_cloud.translation().x(), 1.0);
}

TEST_F(TfPoses, ChoosesTheOnlyRootWhereThereIsNoMap) {
  {
    BagWriter bag(bag_);
    bag.tf(1, "world", "base", poseAt(1, 0, 0)).tf(1, "base", "lidar", poseAt(1, 0, 0));
    bag.cloud(1, "lidar", makeCloud(kPoints));
  }
  const auto scans = readAll(*open());
  ASSERT_EQ(scans.size(), 1U);
  EXPECT_EQ(scans[0].T_map_cloud.translation().x(), 2.0);
}

TEST_F(TfPoses, AsksForTheMapFrameWhenItIsNotClear) {
  {
    BagWriter bag(bag_);
    bag.tf(1, "odom", "base", poseAt(1, 0, 0)).tf(1, "base_link", "lidar", poseAt(1, 0, 0));
    bag.cloud(1, "lidar", makeCloud(kPoints));
  }
  expectError({"--map-frame", "2 roots (base_link, odom)", "base, base_link, lidar, odom"});
  options_.map_frame = "nowhere";
  expectError({"'nowhere'", "--map-frame", "base, base_link, lidar, odom"});
}

TEST_F(TfPoses, ReadsRegisteredCloudsWithTheSensorFrame) {
  {
    BagWriter bag(bag_);  // as FAST-LIO publishes: camera_init -> body, no frame called map
    for (int i = 0; i < 3; ++i) {
      bag.tf(1 + i, "camera_init", "body", poseAt(i, 0, 0, 0.5));
      bag.cloud(1 + i, "camera_init", makeCloud(kPoints));
    }
  }
  expectError({"'camera_init'", "--sensor-frame", "body, camera_init"});
  options_.sensor_frame = "body";
  const auto scans = readAll(*open());
  ASSERT_EQ(scans.size(), 3U);
  EXPECT_EQ(scans[2].T_map_cloud.matrix(), Eigen::Isometry3d::Identity().matrix());
  EXPECT_TRUE(scans[2].T_map_sensor.isApprox(poseAt(2, 0, 0, 0.5), 1e-9));
  options_.sensor_frame = "nowhere";
  expectError({"'nowhere'", "--sensor-frame", "body, camera_init"});
}

TEST_F(TfPoses, RefusesCloudsRegisteredBelowTheMapWithoutTheSensorFrame) {
  {
    BagWriter bag(bag_);  // as LIO-SAM publishes: clouds in odom, below map
    for (int i = 0; i < 3; ++i) {
      bag.tf(1 + i, "map", "odom", Eigen::Isometry3d::Identity());
      bag.tf(1 + i, "odom", "base_link", poseAt(i, 0, 0));
      bag.cloud(1 + i, "odom", makeCloud(kPoints));
    }
  }
  expectError({"'odom'", "--sensor-frame"});
  options_.sensor_frame = "base_link";
  const auto scans = readAll(*open());
  ASSERT_EQ(scans.size(), 3U);
  EXPECT_EQ(scans[2].T_map_sensor.translation().x(), 2.0);
}

TEST_F(TfPoses, AcceptsASensorWithMovingJointsBelowIt) {
  {
    BagWriter bag(bag_);
    for (int i = 0; i < 3; ++i) {
      bag.tf(1 + i, "map", "base_link", poseAt(i, 0, 0));
      bag.tf(1 + i, "base_link", "wheel", poseAt(0, 0, 0, i));
      bag.cloud(1 + i, "base_link", makeCloud(kPoints));
    }
  }
  EXPECT_EQ(readAll(*open()).size(), 3U);
}

TEST_F(TfPoses, TakesTheBeamsOriginFromTheSensorFrame) {
  {
    BagWriter bag(bag_);
    bag.tf(1, "base_link", "lidar", poseAt(0, 0, 2), "/tf_static");
    bag.tf(1, "map", "base_link", poseAt(5, 0, 0)).cloud(1, "base_link", makeCloud(kPoints));
  }
  options_.sensor_frame = "lidar";
  const auto scans = readAll(*open());
  ASSERT_EQ(scans.size(), 1U);
  EXPECT_TRUE(scans[0].T_map_cloud.isApprox(poseAt(5, 0, 0)));
  EXPECT_TRUE(scans[0].T_map_sensor.isApprox(poseAt(5, 0, 2)));
}

TEST_F(TfPoses, NeverDeliversANonFinitePose) {
  const double nan = std::nan("");
  {
    BagWriter bag(bag_);
    bag.rawTf(1, "map", "lidar", {1, 0, 0}, {0, 0, 0, 0}).cloud(1, "lidar", makeCloud(kPoints));
    bag.rawTf(2, "map", "lidar", {nan, 0, 0}, {0, 0, 0, 1}).cloud(2, "lidar", makeCloud(kPoints));
    bag.rawTf(3, "map", "lidar", {1, 0, 0}, {0, nan, 0, 1}).cloud(3, "lidar", makeCloud(kPoints));
    bag.tf(4, "map", "lidar", poseAt(1, 0, 0)).cloud(4, "lidar", makeCloud(kPoints));
  }
  testing::internal::CaptureStderr();
  const auto source = open();
  const auto scans = readAll(*source);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  ASSERT_EQ(scans.size(), 1U);
  EXPECT_TRUE(scans[0].T_map_cloud.matrix().allFinite());
  EXPECT_EQ(source->skipped().begin()->second.count, 3U);
  EXPECT_NE(source->skipped().begin()->second.example.find("3 transforms are unusable"),
            std::string::npos);
}

TEST_F(TfPoses, SaysWhenAllTransformsAreUnusable) {
  {
    BagWriter bag(bag_);
    bag.rawTf(1, "map", "lidar", {1, 0, 0}, {0, 0, 0, 0}).cloud(1, "lidar", makeCloud(kPoints));
  }
  expectError({"no usable transforms", "1 unusable", "quaternion"});
}

TEST_F(TfPoses, WarnsThatTheSensorNeverMoves) {
  {
    BagWriter bag(bag_);
    bag.tf(1, "base_link", "lidar", poseAt(0, 0, 1), "/tf_static");
    bag.cloud(1, "lidar", makeCloud(kPoints));
  }
  EXPECT_NE(joined(open()->describe()).find("never moves"), std::string::npos);
}

}  // namespace
}  // namespace test
}  // namespace beautymap
