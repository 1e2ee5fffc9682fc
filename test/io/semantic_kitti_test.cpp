// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "io_test_helpers.h"

namespace beautymap {
namespace test {
namespace {

template <typename T>
std::string bytesOf(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

// The camera looks along the velodyne's x: camera z = velodyne x, camera x = -velodyne y, and it is
// mounted 0.27 m before and 0.08 m below the velodyne.
const char* const kCalibration =
    "P0: 1 0 0 0 0 1 0 0 0 0 1 0\nTr: 0 -1 0 0 0 0 -1 -0.08 1 0 0 -0.27\n";
// The camera drives 2 m forward (its z) a scan.
const char* const kPoses =
    "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 2\n1 0 0 0 0 1 0 0 0 0 1 4\n";

class SemanticKitti : public testing::Test {
 protected:
  SemanticKitti() {
    writeFile(folder_ / "calib.txt", kCalibration);
    writeFile(folder_ / "poses.txt", kPoses);
    for (int i = 0; i < 3; ++i) {
      const auto x = static_cast<float>(i);
      writeFile(path("velodyne", i, ".bin"), bytesOf<float>({x, 1, 2, 0.5F, 4, 5, 6, 0.25F}));
    }
  }
  void writeLabels() {
    for (int i = 0; i < 3; ++i) {
      writeFile(path("labels", i, ".label"), bytesOf<std::uint32_t>({40, 0x00070000 | 252}));
    }
  }
  std::string path(const std::string& kind, int number, const std::string& extension) const {
    return folder_ / (kind + "/00000" + std::to_string(number) + extension);
  }
  std::unique_ptr<ScanSource> open() { return openScanSource({folder_.path().string()}, options_); }
  std::string openError() {
    return inputErrorOf([&] { open(); });
  }
  TempFolder folder_;
  SourceOptions options_;
};

TEST_F(SemanticKitti, TurnsCameraPosesIntoVelodynePoses) {
  const auto scans = readAll(*open());
  ASSERT_EQ(scans.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(scans[i].T_map_cloud.isApprox(poseAt(2.0 * static_cast<double>(i), 0, 0), 1e-9));
    EXPECT_TRUE(scans[i].T_map_sensor.isApprox(scans[i].T_map_cloud));
    EXPECT_EQ(pointAt(scans[i].cloud, 0), Eigen::Vector3d(static_cast<double>(i), 1, 2));
    EXPECT_EQ(FieldReader(scans[i].cloud, "intensity")(1), 0.25);
    EXPECT_EQ(scans[i].stamp_ns, 1'000'000'000 + i * 100'000'000);
  }
  EXPECT_EQ(fieldNames(scans[0].cloud), "x y z intensity");
}

TEST_F(SemanticKitti, KeepsLabelsAndKnowsTheMovingClasses) {
  writeLabels();
  const auto source = open();
  const auto scans = readAll(*source);
  ASSERT_EQ(scans.size(), 3U);
  const FieldReader label(scans[0].cloud, "label");
  EXPECT_EQ(label.datatype(), 6);
  EXPECT_EQ(label(0), 40);
  EXPECT_EQ(label(1), 0x00070000 | 252);
  EXPECT_FALSE(source->isMoving(40));
  EXPECT_FALSE(source->isMoving(251));
  EXPECT_TRUE(source->isMoving(252));
  EXPECT_TRUE(source->isMoving(259));
  EXPECT_FALSE(source->isMoving(260));
  EXPECT_TRUE(source->isMoving(0x00070000 | 252));  // instance 7
}

TEST_F(SemanticKitti, TakesStampsFromTimesAndSelectsByThem) {
  writeFile(folder_ / "times.txt", "0.000000e+00\n5.000000e-01\n2.000000e+00\n");
  auto scans = readAll(*open());
  ASSERT_EQ(scans.size(), 3U);
  EXPECT_EQ(scans[1].stamp_ns, 1'500'000'000U);
  options_.start_s = 0.4;
  options_.duration_s = 1.0;
  scans = readAll(*open());
  ASSERT_EQ(scans.size(), 1U);
  EXPECT_EQ(scans[0].stamp_ns, 1'500'000'000U);
  options_ = SourceOptions();
  options_.stride = 2;
  EXPECT_EQ(readAll(*open()).size(), 2U);
}

TEST_F(SemanticKitti, TakesThePoseOfTheFileNumber) {
  fs::remove(path("velodyne", 0, ".bin"));
  const auto scans = readAll(*open());
  ASSERT_EQ(scans.size(), 2U);
  EXPECT_NEAR(scans[0].T_map_cloud.translation().x(), 2.0, 1e-9);
}

TEST_F(SemanticKitti, CountsUnusableScansByReason) {
  writeLabels();
  writeFile(path("velodyne", 0, ".bin"), "fifteen bytes..");
  writeFile(path("labels", 1, ".label"), bytesOf<std::uint32_t>({1}));
  fs::remove(path("labels", 2, ".label"));
  writeFile(path("velodyne", 3, ".bin"), bytesOf<float>({1, 1, 2, 0.5F}));
  writeFile(path("velodyne", 4, ".bin"), "");
  writeFile(folder_ / "poses.txt",
            std::string(kPoses) + "\n");  // an empty line is no pose: none for scans 3 and 4
  const auto source = open();
  EXPECT_TRUE(readAll(*source).empty());
  EXPECT_EQ(source->skipped().at("unreadable velodyne file").count, 1U);
  EXPECT_EQ(source->skipped().at("labels missing or not one a point").count, 2U);
  EXPECT_EQ(source->skipped().at("no pose in poses.txt").count, 2U);
}

TEST_F(SemanticKitti, NamesTheFileThatIsMissing) {
  fs::remove(folder_ / "poses.txt");
  EXPECT_NE(openError().find("poses.txt: missing"), std::string::npos) << openError();
  fs::remove(folder_ / "calib.txt");
  EXPECT_NE(openError().find("calib.txt: missing"), std::string::npos) << openError();
}

TEST_F(SemanticKitti, NamesTheLineThatIsNotAPose) {
  writeFile(folder_ / "poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 2 3\n");
  EXPECT_NE(openError().find("line 2"), std::string::npos) << openError();
  writeFile(folder_ / "poses.txt", "0 0 0 0 0 0 0 0 0 0 0 0\n");
  EXPECT_NE(openError().find("line 1"), std::string::npos) << openError();
  writeFile(folder_ / "calib.txt", "P0: 1 2 3\n");
  EXPECT_NE(openError().find("`Tr:`"), std::string::npos) << openError();
}

}  // namespace
}  // namespace test
}  // namespace beautymap
