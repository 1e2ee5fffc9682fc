// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/matrix/up_direction.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "test_scenes.h"

namespace beautymap {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Basis = UpDirection::Basis;

/// A place with up as z, and where the sensor is in it.
struct Place {
  std::vector<Vector3d> points;
  Vector3d sensor{0.1, 0.2, 1.6};

  /// A rectangle.
  void add(const Vector3d& corner, const Vector3d& u, const Vector3d& v) {
    constexpr double kApart = 0.2;  // [m] between points
    for (double a = 0.0; a <= u.norm(); a += kApart) {
      for (double b = 0.0; b <= v.norm(); b += kApart) {
        points.emplace_back(corner + a * u.normalized() + b * v.normalized());
      }
    }
  }
};

/// A road between houses.
Place street() {
  Place place;
  place.add({-25, -6, 0}, {50, 0, 0}, {0, 12, 0});
  for (const double y : {-6.0, 6.0}) place.add({-25, y, 0}, {50, 0, 0}, {0, 0, 8});
  return place;
}

/// Each wall is larger than the floor.
Place corridor() {
  Place place;
  place.add({-20, -1, 0}, {40, 0, 0}, {0, 2, 0});
  for (const double y : {-1.0, 1.0}) place.add({-20, y, 0}, {40, 0, 0}, {0, 0, 3});
  return place;
}

Place room() {
  Place place;
  place.add({-5, -4, 0}, {10, 0, 0}, {0, 8, 0});
  place.add({-5, -4, 2.8}, {10, 0, 0}, {0, 8, 0});
  for (const double x : {-5.0, 5.0}) place.add({x, -4, 0}, {0, 8, 0}, {0, 0, 2.8});
  for (const double y : {-4.0, 4.0}) place.add({-5, y, 0}, {10, 0, 0}, {0, 0, 2.8});
  return place;
}

Place hillside(double slope_deg) {
  const Matrix3d turn = AngleAxisd(slope_deg * M_PI / 180.0, Vector3d::UnitX()).matrix();
  Place place = street();
  for (Vector3d& point : place.points) point = turn * point;
  return place;
}

/// @param R_map_place  the map frame is turned so
/// @param sensor_z     axis of the sensor in the place
UpDirection upOf(const Place& place, const Matrix3d& R_map_place = Matrix3d::Identity(),
                 const Vector3d& sensor_z = Vector3d::UnitZ(), int scans = 1,
                 const Config& config = Config()) {
  std::vector<Vector3d> in_map;
  for (const Vector3d& point : place.points) in_map.emplace_back(R_map_place * point);
  UpFinder finder;
  for (int i = 0; i < scans; ++i) {
    finder.add(test::registeredScan(in_map, R_map_place * place.sensor), R_map_place * sensor_z);
  }
  return finder.find(config);
}

Matrix3d turnedBy(double degrees) {
  return AngleAxisd(degrees * M_PI / 180.0, Vector3d(1, 2, 0.3).normalized()).matrix();
}

TEST(UpDirection, IsExactlyZInLevelMaps) {
  const std::vector<Place> places{street(), corridor(), room(), hillside(12.0)};
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (const int scans : {1, 10}) {
      const UpDirection up = upOf(places[i], Matrix3d::Identity(), Vector3d::UnitZ(), scans);
      EXPECT_EQ(up.up, Vector3d::UnitZ()) << "place " << i;
      EXPECT_EQ(up.basis, Basis::kFound) << "place " << i;
      EXPECT_EQ(up.levelFromMap().matrix(), Eigen::Matrix4d::Identity());
    }
  }
}

TEST(UpDirection, IsTheExactAxisInMapsWithAnotherOne) {
  Matrix3d from_loam;  // x left, y up, z forward
  from_loam << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  const Matrix3d upside_down = Vector3d(1, -1, -1).asDiagonal();
  for (const Place& place : {street(), corridor()}) {
    const UpDirection loam = upOf(place, from_loam.transpose());
    EXPECT_EQ(loam.up, Vector3d::UnitY());
    EXPECT_EQ(loam.levelFromMap().linear(), from_loam);
    const UpDirection down = upOf(place, upside_down);
    EXPECT_EQ(down.up, -Vector3d::UnitZ());
    EXPECT_EQ(down.levelFromMap().linear(), upside_down);
  }
}

