// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "beautymap/matrix/column_grid.h"
#include "beautymap/matrix/scan.h"

/// Inputs of the tests: seeded random values and small worlds of which the truth is known.
namespace beautymap::test {

/// Raw values of std::mt19937 only: the standard's distributions differ between libraries.
class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}

  /// At least `low`, less than `high`.
  double uniform(double low, double high) {
    return low + (high - low) * (engine_() / 4294967296.0);
  }
  /// From `low` to `high`, both included.
  int integer(int low, int high) {
    return low + static_cast<int>(engine_() % static_cast<std::uint32_t>(high - low + 1));
  }
  bool chance(double probability) { return uniform(0.0, 1.0) < probability; }
  Bits bits() { return static_cast<Bits>(engine_()) << 32 | engine_(); }
  template <typename T>
  T pick(const std::vector<T>& values) {
    return values[static_cast<std::size_t>(integer(0, static_cast<int>(values.size()) - 1))];
  }
  template <typename T>
  void shuffle(std::vector<T>& values) {
    for (std::size_t i = values.size(); i > 1; --i) {
      std::swap(values[i - 1],
                values[static_cast<std::size_t>(integer(0, static_cast<int>(i) - 1))]);
    }
  }

 private:
  std::mt19937 engine_;
};

/// The nearest multiple of 1/1024: sums, differences and means of such values are exact in float up
/// to some hundred metres, so that no rounding has to be tolerated.
inline double dyadic(double value) { return std::round(value * 1024.0) / 1024.0; }

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// A cloud that is registered in the map frame already.
inline Scan registeredScan(const std::vector<Eigen::Vector3d>& points_in_map,
                           const Eigen::Vector3d& sensor_in_map) {
  Scan scan;
  scan.sensor_in_map = sensor_in_map;
  for (const Eigen::Vector3d& p : points_in_map) {
    scan.cloud.push_back(pcl::PointXYZ(static_cast<float>(p.x()), static_cast<float>(p.y()),
                                       static_cast<float>(p.z())));
  }
  return scan;
}

/// The same points in the frame of a sensor that is turned by quarter turns (which are exact) about
/// z.
inline Scan sensorFrameScan(const std::vector<Eigen::Vector3d>& points_in_map,
                            const Eigen::Vector3d& sensor_in_map, int quarter_turns) {
  Eigen::Matrix3d quarter;
  quarter << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  for (int i = 0; i < quarter_turns; ++i) rotation = quarter * rotation;
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3d& p : points_in_map) {
    points.push_back(rotation.transpose() * (p - sensor_in_map));
  }
  Scan scan = registeredScan(points, sensor_in_map);
  scan.T_map_cloud.linear() = rotation;
  scan.T_map_cloud.translation() = sensor_in_map;
  return scan;
}

/// A scan as the stages get it: points [m] relative to the corner of the anchor column.
inline PlacedScan placedScan(ColumnIndex anchor, const Eigen::Vector3d& sensor,
                             const std::vector<Eigen::Vector3d>& points, double res_g = 0.5) {
  PlacedScan placed;
  placed.anchor = anchor;
  placed.sensor = sensor.cast<float>();
  for (const Eigen::Vector3d& p : points) {
    placed.source_index.push_back(static_cast<std::uint32_t>(placed.size()));
    placed.x.push_back(static_cast<float>(p.x()));
    placed.y.push_back(static_cast<float>(p.y()));
    placed.z.push_back(static_cast<float>(p.z()));
  }
  placed.cloud_size = placed.size();
  findRuns(placed, res_g);
  return placed;
}

