// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/simulation/scanner.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <stdexcept>
#include <string>

namespace beautymap::simulation {
namespace {

using Eigen::Vector3d;

/// An empty room, 14 x 10 x 6 m, the sensor in its middle.
World room() {
  Shapes walls{
      makeBlock({-8, -6, -4}, {8, -5, 4}, kPlaster), makeBlock({-8, 5, -4}, {8, 6, 4}, kPlaster),
      makeBlock({-8, -6, -4}, {-7, 6, 4}, kPlaster), makeBlock({7, -6, -4}, {8, 6, 4}, kPlaster),
      makeBlock({-8, -6, 3}, {8, 6, 4}, kPlaster),
  };
  return {walls, Ground(Profile({{0.0, -3.0}}), Profile(), {}, kConcrete)};
}

class SensorTest : public testing::TestWithParam<std::string> {
 protected:
  SensorModel sensor_ = makeSensor(GetParam());
  ScanRequest request_{sensor_, Eigen::Isometry3d::Identity(), 42, 0, 1};
};

TEST_P(SensorTest, RangeNoiseHasTheStatedDeviation) {
  const World world = room();
  double sum = 0.0;
  double squares = 0.0;
  const std::vector<Return> points = takeScan(world, request_);
  for (const Return& point : points) {
    const Vector3d position = point.position.cast<double>();
    const auto hit = world.cast(Ray(Vector3d::Zero(), position.normalized(), 0), 50.0);
    ASSERT_TRUE(hit);
    const double error = position.norm() - hit->distance_m;
    sum += error;
    squares += error * error;
  }
  const double n = static_cast<double>(points.size());
  // Four standard deviations of the estimates.
  EXPECT_NEAR(sum / n, 0.0, 4.0 * sensor_.range_sigma_m / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(squares / n), sensor_.range_sigma_m,
              4.0 * sensor_.range_sigma_m / std::sqrt(2.0 * n));
}

TEST_P(SensorTest, LosesAFewPercentOfTheBeams) {
  const double beams = static_cast<double>(beamsOfScan(sensor_, 42, 0).size());
  const double points = static_cast<double>(takeScan(room(), request_).size());
  EXPECT_LT(points, 0.99 * beams);
  EXPECT_GT(points, 0.95 * beams);
}

TEST_P(SensorTest, ThreadsDoNotChangeTheScan) {
  const World world = room();
  const std::vector<Return> one = takeScan(world, request_);
  for (const int threads : {2, 3, 7}) {
    request_.threads = threads;
    const std::vector<Return> many = takeScan(world, request_);
    ASSERT_EQ(one.size(), many.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
      ASSERT_EQ(one[i].position, many[i].position);
      ASSERT_EQ(one[i].intensity, many[i].intensity);
    }
  }
}

TEST_P(SensorTest, BeamsAreOrderedByTimeWithinTheScan) {
  float before = 0.0F;
  for (const Beam& beam : beamsOfScan(sensor_, 1, 3)) {
    ASSERT_NEAR(beam.direction.norm(), 1.0, 1e-12);
    ASSERT_GE(beam.time_s, before);
    before = beam.time_s;
  }
  EXPECT_LE(before, static_cast<float>(kScanPeriod_s));
}

TEST_P(SensorTest, GivesNoPointsWithoutSurroundings) {
  const World nothing({}, Ground(Profile({{0.0, -500.0}}), Profile(), {}, kAsphalt));
  EXPECT_TRUE(takeScan(nothing, request_).empty());
}

INSTANTIATE_TEST_SUITE_P(All, SensorTest, testing::ValuesIn(sensorNames()),
                         [](const auto& test) { return test.param; });

TEST(SpinningSensorTest, RingsHaveTheirElevation) {
  for (const std::string name : {"hdl64", "vlp16"}) {
    const SensorModel sensor = makeSensor(name);
    std::set<int> rings;
    for (const Return& point : takeScan(room(), {sensor, Eigen::Isometry3d::Identity(), 1, 0, 1})) {
      const Vector3d p = point.position.cast<double>();
      // Single precision of the coordinates.
      ASSERT_NEAR(std::asin(p.z() / p.norm()), sensor.ring_elevation_rad[point.ring], 1e-6);
      rings.insert(point.ring);
    }
    EXPECT_EQ(rings.size(), sensor.ring_elevation_rad.size());
  }
}

TEST(SpinningSensorTest, FieldOfViewIsTheDataSheets) {
  constexpr double kDegree = M_PI / 180.0;
  const SensorModel hdl64 = makeSensor("hdl64");
  EXPECT_EQ(hdl64.ring_elevation_rad.size(), 64U);
  EXPECT_NEAR(hdl64.ring_elevation_rad.front(), 2.0 * kDegree, 1e-9);
  EXPECT_NEAR(hdl64.ring_elevation_rad.back(), -24.8 * kDegree, 1e-9);
  const SensorModel vlp16 = makeSensor("vlp16");
  EXPECT_EQ(vlp16.ring_elevation_rad.size(), 16U);
  EXPECT_NEAR(vlp16.ring_elevation_rad.front(), -15.0 * kDegree, 1e-9);
  EXPECT_NEAR(vlp16.ring_elevation_rad.back(), 15.0 * kDegree, 1e-9);
}

TEST(RosetteSensorTest, CoversItsFieldOfViewEvenlyAndNeverRepeats) {
  constexpr double kDegree = M_PI / 180.0;
  const SensorModel sensor = makeSensor("mid360");
  const std::vector<Beam> first = beamsOfScan(sensor, 1, 0);
  const std::vector<Beam> second = beamsOfScan(sensor, 1, 1);
  ASSERT_EQ(first.size(), 20000U);
  std::vector<int> cells(36 * 10, 0);
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_GT((first[i].direction - second[i].direction).norm(), 1e-6);
    const double elevation = std::asin(first[i].direction.z()) / kDegree;
    ASSERT_GE(elevation, -7.0 - 1e-9);
    ASSERT_LE(elevation, 52.0 + 1e-9);
    const double azimuth = std::atan2(first[i].direction.y(), first[i].direction.x()) / kDegree;
    const int column = std::min(35, static_cast<int>((azimuth + 180.0) / 10.0));
    const int row = std::min(9, static_cast<int>((elevation + 7.0) / 5.9));
    ++cells[static_cast<std::size_t>(10 * column + row)];
  }
  // Random beams would scatter by sqrt(55.6) = 7.5; a low-discrepancy sequence keeps closer to the
  // mean.
  for (const int count : cells) EXPECT_NEAR(count, 20000.0 / 360.0, 6.0);
}

TEST(MirrorTest, PutsGhostsBelowTheGround) {
  const Ground wet(Profile(), Profile(), {{{10.0, 0.0}, {4.0, 4.0}}}, kAsphalt);
  const World world({makeBlock({20, -5, 0}, {21, 5, 10}, kPlaster)}, wet);
  const SensorModel sensor = makeSensor("hdl64");
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation().z() = 1.73;
  int ghosts = 0;
  for (const Return& point : takeScan(world, {sensor, pose, 1, 0, 1})) {
    EXPECT_FALSE(point.moving);
    if (point.position.z() > -1.73F - 0.2F) continue;
    ++ghosts;
    EXPECT_NEAR(point.position.x(), 20.0F, 0.15F);  // the mirrored wall
  }
  EXPECT_GT(ghosts, 20);
}

TEST(MirrorTest, DoesNotShowMovingThings) {
  const Ground wet(Profile(), Profile(), {{{10.0, 0.0}, {4.0, 4.0}}}, kAsphalt);
  World world({}, wet);
  Shape wall = makeBlock({20, -5, 0}, {21, 5, 10}, kPlaster);
  wall.moving = true;
  world.placeActors({wall});
  const SensorModel sensor = makeSensor("hdl64");
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation().z() = 1.73;
  int moving = 0;
  for (const Return& point : takeScan(world, {sensor, pose, 1, 0, 1})) {
    EXPECT_GT(point.position.z(), -1.73F - 0.2F);
    moving += point.moving ? 1 : 0;
  }
  EXPECT_GT(moving, 1000);
}

TEST(SensorNameTest, RefusesAnUnknownOne) {
  EXPECT_THROW(makeSensor("hdl65"), std::invalid_argument);
}

}  // namespace
}  // namespace beautymap::simulation
