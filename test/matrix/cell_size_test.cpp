// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/matrix/cell_size.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace beautymap {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// Points at the same range all around.
void addRing(Scan& scan, float range, int points) {
  for (int i = 0; i < points; ++i) {
    const float angle = 6.28F * static_cast<float>(i) / static_cast<float>(points);
    scan.cloud.emplace_back(range * std::cos(angle), range * std::sin(angle), 0.0F);
  }
}

Scan scanOf(int near, int far) {
  Scan scan;
  addRing(scan, 5.0F, near);
  addRing(scan, 20.0F, far);
  return scan;
}

TEST(CellSize, IsSmallInARoomOnly) {
  const Config config;
  EXPECT_EQ(cellSizeFor(scanOf(1000, 0), config), config.matrix.room_res_g);
  EXPECT_EQ(cellSizeFor(scanOf(900, 100), config), config.matrix.room_res_g);
  EXPECT_EQ(cellSizeFor(scanOf(899, 101), config), config.matrix.res_g);
  EXPECT_EQ(cellSizeFor(scanOf(0, 1000), config), config.matrix.res_g);
}

TEST(CellSize, IsNeverLargerInARoom) {
  Config config;
  config.matrix.res_g = 0.1;
  EXPECT_EQ(cellSizeFor(scanOf(1000, 0), config), 0.1);
  config.matrix.res_g = 0.5;
  config.matrix.room_res_g = 0.0;
  EXPECT_EQ(cellSizeFor(scanOf(1000, 0), config), 0.5);
}

TEST(CellSize, DoesNotDependOnThePose) {
  const Config config;
  Scan scan = scanOf(1000, 10);
  scan.T_map_cloud = Eigen::Translation3d(5e5, 4e6, 100.0) *
                     Eigen::AngleAxisd(1.0, Eigen::Vector3d(1, 2, 3).normalized());
  scan.sensor_in_map = scan.T_map_cloud.translation();
  EXPECT_EQ(cellSizeFor(scan, config), config.matrix.room_res_g);
  scan.sensor_in_map.x() += 50.0;  // the cloud's origin is not where the beams started
  EXPECT_EQ(cellSizeFor(scan, config), config.matrix.res_g);
}

TEST(CellSize, UnusablePointsSayNothing) {
  const Config config;
  EXPECT_FALSE(cellSizeFor(Scan(), config));
  EXPECT_FALSE(cellSizeFor(scanOf(50, 49), config));
  Scan scan;
  for (int i = 0; i < 1000; ++i) {
    scan.cloud.emplace_back(0.0F, 0.0F, 0.0F);
    scan.cloud.emplace_back(kNan, 1.0F, 1.0F);
    scan.cloud.emplace_back(1e9F, 1.0F, 1.0F);
  }
  EXPECT_FALSE(cellSizeFor(scan, config));
  addRing(scan, 20.0F, 200);
  EXPECT_EQ(cellSizeFor(scan, config), config.matrix.res_g);
  scan.sensor_in_map.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(cellSizeFor(scan, config));
}

}  // namespace
}  // namespace beautymap
