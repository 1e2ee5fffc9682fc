// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/matrix/scan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "test_scenes.h"

namespace beautymap {
namespace {

using test::kInfinity;
using test::kNan;
using test::Random;

/// Where a point lies relative to the anchor's corner, in double.
Eigen::Vector3d movedInDouble(const Scan& scan, std::size_t point, ColumnIndex anchor, double res_g,
                              double z_origin) {
  return scan.T_map_cloud * scan.cloud[point].getVector3fMap().cast<double>() -
         Eigen::Vector3d(anchor.x * res_g, anchor.y * res_g, z_origin);
}

Scan randomScan(Random& random, const Eigen::Vector3d& sensor) {
  Scan scan;
  const Eigen::Vector3d axis(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  scan.T_map_cloud = Eigen::AngleAxisd(random.uniform(-3, 3), axis.normalized());
  scan.T_map_cloud.pretranslate(sensor);
  scan.sensor_in_map =
      sensor + Eigen::Vector3d(0.3, -0.2, 0.1);  // the cloud's frame is not the sensor's
  for (int i = 0; i < 200; ++i) {
    scan.cloud.push_back(pcl::PointXYZ(static_cast<float>(random.uniform(-80, 80)),
                                       static_cast<float>(random.uniform(-80, 80)),
                                       static_cast<float>(random.uniform(-5, 20))));
  }
  return scan;
}

TEST(Scan, AColumnIsTheFloorOfThePosition) {
  EXPECT_EQ(columnOf({0.0, 0.0, 9.0}, 0.5), (ColumnIndex{0, 0}));
  EXPECT_EQ(columnOf({-0.1, 0.49, 0.0}, 0.5), (ColumnIndex{-1, 0}));
  EXPECT_EQ(columnOf({-0.5, -0.51, 0.0}, 0.5), (ColumnIndex{-1, -2}));
  EXPECT_EQ(columnOf({500000.25, -5800000.25, 0.0}, 0.5), (ColumnIndex{1000000, -11600001}));
}

TEST(Scan, PointsKeepTheirMillimetresAnywhereInTheWorld) {
  const std::vector<Eigen::Vector3d> places{{0.0, 0.0, 0.0},
                                            {-3.7, 12.1, 1.7},
                                            {500000.3, 5800000.7, 432.1},
                                            {-500000.3, -5800000.7, -50}};
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    for (const Eigen::Vector3d& place : places) {
      Random random(seed);
      const Scan scan = randomScan(random, place);
      const double res_g = random.uniform(0.1, 2.0);
      const double z_origin = place.z() + random.uniform(-5.0, 5.0);
      DroppedPoints dropped;
      const PlacedScan placed = placeScan(scan, z_origin, res_g, ScanConfig(), dropped);
      ASSERT_EQ(placed.size(), scan.cloud.size());
      EXPECT_EQ(placed.anchor, columnOf(scan.sensor_in_map, res_g));
      for (std::size_t i = 0; i < placed.size(); ++i) {
        const Eigen::Vector3d expected =
            movedInDouble(scan, placed.sourceOf(i), placed.anchor, res_g, z_origin);
        // Some ten roundings of numbers of up to 120 m in float, 4e-6 m each.
        ASSERT_LT((placed.point(i).cast<double>() - expected).norm(), 1e-4);
      }
    }
  }
}

TEST(Scan, TheSensorLiesInTheAnchorColumn) {
  for (std::uint32_t seed = 0; seed < 500; ++seed) {
    Random random(seed);
    const double res_g = random.uniform(0.05, 10.0);
    Scan scan;
    scan.sensor_in_map = {random.uniform(-6e6, 6e6), random.uniform(-10, 10),
                          random.uniform(-9, 9)};
    DroppedPoints dropped;
    const PlacedScan placed = placeScan(scan, 0.0, res_g, ScanConfig(), dropped);
    for (int axis = 0; axis < 2; ++axis) {
      // Coordinates of 6e6 m have 1e-9 m in double, and 10 m have 1e-6 m in float.
      EXPECT_GE(placed.sensor[axis], -1e-5);
      EXPECT_LE(placed.sensor[axis], res_g + 1e-5);
    }
  }
}

TEST(Scan, ARegisteredCloudWithLargeCoordinatesLosesNothingMore) {
  // 500000.03125 and 5800000.5 are exact in float.
  const Scan scan =
      test::registeredScan({{500000.03125, 5800000.5, 2.0}}, {500000.25, 5800001.0, 1.0});
  DroppedPoints dropped;
  const PlacedScan placed = placeScan(scan, 1.0, 0.5, ScanConfig(), dropped);
  ASSERT_EQ(placed.size(), 1U);
  EXPECT_EQ(placed.anchor, (ColumnIndex{1000000, 11600002}));
  EXPECT_EQ(placed.point(0), Eigen::Vector3f(0.03125F, -0.5F, 1.0F));
}

TEST(Scan, UnusablePointsAreDroppedAndCountedByReason) {
  ScanConfig config;
  config.min_range = 2.0;
  config.max_range = 50.0;
  Scan scan;
  scan.T_map_cloud.translation() = scan.sensor_in_map = Eigen::Vector3d(10.0, -20.0, 3.0);
  const std::vector<pcl::PointXYZ> points{
      {3.0F, 0.0F, 0.0F},       {kNan, 1.0F, 1.0F}, {1.0F, kNan, 1.0F},  {1.0F, 1.0F, kInfinity},
      {-kInfinity, 0.0F, 0.0F}, {0.0F, 0.0F, 0.0F}, {1.0F, 1.0F, 1.0F},  {0.0F, 49.0F, 20.0F},
      {3e38F, -3e38F, 3e38F},   {0.0F, 2.0F, 0.0F}, {0.0F, 50.0F, 0.0F}, {-0.0F, 0.0F, -0.0F},
      {0.0F, -30.0F, 4.0F}};
  for (const pcl::PointXYZ& p : points) scan.cloud.push_back(p);
  DroppedPoints dropped;
  const PlacedScan placed = placeScan(scan, 0.0, 1.0, config, dropped);
  EXPECT_EQ(dropped.non_finite, 4U);
  EXPECT_EQ(dropped.zero, 2U);
  EXPECT_EQ(dropped.too_near, 1U);
  EXPECT_EQ(dropped.too_far, 2U);
  EXPECT_EQ(dropped.total() + placed.size(), points.size());
  EXPECT_EQ(placed.source_index, (std::vector<std::uint32_t>{0, 9, 10, 12}));
}

TEST(Scan, LargeCloudsKeepTheirUsablePointsInOrder) {
  for (const double unusable : {0.0, 0.001, 0.3, 1.0}) {
    Random random(7);
    Scan scan;
    std::vector<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < 3000; ++i) {
      if (random.chance(unusable)) {
        scan.cloud.push_back(random.chance(0.5) ? pcl::PointXYZ(kNan, 0.0F, 1.0F)
                                                : pcl::PointXYZ(0.0F, 0.0F, 0.0F));
      } else {
        scan.cloud.push_back(pcl::PointXYZ(static_cast<float>(i + 1), 2.0F, -1.0F));
        expected.push_back(i);
      }
    }
    ScanConfig config;
    config.max_range = 1e4;
    DroppedPoints dropped;
    const PlacedScan placed = placeScan(scan, 0.0, 1.0, config, dropped);
    ASSERT_EQ(placed.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(placed.sourceOf(i), expected[i]);
    EXPECT_EQ(placed.cloud_size, scan.cloud.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      ASSERT_EQ(placed.point(i), Eigen::Vector3f(static_cast<float>(expected[i] + 1), 2.0F, -1.0F));
    }
    EXPECT_EQ(dropped.total(), scan.cloud.size() - expected.size());
  }
}

TEST(Scan, RunsAreTheConsecutivePointsOfAColumn) {
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    Random random(seed);
    PlacedScan placed;
    const double res_g = random.pick<double>({0.25, 0.5, 2.0});
    const double step = random.pick<double>({0.01, 0.2, 3.0});
    double x = 0.0, y = 0.0;
    for (int i = random.integer(0, 2000); i > 0; --i) {
      x += random.uniform(-step, step);
      y += random.uniform(-step, step);
      placed.x.push_back(static_cast<float>(x));
      placed.y.push_back(static_cast<float>(y));
      placed.z.push_back(static_cast<float>(random.uniform(-1.0, 1.0)));
    }
    placed.runs = {{1, 2, 3, 4, 5.0F, 6.0F}};  // of a scan before
    findRuns(placed, res_g);
    std::uint32_t next = 0;
    for (const ColumnRun& run : placed.runs) {
      ASSERT_EQ(run.begin, next);
      ASSERT_LT(run.begin, run.end);
      const auto [lowest, highest] =
          std::minmax_element(placed.z.begin() + run.begin, placed.z.begin() + run.end);
      ASSERT_EQ(run.lowest, *lowest);
      ASSERT_EQ(run.highest, *highest);
      for (std::uint32_t i = run.begin; i < run.end; ++i) {
        ASSERT_EQ(run.x, static_cast<int>(std::floor(placed.x[i] / static_cast<float>(res_g))));
        ASSERT_EQ(run.y, static_cast<int>(std::floor(placed.y[i] / static_cast<float>(res_g))));
      }
      next = run.end;
    }
    EXPECT_EQ(next, placed.size());
    if (step < 0.1) {
      EXPECT_LT(placed.runs.size(), placed.size() / 4 + 8);
    }
  }
}

TEST(Scan, ARegisteredPointAtTheSensorIsNoReturn) {
  const Scan scan = test::registeredScan({{4.0, 5.0, 1.0}, {4.0, 5.0, 0.0}}, {4.0, 5.0, 1.0});
  DroppedPoints dropped;
  EXPECT_EQ(placeScan(scan, 0.0, 1.0, ScanConfig(), dropped).size(), 1U);
  EXPECT_EQ(dropped.zero, 1U);
}

TEST(Scan, HugeValuesAreTooFarInAnyPose) {
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    Random random(seed);
    Scan scan = randomScan(random, {1.0, 2.0, 3.0});
    scan.cloud.clear();
    for (const float huge : {1e4F, 1e10F, 1e19F, 1e25F, 3.4e38F}) {
      scan.cloud.push_back(pcl::PointXYZ(huge, -huge, huge));
      scan.cloud.push_back(pcl::PointXYZ(0.0F, huge, 1.0F));
    }
    DroppedPoints dropped;
    EXPECT_TRUE(placeScan(scan, 0.0, 1.0, ScanConfig(), dropped).size() == 0);
    EXPECT_EQ(dropped.too_far, scan.cloud.size());
  }
}

