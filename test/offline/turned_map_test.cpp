// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
// A map is cleaned alike, whichever way is up in its frame.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "beautymap/io/cloud_fields.h"
#include "beautymap/io/pcd_stream.h"
#include "beautymap/io/scan_conversion.h"
#include "beautymap/offline/offline_cleaner.h"
#include "beautymap/simulation/simulated_source.h"
#include "offline/offline_test_helpers.h"

namespace beautymap {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A drive in a map frame of which z is up; each point has an id.
const std::vector<SourceScan>& drive() {
  static const std::vector<SourceScan> kDrive = [] {
    simulation::SimulationOptions options;
    options.scans = 15;
    simulation::SimulatedSource source(options);
    std::vector<SourceScan> drive;
    SourceScan read;
    std::uint32_t first_id = 0;
    while (source.next(read)) {
      Scan scan;
      convertScan(read, scan);
      drive.push_back(test::sourceScan(scan, first_id));
      drive.back().T_map_sensor = read.T_map_sensor;
      first_id += read.cloud.width;
    }
    return drive;
  }();
  return kDrive;
}

struct Result {
  OfflineReport report;
  std::vector<bool> removed;  ///< by id
  Vector3d first;             ///< of the cleaned points [m]
};

Result clean(const Matrix3d& turn, const std::string& up = "auto") {
  std::vector<SourceScan> scans = drive();
  Eigen::Isometry3d T_map_level = Eigen::Isometry3d::Identity();
  T_map_level.linear() = turn;
  std::size_t points = 0;
  for (SourceScan& scan : scans) {
    scan.T_map_cloud = T_map_level * scan.T_map_cloud;
    scan.T_map_sensor = T_map_level * scan.T_map_sensor;
    points += scan.cloud.width;
  }
  test::MemorySource source(scans);
  const test::OutputFolder folder;
  OfflineOptions options;
  options.output = folder.path();
  Config config;
  config.map.up = up;
  Result result;
  result.report =
      cleanOffline(source, config, options, {[](const std::string&, std::size_t) {}, [] {}});
  result.removed.resize(points);
  const pcl::PCLPointCloud2 dynamic = readPcd(folder.file("dynamic.pcd"));
  const FieldReader id(dynamic, "id");
  for (std::size_t i = 0; i < dynamic.width; ++i) {
    result.removed[static_cast<std::size_t>(id(i))] = true;
  }
  const pcl::PCLPointCloud2 cleaned = readPcd(folder.file("cleaned.pcd"));
  result.first = PositionReader(cleaned)(0);
  return result;
}

const Result& level() {
  static const Result kLevel = clean(Matrix3d::Identity());
  return kLevel;
}

TEST(TurnedMap, ALevelOneIsNotTurned) {
  EXPECT_EQ(level().report.up.up, Vector3d::UnitZ());
  EXPECT_GT(level().report.dynamic_points, 1000U);
  EXPECT_EQ(clean(Matrix3d::Identity(), "z").removed, level().removed);
}

TEST(TurnedMap, UpsideDownOrWithYUpTheSamePointsGo) {
  Matrix3d loam;  // x left, y up, z forward
  loam << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  const Matrix3d upside_down = Vector3d(1, -1, -1).asDiagonal();
  for (const Matrix3d& turn : {upside_down, loam}) {
    const Result turned = clean(turn);
    EXPECT_EQ(turned.removed, level().removed);
    EXPECT_EQ(turned.report.up.up, turn.col(2));
    // What is written stays where the user's frame has it.
    EXPECT_TRUE(turned.first.isApprox(turn * level().first, 1e-6));
  }
}

std::size_t differing(const Result& turned) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < turned.removed.size(); ++i) {
    count += turned.removed[i] != level().removed[i] ? 1 : 0;
  }
  return count;
}

Matrix3d turnedAbout(const Vector3d& axis, double degrees) {
  return Eigen::AngleAxisd(degrees * M_PI / 180.0, axis.normalized()).matrix();
}

TEST(TurnedMap, TiltedNearlyTheSamePointsGo) {
  // The borders of the cells lie elsewhere, as they do when the map's x axis points elsewhere.
  const auto by_borders =
      static_cast<double>(differing(clean(turnedAbout(Vector3d::UnitZ(), 5.0))));
  for (const double degrees : {20.0, 37.0}) {
    const Matrix3d tilt = turnedAbout({1, 2, 0.3}, degrees);
    const Result turned = clean(tilt);
    const auto count = static_cast<double>(differing(turned));
    EXPECT_LT(count, 0.005 * static_cast<double>(turned.removed.size())) << degrees;
    EXPECT_LT(count, 1.5 * by_borders) << degrees;
    EXPECT_TRUE(turned.first.isApprox(tilt * level().first, 1e-6));
  }
}

TEST(TurnedMap, JudgedAsIfItWereLevelItWouldBeAnotherMap) {
  const Matrix3d upside_down = Vector3d(1, -1, -1).asDiagonal();
  EXPECT_NE(clean(upside_down, "z").removed, level().removed);
}

}  // namespace
}  // namespace beautymap
