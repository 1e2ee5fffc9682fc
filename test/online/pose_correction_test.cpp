// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/online/pose_correction.h"

#include <gtest/gtest.h>

#include "beautymap/online/scan_log.h"
#include "io/io_test_helpers.h"

namespace beautymap {
namespace {

using test::poseAt;

StampedPoses drive() {
  StampedPoses used;
  for (std::uint64_t i = 0; i < 5; ++i) {
    used[100 * i] = poseAt(static_cast<double>(i), 0, 0, 0.1 * static_cast<double>(i));
  }
  return used;
}

TEST(PoseCorrection, BringsScansToTheirCorrectedPoses) {
  const StampedPoses used = drive();
  const StampedPoses corrected{{100, poseAt(1.5, 1, 0, 0.2)}, {305, poseAt(3, 4, 1, 0.7)}};
  const PoseCorrection correction(used, corrected, 10);
  EXPECT_EQ(correction.matched(), 2U);
  EXPECT_TRUE((correction.at(100) * used.at(100)).isApprox(corrected.at(100)));
  EXPECT_TRUE((correction.at(300) * used.at(300)).isApprox(corrected.at(305)));
  EXPECT_TRUE(correction.at(0).isApprox(correction.at(100))) << "before the first";
  EXPECT_TRUE(correction.at(400).isApprox(correction.at(300))) << "after the last";
  const Eigen::Vector3d middle = correction.at(200).translation();
  EXPECT_TRUE(
      middle.isApprox(0.5 * (correction.at(100).translation() + correction.at(300).translation())));
  EXPECT_NEAR(correction.largestMove(), std::hypot(4.0, 1.0), 1e-9);
  EXPECT_NEAR(correction.largestTurn(), 0.4, 1e-9);
}

TEST(PoseCorrection, PosesOfOtherTimesChangeNothing) {
  const PoseCorrection correction(drive(), {{150, poseAt(9, 9, 9)}, {9000, poseAt(1, 1, 1)}}, 10);
  EXPECT_EQ(correction.matched(), 0U);
  EXPECT_TRUE(correction.at(200).isApprox(Eigen::Isometry3d::Identity()));
  EXPECT_EQ(PoseCorrection({}, {{1, poseAt(1, 1, 1)}}, 10).matched(), 0U);
}

TEST(ScanLog, GivesTheScansBackAtTheirCorrectedPosesWhileItGrows) {
  const test::TempFolder folder;
  ScanLog log(folder.path().string());
  const auto scanAt = [](std::uint64_t stamp_ns, double x) {
    SourceScan scan;
    scan.cloud = test::makeCloud({{static_cast<float>(x), 2.0F, 3.0F}});
    scan.stamp_ns = stamp_ns;
    scan.T_map_cloud = scan.T_map_sensor = poseAt(x, 0, 0);
    return scan;
  };
  log.append(scanAt(1000, 1.0));
  log.append(scanAt(2000, 2.0));
  log.correct(PoseCorrection(log.poses(), {{2000, poseAt(2.0, 5.0, 0.0)}}, 1));
  log.rewind();
  SourceScan scan;
  ASSERT_TRUE(log.next(scan));
  EXPECT_TRUE(scan.T_map_cloud.isApprox(poseAt(1.0, 5.0, 0.0)));
  log.append(scanAt(3000, 3.0));  // comes with a pose that is corrected already
  ASSERT_TRUE(log.next(scan));
  EXPECT_TRUE(scan.T_map_sensor.isApprox(poseAt(2.0, 5.0, 0.0)));
  EXPECT_EQ(test::pointAt(scan.cloud, 0), Eigen::Vector3d(2, 2, 3));
  ASSERT_TRUE(log.next(scan));
  EXPECT_TRUE(scan.T_map_cloud.isApprox(poseAt(3.0, 0.0, 0.0)));
  EXPECT_FALSE(log.next(scan));
  EXPECT_TRUE(log.poses().at(1000).isApprox(poseAt(1.0, 5.0, 0.0)));
  SourceScan other = scanAt(4000, 1.0);
  other.cloud.fields.pop_back();
  EXPECT_FALSE(log.append(other));
  EXPECT_EQ(log.size(), 3U);
}

}  // namespace
}  // namespace beautymap