TEST(Scan, AnEmptyCloudHasNoPoints) {
  DroppedPoints dropped;
  EXPECT_TRUE(placeScan(Scan(), 0.0, 1.0, ScanConfig(), dropped).size() == 0);
  EXPECT_EQ(dropped.total(), 0U);
}

TEST(Scan, PosesThatAreNotFiniteOrTooFarAreRefused) {
  const double nan = kNan, infinity = kInfinity;
  DroppedPoints dropped;
  const auto place = [&](const Scan& scan) { placeScan(scan, 0.0, 1.0, ScanConfig(), dropped); };
  for (const double bad : {nan, infinity, -infinity, 1e10, -1e300}) {
    for (int axis = 0; axis < 3; ++axis) {
      Scan scan;
      scan.cloud.push_back(pcl::PointXYZ(kNan, 0.0F, 0.0F));
      scan.sensor_in_map[axis] = bad;
      EXPECT_THROW(place(scan), std::invalid_argument) << bad;
    }
  }
  for (const double bad : {nan, infinity}) {
    Scan translated, rotated;
    translated.T_map_cloud.translation().y() = bad;
    rotated.T_map_cloud.linear()(1, 2) = bad;
    EXPECT_THROW(place(translated), std::invalid_argument);
    EXPECT_THROW(place(rotated), std::invalid_argument);
  }
  EXPECT_EQ(dropped.total(), 0U) << "a refused scan is not counted";
}

}  // namespace
}  // namespace beautymap