/// Scans of a small world with a tilted ground, walls, things that come and go, and returns from
/// below the ground. All coordinates are dyadic(), so that no cell border is a matter of rounding.
inline std::vector<Scan> randomDrive(std::uint32_t seed, int scans = 4, int points_per_scan = 250) {
  Random random(seed);
  const auto point = [&](double extent, double low, double high) {
    const double x = dyadic(random.uniform(-extent, extent));
    const double y = dyadic(random.uniform(-extent, extent));
    return Eigen::Vector3d(x, y, dyadic(0.05 * x + random.uniform(low, high)));
  };
  std::vector<Eigen::Vector3d> walls;
  for (int i = 0; i < 4 * points_per_scan; ++i) {
    walls.push_back(point(8.0, 0.0, 4.0));
    walls.back().x() = random.chance(0.5) ? 4.25 : walls.back().x();
  }
  std::vector<Scan> drive;
  for (int s = 0; s < scans; ++s) {
    std::vector<Eigen::Vector3d> points;
    const Eigen::Vector3d visitor = point(6.0, 0.0, 0.0);
    for (int i = 0; i < points_per_scan; ++i) {
      const double kind = random.uniform(0.0, 1.0);
      if (kind < 0.5) {
        points.push_back(point(8.0, 0.0, 0.1));
      } else if (kind < 0.75) {
        points.push_back(random.pick(walls));
      } else if (kind < 0.97) {
        points.push_back(visitor + point(0.5, 0.0, 1.7));
      } else {
        points.push_back(point(8.0, -4.0, 0.0));
      }
    }
    const Eigen::Vector3d sensor = point(3.0, 0.5, 2.5);
    drive.push_back(random.chance(0.5) ? registeredScan(points, sensor)
                                       : sensorFrameScan(points, sensor, random.integer(0, 3)));
    drive.back().cloud.push_back(pcl::PointXYZ(kNan, 0.0F, 1.0F));
    drive.back().cloud.push_back(pcl::PointXYZ(0.0F, 0.0F, 0.0F));
    drive.back().cloud.push_back(pcl::PointXYZ(1e6F, 0.0F, 1.0F));
  }
  return drive;
}

/// An axis-parallel box [m].
struct Box {
  Eigen::Vector3d low, high;
};

/// A world of flat ground at z = 0 and boxes on it, which a spinning sensor looks at.
struct BoxWorld {
  static constexpr int kGround = -1;

  std::vector<Box> boxes;
  double max_range_m = 60.0;

  /// Distance to the first surface along a ray, and which box it is (kGround: none); infinity where
  /// there is none.
  std::pair<double, int> cast(const Eigen::Vector3d& from, const Eigen::Vector3d& direction) const {
    std::pair<double, int> first{std::numeric_limits<double>::infinity(), kGround};
    if (direction.z() < 0.0) first.first = -from.z() / direction.z();
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const Eigen::Array3d a = (boxes[i].low - from).array() / direction.array();
      const Eigen::Array3d b = (boxes[i].high - from).array() / direction.array();
      const double enter = a.min(b).maxCoeff();
      const double leave = a.max(b).minCoeff();
      if (enter > 0.0 && enter < leave && enter < first.first) {
        first = {enter, static_cast<int>(i)};
      }
    }
    return first;
  }
};

/// A scan of a world, in the map frame, and which box each point lies on.
struct LabelledScan {
  Scan scan;
  std::vector<int> box;
};

/// Beams from `lowest_deg` to `highest_deg` elevation, all around.
inline LabelledScan castScan(const BoxWorld& world, const Eigen::Vector3d& sensor, int beams,
                             double lowest_deg, double highest_deg, int azimuths) {
  constexpr double kPi = 3.14159265358979323846;
  LabelledScan labelled;
  std::vector<Eigen::Vector3d> points;
  for (int a = 0; a < azimuths; ++a) {
    const double azimuth = 2.0 * kPi * (a + 0.37) / azimuths;
    for (int b = 0; b < beams; ++b) {
      const double elevation =
          kPi / 180.0 * (lowest_deg + (highest_deg - lowest_deg) * b / (beams - 1));
      const Eigen::Vector3d ray(std::cos(elevation) * std::cos(azimuth),
                                std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      const auto hit = world.cast(sensor, ray);
      if (hit.first > world.max_range_m) continue;
      points.push_back(sensor + hit.first * ray);
      labelled.box.push_back(hit.second);
    }
  }
  labelled.scan = registeredScan(points, sensor);
  return labelled;
}

}  // namespace beautymap::test