TEST(UpDirection, IsTheGroundsNormalInTiltedMaps) {
  for (const double tilt : {20.0, 37.0, 50.0}) {
    const UpDirection up = upOf(street(), turnedBy(tilt));
    EXPECT_GT(up.up.dot(turnedBy(tilt).col(2)), std::cos(0.5 * M_PI / 180.0)) << tilt;
    EXPECT_TRUE((up.levelFromMap() * up.up).isApprox(Vector3d::UnitZ(), 1e-12));
    EXPECT_EQ(up.basis, Basis::kFound);
  }
}

TEST(UpDirection, DoesNotNeedAnUprightSensor) {
  for (const Vector3d& sensor_z : {Vector3d(0, 1, 0), Vector3d(1, 0, 0), Vector3d(0, 0, -1)}) {
    EXPECT_EQ(upOf(street(), Matrix3d::Identity(), sensor_z).up, Vector3d::UnitZ());
    EXPECT_EQ(upOf(corridor(), Matrix3d::Identity(), sensor_z).up, Vector3d::UnitZ());
  }
}

TEST(UpDirection, DoesNotNeedAPoseOfTheSensor) {
  const Matrix3d turn = turnedBy(37.0);
  const Vector3d map_z_in_place = turn.transpose() * Vector3d::UnitZ();
  EXPECT_GT(upOf(street(), turn, map_z_in_place).up.dot(turn.col(2)), 0.9999);
}

TEST(UpDirection, ARoomThatTheMapAndTheSensorSeeOtherwiseIsInDoubt) {
  const Matrix3d upside_down = Vector3d(1, -1, -1).asDiagonal();
  EXPECT_EQ(upOf(room(), upside_down).basis, Basis::kDoubtful);
  EXPECT_NE(upOf(room(), upside_down).describe().find("set map.up"), std::string::npos);
}

TEST(UpDirection, WithoutGroundItIsZAndTheParameterIsNamed) {
  std::vector<Scan> scans(2);
  for (int i = 0; i < 1000; ++i) {
    scans[0].cloud.emplace_back(test::kNan, 1.0F, 2.0F);
    scans[0].cloud.emplace_back(0.0F, 0.0F, 0.0F);
    scans[0].cloud.emplace_back(1e30F, 0.0F, 0.0F);
    scans[0].cloud.emplace_back(test::kInfinity, 0.0F, 0.0F);
  }
  scans.push_back(scans[0]);
  scans[2].T_map_cloud.translation().x() = test::kNan;
  UpFinder finder;
  for (int i = 0; i <= 3; ++i) {
    const UpDirection up = finder.find(Config());
    EXPECT_EQ(up.up, Vector3d::UnitZ());
    EXPECT_EQ(up.basis, Basis::kAssumed);
    EXPECT_NE(up.describe().find("set map.up"), std::string::npos);
    if (i < 3) finder.add(scans[static_cast<std::size_t>(i)], Vector3d::UnitZ());
  }
}

TEST(UpDirection, IsWhatTheConfigurationSays) {
  Config config;
  for (const char* up : {"z", "-z", "y", "-y", "x", "-x"}) {
    config.map.up = up;
    const UpDirection told = upOf(street(), Matrix3d::Identity(), Vector3d::UnitZ(), 1, config);
    EXPECT_EQ(told.basis, Basis::kTold);
    EXPECT_EQ(told.describe(), "up is " + config.map.up + " of the map frame, as map.up says");
    const Matrix3d turn = told.levelFromMap().linear();
    EXPECT_EQ(turn * told.up, Vector3d::UnitZ()) << up;
    EXPECT_EQ(turn.transpose() * turn, Matrix3d::Identity()) << up;
    EXPECT_EQ(turn.determinant(), 1.0) << up;
  }
}

TEST(UpDirection, IsTheSameFarFromTheMapsOrigin) {
  Place place = street();
  const Vector3d far(500000.0, 4000000.0, 300.0);
  Scan scan = test::registeredScan(place.points, place.sensor + far);
  scan.T_map_cloud.translation() = far;
  UpFinder finder;
  finder.add(scan, Vector3d::UnitX());
  EXPECT_EQ(finder.find(Config()).up, Vector3d::UnitZ());
}

TEST(UpDirection, TurnsWhereAScanWasTaken) {
  const Matrix3d turn = turnedBy(37.0);
  Scan scan = test::registeredScan({{1, 2, 3}}, {4, 5, 6});
  scan.T_map_cloud.linear() = turn;
  const UpDirection up = upOf(street(), turn);
  const Scan before = scan;
  up.level(scan);
  EXPECT_TRUE(scan.T_map_cloud.isApprox(up.levelFromMap() * before.T_map_cloud));
  EXPECT_TRUE(scan.sensor_in_map.isApprox(up.levelFromMap() * before.sensor_in_map));
}

}  // namespace
}  // namespace beautymap
