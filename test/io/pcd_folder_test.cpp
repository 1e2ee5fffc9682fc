// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>

#include "beautymap/io/pcd_stream.h"
#include "io_test_helpers.h"

namespace beautymap {
namespace test {
namespace {

void writeScan(const std::string& path, const pcl::PCLPointCloud2& cloud,
               const Eigen::Isometry3d& pose) {
  fs::create_directories(fs::path(path).parent_path());
  PcdStreamWriter writer(path, cloud, pose);
  for (std::size_t i = 0; i < pointCount(cloud); ++i) {
    writer.append(cloud.data.data() + i * cloud.point_step);
  }
  writer.close();
}

class PcdFolder : public testing::Test {
 protected:
  std::unique_ptr<ScanSource> open() { return openScanSource({folder_.path().string()}, options_); }
  std::string openError() {
    return inputErrorOf([&] { open(); });
  }
  TempFolder folder_;
  SourceOptions options_;
};

TEST_F(PcdFolder, DeliversPointsInTheMapFrameAndTheSensorFromViewpoint) {
  const auto cloud = makeCloud({{11, 2, 3}, {14, 5, 6}}, 1);
  writeScan(folder_ / "pcd/000000.pcd", cloud, poseAt(10, 0, 1, 0.5));
  const auto source = open();
  const auto scans = readAll(*source);
  ASSERT_EQ(scans.size(), 1U);
  EXPECT_EQ(fieldNames(scans[0].cloud), "x y z label");
  EXPECT_EQ(pointAt(scans[0].cloud, 1), Eigen::Vector3d(14, 5, 6));
  EXPECT_EQ(scans[0].T_map_cloud.matrix(), Eigen::Matrix4d::Identity());
  EXPECT_TRUE(scans[0].T_map_sensor.isApprox(poseAt(10, 0, 1, 0.5), 1e-12));
  EXPECT_EQ(scans[0].stamp_ns, 0U);
  EXPECT_TRUE(source->isMoving(1));
  EXPECT_FALSE(source->isMoving(0));
}

TEST_F(PcdFolder, ReadsFilesWithoutInnerFolderInNaturalOrder) {
  for (const int i : {10, 9, 2, 1}) {
    writeScan(folder_ / ("scan_" + std::to_string(i) + ".pcd"), makeCloud({{1, 2, 3}}),
              poseAt(i, 0, 0));
  }
  const auto scans = readAll(*open());
  ASSERT_EQ(scans.size(), 4U);
  EXPECT_EQ(scans[0].T_map_sensor.translation().x(), 1.0);
  EXPECT_EQ(scans[1].T_map_sensor.translation().x(), 2.0);
  EXPECT_EQ(scans[2].T_map_sensor.translation().x(), 9.0);
  EXPECT_EQ(scans[3].T_map_sensor.translation().x(), 10.0);
  options_.stride = 2;
  EXPECT_EQ(readAll(*open()).size(), 2U);
}

TEST_F(PcdFolder, ReadsAsciiAndCompressedFiles) {
  fs::create_directories(folder_ / "pcd");
  pcl::PCDWriter writer;
  const auto cloud = makeCloud({{11, 2, 3}, {14, 5, 6}}, 1);
  const Eigen::Vector4f origin(10, 0, 1, 0);
  writer.writeASCII(folder_ / "pcd/0.pcd", cloud, origin);
  writer.writeBinaryCompressed(folder_ / "pcd/1.pcd", cloud, origin);
  writer.writeBinary(folder_ / "pcd/2.pcd", cloud, origin);
  const auto scans = readAll(*open());
  ASSERT_EQ(scans.size(), 3U);
  for (const auto& scan : scans) {
    EXPECT_EQ(pointAt(scan.cloud, 1), Eigen::Vector3d(14, 5, 6));
    EXPECT_EQ(scan.T_map_sensor.translation(), Eigen::Vector3d(10, 0, 1));
  }
}

TEST_F(PcdFolder, RefusesViewpointsThatAreAllTheDefault) {
  for (const char* name : {"0.pcd", "1.pcd"}) {
    writeScan(folder_ / name, makeCloud({{1, 2, 3}}), Eigen::Isometry3d::Identity());
  }
  const std::string error = openError();
  EXPECT_NE(error.find("the pose of every scan is the origin"), std::string::npos) << error;
  EXPECT_NE(error.find("VIEWPOINT must hold the sensor's pose"), std::string::npos) << error;
}

TEST_F(PcdFolder, AcceptsASingleScanAtTheOrigin) {
  writeScan(folder_ / "0.pcd", makeCloud({{1, 2, 3}}), Eigen::Isometry3d::Identity());
  EXPECT_EQ(readAll(*open()).size(), 1U);
}

TEST_F(PcdFolder, WarnsWhenThePointsLieAroundTheOriginInsteadOfTheSensor) {
  const auto cloud = makeCloud({{1, 2, 0}, {-2, 1, 0}, {3, -1, 0}});
  writeScan(folder_ / "0.pcd", cloud, poseAt(0, 0, 0));
  writeScan(folder_ / "1.pcd", cloud, poseAt(60, 0, 0));
  std::string text;
  for (const auto& line : open()->describe()) text += line + "\n";
  EXPECT_NE(text.find("WARNING"), std::string::npos) << text;
  EXPECT_NE(text.find("60.0 m long"), std::string::npos) << text;
}

TEST_F(PcdFolder, CountsUnusableFilesByReason) {
  const auto cloud = makeCloud({{1, 2, 3}});
  writeScan(folder_ / "0.pcd", cloud, poseAt(1, 0, 0));
  writeScan(folder_ / "1.pcd", cloud, poseAt(2, 0, 0));
  writeScan(folder_ / "2.pcd", makeCloud({}), poseAt(3, 0, 0));
  writeFile(folder_ / "3.pcd", "rubbish");
  const std::string good = readFile(folder_ / "1.pcd");
  writeFile(folder_ / "4.pcd", good.substr(0, good.size() - 1));
  const auto with_viewpoint = [&](const std::string& viewpoint) {
    const std::size_t begin = good.find("VIEWPOINT ") + 10;
    return std::string(good).replace(begin, good.find('\n', begin) - begin, viewpoint);
  };
  writeFile(folder_ / "5.pcd", with_viewpoint("1 2 3 0 0 0 0"));
  writeFile(folder_ / "6.pcd", with_viewpoint("nan 2 3 1 0 0 0"));
  const auto source = open();
  EXPECT_EQ(readAll(*source).size(), 2U);
  EXPECT_EQ(source->skipped().at("unreadable PCD file").count, 2U);
  EXPECT_EQ(source->skipped().at("empty cloud").count, 1U);
  EXPECT_EQ(source->skipped().at("VIEWPOINT is not a pose").count, 2U);
}

TEST_F(PcdFolder, RefusesTimesAndTopics) {
  writeScan(folder_ / "0.pcd", makeCloud({{1, 2, 3}}), poseAt(1, 0, 0));
  options_.start_s = 1.0;
  EXPECT_NE(openError().find("no stamps"), std::string::npos);
  options_ = SourceOptions();
  options_.map_frame = "map";
  EXPECT_NE(openError().find("mean nothing"), std::string::npos);
}

TEST(OpenScanSource, SaysWhatIsExpectedInstead) {
  const TempFolder folder;
  writeFile(folder / "a.pcd", "x");
  writeFile(folder / "empty/readme.txt", "x");
  const auto error = [](const std::string& input) {
    return inputErrorOf([&] { openScanSource({input}, {}); });
  };
  for (const std::string& input :
       {folder / "a.pcd", folder / "empty", folder / "missing", std::string("/dev/null")}) {
    const std::string what = error(input);
    EXPECT_NE(what.find(input), std::string::npos) << what;
  }
  EXPECT_NE(error(folder / "a.pcd").find("single cloud"), std::string::npos);
  EXPECT_NE(error(folder / "empty").find("holds no scans"), std::string::npos);
  EXPECT_NE(error(folder / "missing").find("no such file"), std::string::npos);
  EXPECT_NE(inputErrorOf([] { openScanSource({}, {}); }).find("expected"), std::string::npos);
  EXPECT_NE(inputErrorOf([&] {
              openScanSource({folder / "empty", folder / "a.pcd"}, {});
            }).find("only bags"),
            std::string::npos);
}

}  // namespace
}  // namespace test
}  // namespace beautymap
