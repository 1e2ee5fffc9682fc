// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include "beautymap/io/scan_source.h"
#include "beautymap/simulation/scanner.h"
#include "beautymap/simulation/scene.h"
#include "beautymap/simulation/sensor.h"
#include "beautymap/simulation/world.h"

namespace beautymap::simulation {

constexpr int kMaxScans = 100'000;

struct SimulationOptions {
  std::string scene = "street";  ///< one of sceneNames()
  std::string sensor = "hdl64";  ///< one of sensorNames()
  int scans = 100;               ///< at 10 Hz, 1 to kMaxScans
  std::uint64_t seed = 1;
  double pose_noise_m = 0.0;    ///< standard deviation of each axis, independent in each scan [m]
  double pose_noise_deg = 0.0;  ///< the same for the rotation about each axis [deg]
  double drift_m = 0.0;         ///< random walk of each axis: its standard deviation after 10 s [m]
  double drift_deg = 0.0;       ///< the same for the yaw [deg]
  int threads = 1;              ///< the scans do not depend on it
};

/// The values of the `label` field.
constexpr std::uint8_t kLabelStatic = 0;
constexpr std::uint8_t kLabelMoving = 1;

/// Scans of a simulated scene with exact labels. Fields: x, y, z (float32, sensor frame [m]),
/// intensity (float32), ring (uint16, spinning sensors), time (float32, from the scan's start [s]),
/// label (uint8). The scene stands still during a scan, so there is no distortion in it.
class SimulatedSource : public ScanSource {
 public:
  /// @throws InputError for an unknown name or a number out of its range.
  explicit SimulatedSource(SimulationOptions options);

  bool next(SourceScan& scan) override;
  void rewind() override;
  std::size_t size() const override { return static_cast<std::size_t>(options_.scans); }
  std::vector<std::string> describe() const override;

  /// True pose of the sensor in the scene frame.
  Eigen::Isometry3d sensorInScene(int scan) const;
  /// The scene frame is turned and shifted, so that no wall is parallel to the map's axes.
  static Eigen::Isometry3d mapFromScene();
  /// The world as the scan that next() delivered last saw it.
  const World& world() const { return world_; }

 private:
  void placeActors(int scan);
  Eigen::Isometry3d withPoseError(const Eigen::Isometry3d& T_map_sensor, int scan);

  SimulationOptions options_;
  SensorModel sensor_;
  Scene scene_;
  World world_;
  int scan_ = 0;
  Eigen::Vector3d drift_m_ = Eigen::Vector3d::Zero();
  double drift_yaw_rad_ = 0.0;
};

}  // namespace beautymap::simulation
