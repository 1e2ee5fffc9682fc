// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "rosbag_test_fixture.h"

namespace beautymap {
namespace test {
namespace {

using RosbagFiles = RosbagTest;

TEST_F(RosbagFiles, ReadsCompressedBags) {
  for (const auto compression : {rosbag::compression::BZ2, rosbag::compression::LZ4}) {
    {
      BagWriter bag(bag_, compression);
      writeDrive(bag);
    }
    EXPECT_EQ(readAll(*open()).size(), 5U);
  }
}

TEST_F(RosbagFiles, MergesSeveralBagsInTheOrderOfTime) {
  const std::string second = folder_ / "b.bag";
  {
    BagWriter bag(bag_);
    writeDrive(bag, 20.0);
  }
  {
    BagWriter bag(second);
    writeDrive(bag, 10.0);
  }
  const auto scans = readAll(*openScanSource({bag_, second}, options_));
  ASSERT_EQ(scans.size(), 10U);
  for (std::size_t i = 1; i < scans.size(); ++i) {
    EXPECT_LT(scans[i - 1].stamp_ns, scans[i].stamp_ns);
  }
}

TEST_F(RosbagFiles, DeliversEveryScanThriceWhenABagIsGivenThrice) {
  {
    BagWriter bag(bag_);
    writeDrive(bag);
  }
  testing::internal::CaptureStderr();
  const auto source = openScanSource({bag_, bag_, bag_}, options_);
  const auto scans = readAll(*source);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");  // no TF_REPEATED_DATA
  EXPECT_EQ(source->size(), 15U);
  ASSERT_EQ(scans.size(), 15U);
  for (std::size_t i = 0; i < 15; ++i) {
    EXPECT_EQ(scans[i].stamp_ns, 10'000'000'000 + i / 3 * 100'000'000);
    EXPECT_EQ(scans[i].T_map_cloud.matrix(), scans[i / 3 * 3].T_map_cloud.matrix());
  }
}

TEST_F(RosbagFiles, ListsTheCandidatesWhenThereAreSeveralCloudTopics) {
  {
    BagWriter bag(bag_);
    writeDrive(bag);
    bag.cloud(10, "rear", makeCloud(kPoints), "/rear/points");
  }
  expectError({"--cloud-topic", "/points (sensor_msgs/PointCloud2, frame 'lidar', 5 messages)",
               "/rear/points (sensor_msgs/PointCloud2, frame 'rear', 1 messages)"});
  options_.cloud_topic = "/nothing";
  expectError({"/nothing", "/rear/points"});
  options_.cloud_topic = "/points";
  EXPECT_EQ(readAll(*open()).size(), 5U);
}

TEST_F(RosbagFiles, ListsTheTopicsWhenThereAreNoClouds) {
  {
    BagWriter bag(bag_);
    bag.tf(1, "map", "lidar", poseAt(1, 0, 0));
  }
  expectError({"no sensor_msgs/PointCloud2", "/tf (tf2_msgs/TFMessage)"});
}

TEST_F(RosbagFiles, ExplainsWhatToDoWithoutTf) {
  {
    BagWriter bag(bag_);
    bag.cloud(1, "lidar", makeCloud(kPoints)).odometry(1, "odom", "base", poseAt(1, 0, 0));
  }
  expectError({"/tf", "--odom-topic", "/odom (nav_msgs/Odometry, frame 'odom', 1 messages)"});
  {
    BagWriter bag(bag_);
    bag.cloud(1, "lidar", makeCloud(kPoints));
  }
  expectError({"/tf", "no odometry"});
}

TEST_F(RosbagFiles, RefusesWhatIsNotABag) {
  expectError({"a.bag", "no such file"});
  writeFile(bag_, "");
  expectError({"a.bag", "not a ROS bag"});
  writeFile(bag_, "hello");
  expectError({"a.bag", "not a ROS bag"});
  writeFile(bag_, std::string("SQLite format 3\0", 16));
  expectError({"a.bag", "ROS 2"});
}

TEST_F(RosbagFiles, SendsTruncatedBagsToReindex) {
  {
    BagWriter bag(bag_);
    writeDrive(bag, 10.0, 500);
  }
  const std::string whole = readFile(bag_);
  for (const double share : {0.999, 0.5, 0.1}) {
    writeFile(bag_,
              whole.substr(0, static_cast<std::size_t>(share * static_cast<double>(whole.size()))));
    expectError({"rosbag reindex " + bag_});
  }
  for (const std::size_t bytes : {13, 20, 100, 4000}) {  // within and just behind the bag's header
    writeFile(bag_, whole.substr(0, bytes));
    expectError({"rosbag reindex " + bag_});
  }
}

TEST_F(RosbagFiles, SendsUnindexedBagsToReindex) {
  {
    BagWriter bag(bag_);
    writeDrive(bag);
  }
  std::string content = readFile(bag_);
  // A recorder that was killed leaves index_pos at 0.
  const std::size_t at = content.find("index_pos=") + 10;
  content.replace(at, 8, std::string(8, '\0'));
  writeFile(bag_, content);
  expectError({"no index", "rosbag reindex " + bag_});
}

TEST_F(RosbagFiles, RefusesABagWithoutMessages) {
  { BagWriter bag(bag_); }
  expectError({"no messages"});
}

TEST_F(RosbagFiles, UsesWhatIsReadableOfADamagedBag) {
  {
    BagWriter bag(bag_, rosbag::compression::LZ4);
    // Clouds large enough for a chunk each.
    for (int i = 0; i < 6; ++i) {
      bag.tf(1 + i, "map", "lidar", poseAt(i, 0, 0));
      bag.cloud(1 + i, "lidar", makeCloud(std::vector<Eigen::Vector3f>(60000, {1, 2, 3})));
    }
  }
  std::string content = readFile(bag_);
  // Break the compressed bytes of the fourth chunk.
  std::size_t at = 0;
  for (int chunk = 0; chunk < 4; ++chunk) at = content.find("compression=lz4", at + 1);
  content.replace(at + 200, 300, std::string(300, '\xFF'));
  writeFile(bag_, content);
  const auto source = open();
  const auto scans = readAll(*source);
  EXPECT_GE(scans.size(), 3U);
  EXPECT_LT(scans.size(), 6U);
  EXPECT_GE(source->skipped().at("unreadable message").count, 1U);
}

}  // namespace
}  // namespace test
}  // namespace beautymap
