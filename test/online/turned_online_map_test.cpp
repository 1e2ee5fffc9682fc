// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
// A map is cleaned alike while it grows, whichever way is up in its frame.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "beautymap/io/cloud_fields.h"
#include "beautymap/io/pcd_stream.h"
#include "beautymap/io/scan_conversion.h"
#include "beautymap/online/online_cleaner.h"
#include "beautymap/online/save_points.h"
#include "beautymap/simulation/simulated_source.h"
#include "io/io_test_helpers.h"

namespace beautymap {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using test::TempFolder;

const Matrix3d kUpsideDown = Vector3d(1, -1, -1).asDiagonal();

/// x left, y up, z forward.
Matrix3d loam() {
  Matrix3d turn;
  turn << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  return turn;
}

Matrix3d tilt() {
  return Eigen::AngleAxisd(37.0 * M_PI / 180.0, Vector3d(1, 2, 0.3).normalized()).matrix();
}

/// A drive in a map frame that is turned.
std::vector<SourceScan> drive(const Matrix3d& turn) {
  static const std::vector<SourceScan> kLevel = [] {
    simulation::SimulationOptions options;
    options.sensor = "vlp16";
    options.scans = 20;
    options.seed = 4;
    simulation::SimulatedSource source(options);
    std::vector<SourceScan> all(static_cast<std::size_t>(options.scans));
    for (SourceScan& scan : all) source.next(scan);
    return all;
  }();
  std::vector<SourceScan> scans = kLevel;
  Eigen::Isometry3d T_map_level = Eigen::Isometry3d::Identity();
  T_map_level.linear() = turn;
  for (SourceScan& scan : scans) {
    scan.T_map_cloud = T_map_level * scan.T_map_cloud;
    scan.T_map_sensor = T_map_level * scan.T_map_sensor;
  }
  return scans;
}

Config everyPoint() {
  Config config;
  config.online.map_voxel = 0.0;
  return config;
}

/// @return the class of each point when its scan came
std::vector<PointClass> add(OnlineCleaner& cleaner, const std::vector<SourceScan>& scans,
                            std::size_t begin = 0, std::size_t end = 20) {
  std::vector<PointClass> classes;
  for (std::size_t i = begin; i < end; ++i) {
    const std::vector<PointClass>& of_scan = cleaner.add(scans[i]);
    classes.insert(classes.end(), of_scan.begin(), of_scan.end());
    cleaner.finish(scans[i]);
  }
  return classes;
}

/// The points of a file, turned, in an order of their own.
std::vector<std::vector<float>> pointsOf(const std::string& path, const Matrix3d& turn) {
  const pcl::PCLPointCloud2 cloud = readPcd(path);
  const PositionReader position(cloud);
  std::vector<std::vector<float>> points;
  for (std::size_t i = 0; i < cloud.width; ++i) {
    const Eigen::Vector3f p = (turn * position(i)).cast<float>();
    points.push_back({p.x(), p.y(), p.z()});
  }
  std::sort(points.begin(), points.end());
  return points;
}

/// The removed points as they are saved, turned.
std::vector<std::vector<float>> removed(const OnlineCleaner& cleaner,
                                        const Matrix3d& turn = Matrix3d::Identity()) {
  const TempFolder folder;
  savePoints(cleaner, folder / "a.pcd", folder / "b.pcd", 0.0);
  return pointsOf(folder / "b.pcd", turn);
}

double shareOfOthers(const std::vector<PointClass>& a, const std::vector<PointClass>& b) {
  double others = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) others += a[i] != b[i] ? 1.0 : 0.0;
  return others / static_cast<double>(a.size());
}

TEST(TurnedOnlineMap, UpsideDownOrWithYUpTheSamePointsGoAndStayInTheMapFrame) {
  OnlineCleaner level(everyPoint(), "");
  EXPECT_FALSE(level.up());
  const std::vector<PointClass> classes = add(level, drive(Matrix3d::Identity()));
  EXPECT_TRUE(level.up()->isZ());
  EXPECT_GT(removed(level).size(), 100U);
  for (const Matrix3d& turn : {kUpsideDown, loam()}) {
    OnlineCleaner turned(everyPoint(), "");
    EXPECT_EQ(add(turned, drive(turn)), classes);
    EXPECT_EQ(turned.up()->up, turn.col(2));
    EXPECT_EQ(removed(turned, turn.transpose()), removed(level));
  }
}

TEST(TurnedOnlineMap, TiltedNearlyTheSamePointsGo) {
  OnlineCleaner level(everyPoint(), ""), tilted(everyPoint(), "");
  const std::vector<PointClass> classes = add(level, drive(Matrix3d::Identity()));
  // The borders of the cells lie elsewhere, as they do when the map's x axis points elsewhere: of
  // the first scans much is unknown, and in the balance.
  OnlineCleaner yawed(everyPoint(), "");
  const Matrix3d yaw = Eigen::AngleAxisd(5.0 * M_PI / 180.0, Vector3d::UnitZ()).matrix();
  const double by_borders = shareOfOthers(add(yawed, drive(yaw)), classes);
  EXPECT_LT(shareOfOthers(add(tilted, drive(tilt())), classes), 1.5 * by_borders);
}

TEST(TurnedOnlineMap, ItsMatrixStandsUpright) {
  OnlineCleaner level(Config(), ""), turned(Config(), "");
  add(level, drive(Matrix3d::Identity()));
  add(turned, drive(loam()));
  const OnlineCleaner::MatrixView expected = level.matrixAround(20.0);
  const OnlineCleaner::MatrixView view = turned.matrixAround(20.0);
  EXPECT_EQ(expected.T_map_level.matrix(), Eigen::Matrix4d::Identity());
  EXPECT_EQ(view.T_map_level.linear(), loam());
  EXPECT_EQ(view.occupied.window().corner, expected.occupied.window().corner);
  for (int y = 0; y < view.occupied.window().size; ++y) {
    for (int x = 0; x < view.occupied.window().size; ++x) {
      EXPECT_EQ(view.occupied.at(x, y), expected.occupied.at(x, y));
    }
  }
}

TEST(TurnedOnlineMap, ASessionAndTilesOnDiskGoOn) {
  const std::vector<SourceScan> scans = drive(tilt());
  OnlineCleaner whole(everyPoint(), "");
  add(whole, scans);
  const TempFolder folder;
  Config config = everyPoint();
  config.online.radius = 25.0;
  config.scan.max_range = 25.0;
  OnlineCleaner near(config, folder / "tiles");
  config.online.radius = 0.0;
  OnlineCleaner unbounded(config, "");
  EXPECT_EQ(add(near, scans), add(unbounded, scans));
  EXPECT_EQ(removed(near), removed(unbounded));

  OnlineCleaner first(everyPoint(), ""), second(everyPoint(), "");
  add(first, scans, 0, 10);
  first.saveSession(folder / "half.session", "map");
  second.loadSession(folder / "half.session");
  EXPECT_EQ(second.up()->up, first.up()->up);
  add(second, scans, 10);
  EXPECT_EQ(removed(second), removed(whole));
  Config told = everyPoint();
  told.map.up = "z";
  OnlineCleaner other(told, "");
  EXPECT_THROW(other.loadSession(folder / "half.session"), InputError);
}

}  // namespace
}  // namespace beautymap
