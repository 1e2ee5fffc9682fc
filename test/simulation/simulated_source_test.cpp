// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/simulation/simulated_source.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>
#include <tuple>

namespace beautymap::simulation {
namespace {

using Eigen::Vector3d;

SimulationOptions makeOptions(const std::string& scene, const std::string& sensor, int scans) {
  SimulationOptions options;
  options.scene = scene;
  options.sensor = sensor;
  options.scans = scans;
  options.seed = 7;
  return options;
}

std::size_t offsetOf(const pcl::PCLPointCloud2& cloud, const std::string& name) {
  for (const auto& field : cloud.fields) {
    if (field.name == name) return field.offset;
  }
  ADD_FAILURE() << "no field " << name;
  return 0;
}

struct Point {
  Vector3d position;
  bool moving = false;
};

std::vector<Point> pointsOf(const pcl::PCLPointCloud2& cloud) {
  const std::size_t label = offsetOf(cloud, "label");
  std::vector<Point> points(cloud.width);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint8_t* at = cloud.data.data() + i * cloud.point_step;
    float xyz[3];
    std::memcpy(xyz, at, sizeof(xyz));
    points[i] = {Vector3d(xyz[0], xyz[1], xyz[2]), at[label] == kLabelMoving};
  }
  return points;
}

/// What a scan should hold: bounds on the share of moving points, and the least points of each
/// sensor relative to the full number of beams (the sky takes most from the sensor that looks up).
struct Expected {
  double least_moving;
  double most_moving;
  double least_returns;
};

const std::map<std::string, Expected> kExpected{
    {"street", {0.001, 0.35, 0.4}}, {"waiting", {0.005, 0.40, 0.35}},
    {"slope", {0.005, 0.35, 0.4}},  {"bridge", {0.005, 0.30, 0.25}},
    {"hall", {0.01, 0.12, 0.9}},    {"crowd", {0.03, 0.35, 0.9}},
    {"stairs", {0.005, 0.25, 0.6}}, {"far", {0.0001, 0.006, 0.1}},
};

class EverySceneAndSensor : public testing::TestWithParam<std::tuple<std::string, std::string>> {};

TEST_P(EverySceneAndSensor, GivesAPlausibleScan) {
  const auto& [scene, sensor] = GetParam();
  const Expected& expected = kExpected.at(scene);
  SimulatedSource source(makeOptions(scene, sensor, 2));
  const double beams = static_cast<double>(beamsOfScan(makeSensor(sensor), 7, 0).size());
  SourceScan scan;
  while (source.next(scan)) {
    EXPECT_EQ(scan.cloud.height, 1U);
    EXPECT_EQ(scan.cloud.data.size(), std::size_t{scan.cloud.width} * scan.cloud.point_step);
    double moving = 0.0;
    for (const Point& point : pointsOf(scan.cloud)) {
      ASSERT_TRUE(point.position.allFinite());
      ASSERT_LT(point.position.norm(), 121.0);
      ASSERT_GT(point.position.norm(), 0.19);
      moving += point.moving ? 1.0 : 0.0;
    }
    EXPECT_GT(scan.cloud.width, expected.least_returns * beams);
    EXPECT_GE(moving, expected.least_moving * scan.cloud.width);
    EXPECT_LE(moving, expected.most_moving * scan.cloud.width);
  }
}

TEST_P(EverySceneAndSensor, LabelsAreThoseOfTheSurfaces) {
  const auto& [scene, sensor] = GetParam();
  const double tolerance_m = 6.0 * makeSensor(sensor).range_sigma_m;
  SimulatedSource source(makeOptions(scene, sensor, 1));
  SourceScan scan;
  ASSERT_TRUE(source.next(scan));
  const Eigen::Isometry3d T_scene_sensor = source.sensorInScene(0);
  int misplaced = 0;
  for (const Point& point : pointsOf(scan.cloud)) {
    const Vector3d place = T_scene_sensor * point.position;
    double nearest = 1e9;  // to a moving surface; negative inside
    for (const Shape& shape : source.world().actorShapes()) {
      if (!shape.moving || (shape.center - place).squaredNorm() > 40.0) continue;
      nearest = std::min(nearest, signedDistance(shape, place));
    }
    if (point.moving) {
      ASSERT_LT(nearest, tolerance_m);
    }
    if (!point.moving && nearest < -tolerance_m) ++misplaced;
  }
  // Only ghosts behind a mirror may lie inside of somebody.
  EXPECT_LE(misplaced, static_cast<int>(0.001 * scan.cloud.width));
}

std::string nameOf(const testing::TestParamInfo<EverySceneAndSensor::ParamType>& test) {
  return std::get<0>(test.param) + "_" + std::get<1>(test.param);
}
INSTANTIATE_TEST_SUITE_P(All, EverySceneAndSensor,
                         testing::Combine(testing::ValuesIn(sceneNames()),
                                          testing::Values("hdl64", "vlp16", "mid360")),
                         nameOf);
INSTANTIATE_TEST_SUITE_P(Mounted, EverySceneAndSensor,
                         testing::Combine(testing::Values("street"),
                                          testing::Values("cone", "dome", "vlp16_vertical")),
                         nameOf);

TEST(SimulatedSourceTest, SameSeedGivesTheSameBytesWithAnyNumberOfThreads) {
  for (const std::string scene : {"street", "crowd"}) {
    SimulationOptions options = makeOptions(scene, "vlp16", 3);
    options.pose_noise_m = 0.05;
    options.drift_m = 0.1;
    SimulatedSource one(options);
    options.threads = 2;
    SimulatedSource two(options);
    SourceScan a;
    SourceScan b;
    while (one.next(a)) {
      ASSERT_TRUE(two.next(b));
      EXPECT_EQ(a.cloud.data, b.cloud.data);
      EXPECT_EQ(a.T_map_cloud.matrix(), b.T_map_cloud.matrix());
      EXPECT_EQ(a.stamp_ns, b.stamp_ns);
    }
    EXPECT_FALSE(two.next(b));
  }
}

TEST(SimulatedSourceTest, RewindStartsTheSameSequenceAgain) {
  SimulationOptions options = makeOptions("hall", "mid360", 2);
  options.drift_m = 0.1;
  SimulatedSource source(options);
  SourceScan first;
  SourceScan second;
  SourceScan again;
  ASSERT_TRUE(source.next(first));
  ASSERT_TRUE(source.next(second));
  source.rewind();
  ASSERT_TRUE(source.next(again));
  EXPECT_EQ(first.cloud.data, again.cloud.data);
  ASSERT_TRUE(source.next(again));
  EXPECT_EQ(second.cloud.data, again.cloud.data);
  EXPECT_EQ(second.T_map_cloud.matrix(), again.T_map_cloud.matrix());
}

/// The directions of a scan's points from the sensor, with the vehicle's axes: x forward, z up.
std::vector<Vector3d> directionsOnTheVehicle(const std::string& sensor) {
  SimulatedSource source(makeOptions("street", sensor, 1));
  SourceScan scan;
  EXPECT_TRUE(source.next(scan));
  const SimulatedSource upright(makeOptions("street", "hdl64", 1));
  const Eigen::Matrix3d turn =
      upright.sensorInScene(0).linear().transpose() * source.sensorInScene(0).linear();
  std::vector<Vector3d> directions;
  for (const Point& point : pointsOf(scan.cloud)) {
    directions.push_back(turn * point.position.normalized());
  }
  return directions;
}

TEST(SimulatedSourceTest, SensorsLookWhereTheyAreMountedTo) {
  constexpr double kTilted = 0.02;  // the road under two vehicles of different length
  const double edge = std::cos(35.2 * M_PI / 180.0) * std::cos(38.6 * M_PI / 180.0);
  for (const Vector3d& d : directionsOnTheVehicle("cone")) ASSERT_LT(d.z(), kTilted - edge);
  for (const Vector3d& d : directionsOnTheVehicle("dome")) ASSERT_GT(d.x(), -kTilted);
  double lowest = 0.0;
  for (const Vector3d& d : directionsOnTheVehicle("vlp16_vertical")) {
    ASSERT_LT(std::abs(d.y()), std::sin(15.0 * M_PI / 180.0) + kTilted);
    lowest = std::min(lowest, d.z());
  }
  EXPECT_LT(lowest, -0.99);
}

TEST(SimulatedSourceTest, OtherSeedsGiveOtherScenes) {
  SimulationOptions options = makeOptions("street", "vlp16", 1);
  SimulatedSource one(options);
  options.seed = 8;
  SimulatedSource two(options);
  SourceScan a;
  SourceScan b;
  ASSERT_TRUE(one.next(a));
  ASSERT_TRUE(two.next(b));
  EXPECT_NE(a.cloud.data, b.cloud.data);
}

TEST(SimulatedSourceTest, PoseIsTrueUnlessErrorIsAskedFor) {
  SimulatedSource source(makeOptions("slope", "mid360", 3));
  SourceScan scan;
  for (int i = 0; source.next(scan); ++i) {
    const Eigen::Isometry3d truth = SimulatedSource::mapFromScene() * source.sensorInScene(i);
    EXPECT_TRUE(scan.T_map_cloud.isApprox(truth, 1e-12));
    EXPECT_EQ(scan.T_map_cloud.matrix(), scan.T_map_sensor.matrix());
    EXPECT_EQ(scan.stamp_ns % 100'000'000ULL, 0U);
  }
}

TEST(SimulatedSourceTest, PoseNoiseHasTheStatedDeviation) {
  SimulationOptions options = makeOptions("far", "mid360", 100);
  options.pose_noise_m = 0.05;
  options.pose_noise_deg = 0.2;
  SimulatedSource source(options);
  SourceScan scan;
  double shift = 0.0;
  double turn = 0.0;
  for (int i = 0; source.next(scan); ++i) {
    const Eigen::Isometry3d truth = SimulatedSource::mapFromScene() * source.sensorInScene(i);
    shift += (scan.T_map_cloud.translation() - truth.translation()).squaredNorm();
    const Eigen::AngleAxisd error(truth.linear().transpose() * scan.T_map_cloud.linear());
    turn += error.angle() * error.angle();
  }
  // 300 numbers: the estimate's own deviation is 4 %.
  EXPECT_NEAR(std::sqrt(shift / 300.0), 0.05, 0.05 * 0.15);
  EXPECT_NEAR(std::sqrt(turn / 300.0), 0.2 * M_PI / 180.0, 0.2 * M_PI / 180.0 * 0.15);
}

TEST(SimulatedSourceTest, RefusesWhatItDoesNotKnow) {
  EXPECT_THROW(SimulatedSource(makeOptions("moon", "vlp16", 1)), InputError);
  EXPECT_THROW(SimulatedSource(makeOptions("hall", "vlp17", 1)), InputError);
  EXPECT_THROW(SimulatedSource(makeOptions("hall", "vlp16", 0)), InputError);
  SimulationOptions options = makeOptions("hall", "vlp16", 1);
  options.pose_noise_m = -1.0;
  EXPECT_THROW(SimulatedSource{options}, InputError);
}

}  // namespace
}  // namespace beautymap::simulation
