// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
// Files that were damaged or made to do harm: each is refused or skipped with a reason, in little
// memory, and what else is in the input is used.
#include <sys/stat.h>

#include <limits>
#include <random>

#include "beautymap/io/new_file.h"
#include "beautymap/io/pcd_stream.h"
#include "rosbag_test_fixture.h"

namespace beautymap {
namespace test {
namespace {

using HostileInput = RosbagTest;

TEST_F(HostileInput, ATransformStampedAtTheEndOfTimeIsLeftOut) {
  for (const double stamp : {2147483647.0, 4.2e9, 4294967295.0}) {
    {
      BagWriter bag(bag_);
      writeDrive(bag);
      geometry_msgs::TransformStamped far;
      far.header.frame_id = "map";
      far.child_frame_id = "base_link";
      far.header.stamp = ros::Time(static_cast<std::uint32_t>(stamp), 0);
      far.transform.rotation.w = 1.0;
      bag.message("/tf", 10.2, far);
    }
    EXPECT_EQ(readAll(*open()).size(), 5U) << stamp;
  }
}

TEST_F(HostileInput, ACloudStampedAtTheEndOfTimeIsSkippedAndCounted) {
  {
    BagWriter bag(bag_);
    writeDrive(bag);
    bag.cloud(4294967295.0, "lidar", makeCloud(kPoints), "/points", 10.25);
  }
  const auto source = open();
  EXPECT_EQ(readAll(*source).size(), 5U);
  EXPECT_EQ(source->skipped().count("stamp after 2033"), 1U);
}

TEST_F(HostileInput, MessagesRecordedAtTheBeginningAndTheEndOfTimeChangeNoPose) {
  for (const double recorded : {1e-9, 4294967295.0}) {
    {
      BagWriter bag(bag_);
      writeDrive(bag, 1.7e9);
      bag.odometry(1.7e9, "map", "x", poseAt(0, 0, 0), "/other", recorded);
    }
    const auto scans = readAll(*open());
    ASSERT_EQ(scans.size(), 5U) << recorded;
    EXPECT_NEAR(scans[4].T_map_cloud.translation().x(), 0.4, 1e-6);
  }
}

TEST_F(HostileInput, APoseBeyondTheEarthIsLeftOut) {
  {
    BagWriter bag(bag_);
    bag.tf(9.9, "map", "base_link", poseAt(0, 0, 1e300));
    writeDrive(bag);
    bag.cloud(9.9, "lidar", makeCloud(kPoints));
  }
  const auto scans = readAll(*open());
  ASSERT_EQ(scans.size(), 5U);
  for (const auto& scan : scans) EXPECT_NEAR(scan.T_map_sensor.translation().z(), 1.0, 1e-9);
}

TEST_F(HostileInput, NoDamagedBagEndsTheProcess) {
  for (const auto compression : {rosbag::compression::Uncompressed, rosbag::compression::LZ4}) {
    {
      BagWriter bag(bag_, compression);
      writeDrive(bag);
    }
    const std::string whole = readFile(bag_);
    std::mt19937 random(7);
    for (int i = 0; i < 60; ++i) {
      std::string damaged = whole;
      for (int k = 0; k < 2; ++k) {
        damaged[13 + random() % (damaged.size() - 13)] = static_cast<char>(random());
      }
      const std::string path = folder_ / "damaged.bag";
      writeFile(path, damaged);
      try {
        readAll(*openScanSource({path}, options_));
      } catch (const InputError&) {
        continue;  // in words
      }
    }
  }
}

TEST_F(HostileInput, ALengthThatReachesBeyondAChunkIsNamed) {
  {
    BagWriter bag(bag_);
    writeDrive(bag);
  }
  std::string bytes = readFile(bag_);
  // The index of the first chunk: an offset far behind it.
  const std::size_t index = bytes.find("count=", bytes.find("op=\x04"));
  ASSERT_NE(index, std::string::npos);
  const std::size_t entries = bytes.find("ver=", index) + 8;
  bytes[entries + 4 + 8 + 3] = '\x7f';
  writeFile(bag_, bytes);
  expectError({"truncated or broken", "names a message that is not there", "rosbag reindex"});
}

std::string pcdHeader(const std::string& fields, const std::string& sizes, const std::string& types,
                      const std::string& counts, int points, const std::string& data) {
  return "VERSION .7\nFIELDS " + fields + "\nSIZE " + sizes + "\nTYPE " + types + "\nCOUNT " +
         counts + "\nWIDTH " + std::to_string(points) + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\n" +
         "POINTS " + std::to_string(points) + "\nDATA " + data + "\n";
}

TEST_F(HostileInput, PaddingInAnAsciiPcdTakesNoMemory) {
  std::string pcd = pcdHeader("x y z _", "4 4 4 8", "F F F U", "1 1 1 2097150", 100, "ascii");
  for (int i = 0; i < 100; ++i) pcd += "1 2 3\n";
  writeFile(folder_ / "a.pcd", pcd);
  const pcl::PCLPointCloud2 cloud = readPcd(folder_ / "a.pcd");
  EXPECT_EQ(cloud.width, 100U);
  EXPECT_LE(cloud.data.size(), 1200U);
  EXPECT_EQ(pointAt(cloud, 99), Eigen::Vector3d(1, 2, 3));
}

TEST_F(HostileInput, ALineWithoutEndIsNoPcdHeader) {
  writeFile(folder_ / "a.pcd", std::string(3 << 20, 'x'));
  fs::resize_file(folder_ / "a.pcd", std::uintmax_t{3} << 30);  // sparse
  EXPECT_NE(inputErrorOf([&] { readPcd(folder_ / "a.pcd"); }).find("is not a PCD file"),
            std::string::npos);
}

TEST_F(HostileInput, PipesAndDevicesAreRefusedAtOnce) {
  ASSERT_EQ(::mkfifo((folder_ / "pipe.pcd").c_str(), 0600), 0);
  for (const std::string& path : {folder_ / "pipe.pcd", std::string("/dev/zero")}) {
    EXPECT_NE(inputErrorOf([&] { readPcd(path); }).find("not a file"), std::string::npos);
    EXPECT_NE(inputErrorOf([&] { openScanSource({path}, options_); }), "");
  }
}

TEST_F(HostileInput, ALinkAtTheOldTemporaryNamesIsNotFollowed) {
  writeFile(folder_ / "precious", "kept");
  for (const char* name : {"out.pcd.tmp", "out.pcd.tmp-1"}) {
    fs::create_symlink(folder_ / "precious", folder_ / name);
  }
  NewFile file(folder_ / "out.pcd");
  NewFile other(folder_ / "out.pcd");  // two at once
  EXPECT_NE(file.temporaryPath(), other.temporaryPath());
  file.write("first", 5);
  other.write("2nd", 3);
  file.commit();
  EXPECT_EQ(readFile(folder_ / "out.pcd"), "first");
  other.commit();
  EXPECT_EQ(readFile(folder_ / "out.pcd"), "2nd");
  EXPECT_EQ(readFile(folder_ / "precious"), "kept");
}

TEST_F(HostileInput, AnAbandonedFileLeavesWhatWasThereBefore) {
  writeFile(folder_ / "out.pcd", "older");
  {
    NewFile file(folder_ / "out.pcd");
    file.write("half", 4);
  }
  EXPECT_EQ(readFile(folder_ / "out.pcd"), "older");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()), 1);
}

}  // namespace
}  // namespace test
}  // namespace beautymap
