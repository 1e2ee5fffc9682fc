// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace beautymap::simulation {

struct Beam {
  Eigen::Vector3d direction;  ///< unit length, sensor frame
  float time_s = 0.0F;        ///< from the scan's start
  std::uint16_t ring = 0;
};

/// What is known of a sensor from its data sheet.
struct SensorModel {
  std::string name;
  double min_range_m = 0.0;
  double max_range_m = 0.0;
  double range_sigma_m = 0.0;    ///< standard deviation of the range noise
  double range_at_10pct_m = 0;   ///< range up to which a surface of 10 % reflectivity is detected
  double mount_height_m = 0.0;   ///< on a vehicle, above the ground
  double mount_pitch_rad = 0.0;  ///< how it is turned on its carrier, about y; positive: looks down
  double mount_roll_rad = 0.0;   ///< or about x
  double handheld_pitch_rad = 0.0;  ///< tilted forward that much when it is carried by hand
  bool has_ring = true;
  std::vector<double> ring_elevation_rad;  ///< spinning sensors: elevation of each ring
  int azimuth_steps = 0;                   ///< spinning sensors: firings in one turn
  int samples = 0;                         ///< non-repetitive sensors: beams per scan
  double first_azimuth_rad = 0.0;          ///< non-repetitive sensors: field of view
  double azimuth_width_rad = 2.0 * M_PI;
  double lowest_rad = 0.0;
  double highest_rad = 0.0;
};

constexpr double kScanPeriod_s = 0.1;

/// @throws std::invalid_argument for a name other than sensorNames().
SensorModel makeSensor(const std::string& name);
std::vector<std::string> sensorNames();

/// All beams of one scan in the order in which they are fired.
std::vector<Beam> beamsOfScan(const SensorModel& sensor, std::uint64_t seed, int scan);

}  // namespace beautymap::simulation
