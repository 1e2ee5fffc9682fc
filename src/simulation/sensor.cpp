// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/simulation/sensor.h"

#include <array>
#include <cmath>
#include <stdexcept>

#include "beautymap/simulation/random.h"

namespace beautymap::simulation {
namespace {

constexpr double kDegree = M_PI / 180.0;

/// HDL-64E: 32 upper lasers 1/3 deg apart from +2 deg, 32 lower ones 1/2 deg apart down to -24.8
/// deg.
SensorModel hdl64() {
  SensorModel sensor;
  sensor.name = "hdl64";
  sensor.min_range_m = 0.9;
  sensor.max_range_m = 120.0;
  sensor.range_sigma_m = 0.02;
  sensor.range_at_10pct_m = 50.0;
  sensor.mount_height_m = 1.73;
  sensor.azimuth_steps = 1920;
  for (int i = 0; i < 32; ++i) sensor.ring_elevation_rad.push_back((2.0 - i / 3.0) * kDegree);
  for (int i = 0; i < 32; ++i) sensor.ring_elevation_rad.push_back((-9.3 - i / 2.0) * kDegree);
  return sensor;
}

SensorModel vlp16() {
  SensorModel sensor;
  sensor.name = "vlp16";
  sensor.min_range_m = 0.4;
  sensor.max_range_m = 100.0;
  sensor.range_sigma_m = 0.02;
  sensor.range_at_10pct_m = 40.0;
  sensor.mount_height_m = 1.0;
  sensor.azimuth_steps = 1800;
  for (int i = 0; i < 16; ++i) sensor.ring_elevation_rad.push_back((-15.0 + 2.0 * i) * kDegree);
  return sensor;
}

SensorModel mid360() {
  SensorModel sensor;
  sensor.name = "mid360";
  sensor.min_range_m = 0.2;
  sensor.max_range_m = 70.0;
  sensor.range_sigma_m = 0.03;
  sensor.range_at_10pct_m = 40.0;
  sensor.mount_height_m = 1.0;
  sensor.handheld_pitch_rad = 15.0 * kDegree;
  sensor.has_ring = false;
  sensor.samples = 20000;
  sensor.lowest_rad = -7.0 * kDegree;
  sensor.highest_rad = 52.0 * kDegree;
  return sensor;
}

/// Avia's window of 70.4 x 77.2 degrees, from a mast or a drone straight down on the road.
SensorModel cone() {
  SensorModel sensor;
  sensor.name = "cone";
  sensor.min_range_m = 1.0;
  sensor.max_range_m = 120.0;
  sensor.range_sigma_m = 0.02;
  sensor.range_at_10pct_m = 100.0;
  sensor.mount_height_m = 25.0;
  sensor.mount_pitch_rad = 90.0 * kDegree;
  sensor.has_ring = false;
  sensor.samples = 24000;
  sensor.first_azimuth_rad = -35.2 * kDegree;
  sensor.azimuth_width_rad = 70.4 * kDegree;
  sensor.lowest_rad = -38.6 * kDegree;
  sensor.highest_rad = 38.6 * kDegree;
  return sensor;
}

/// Half of the sphere, to the front.
SensorModel dome() {
  SensorModel sensor;
  sensor.name = "dome";
  sensor.min_range_m = 0.5;
  sensor.max_range_m = 45.0;
  sensor.range_sigma_m = 0.03;
  sensor.range_at_10pct_m = 20.0;
  sensor.mount_height_m = 1.0;
  sensor.mount_pitch_rad = 90.0 * kDegree;
  sensor.azimuth_steps = 1024;
  for (int i = 0; i < 64; ++i) sensor.ring_elevation_rad.push_back(88.0 / 63.0 * i * kDegree);
  return sensor;
}

/// VLP-16 that lies on its side and scans from below over the front to above.
SensorModel vlp16Vertical() {
  SensorModel sensor = vlp16();
  sensor.name = "vlp16_vertical";
  sensor.mount_roll_rad = 90.0 * kDegree;
  return sensor;
}

Eigen::Vector3d directionOf(double azimuth_rad, double elevation_rad) {
  return {std::cos(elevation_rad) * std::cos(azimuth_rad),
          std::cos(elevation_rad) * std::sin(azimuth_rad), std::sin(elevation_rad)};
}

std::vector<Beam> spinningBeams(const SensorModel& sensor, std::uint64_t seed, int scan) {
  // The motor is not synchronised with the scans: the firings of each turn fall between the last's.
  const double phase = unitFromBits(hashOf(seed, scan, 0x5b1));
  std::vector<Beam> beams;
  beams.reserve(sensor.ring_elevation_rad.size() * static_cast<std::size_t>(sensor.azimuth_steps));
  for (int step = 0; step < sensor.azimuth_steps; ++step) {
    const double turn = (step + phase) / sensor.azimuth_steps;
    for (std::size_t ring = 0; ring < sensor.ring_elevation_rad.size(); ++ring) {
      Beam beam;
      // Clockwise seen from above, as these sensors turn.
      beam.direction = directionOf(M_PI - 2.0 * M_PI * turn, sensor.ring_elevation_rad[ring]);
      beam.time_s = static_cast<float>(turn * kScanPeriod_s);
      beam.ring = static_cast<std::uint16_t>(ring);
      beams.push_back(beam);
    }
  }
  return beams;
}

/// The R2 sequence (M. Roberts: generalised golden ratio) goes on from scan to scan, so each scan
/// covers the field of view evenly and none repeats another.
std::vector<Beam> rosetteBeams(const SensorModel& sensor, std::uint64_t seed, int scan) {
  constexpr double kStep1 = 0.7548776662466927;
  constexpr double kStep2 = 0.5698402909980532;
  const double start1 = unitFromBits(hashOf(seed, 0xa21));
  const double start2 = unitFromBits(hashOf(seed, 0xa22));
  std::vector<Beam> beams(static_cast<std::size_t>(sensor.samples));
  for (int i = 0; i < sensor.samples; ++i) {
    const double n = static_cast<double>(scan) * sensor.samples + i;
    const double u = start1 + n * kStep1;
    const double v = start2 + n * kStep2;
    Beam& beam = beams[static_cast<std::size_t>(i)];
    beam.direction = directionOf(
        sensor.first_azimuth_rad + sensor.azimuth_width_rad * (u - std::floor(u)),
        sensor.lowest_rad + (sensor.highest_rad - sensor.lowest_rad) * (v - std::floor(v)));
    beam.time_s = static_cast<float>(kScanPeriod_s * i / sensor.samples);
  }
  return beams;
}

constexpr std::array<SensorModel (*)(), 6> kSensors{hdl64, vlp16, mid360,
                                                    cone,  dome,  vlp16Vertical};

}  // namespace

SensorModel makeSensor(const std::string& name) {
  std::string names;
  for (const auto make : kSensors) {
    SensorModel sensor = make();
    if (sensor.name == name) return sensor;
    names += (names.empty() ? "" : ", ") + sensor.name;
  }
  throw std::invalid_argument("sensor: '" + name + "' is not one of " + names);
}

std::vector<std::string> sensorNames() {
  std::vector<std::string> names;
  names.reserve(kSensors.size());
  for (const auto make : kSensors) names.push_back(make().name);
  return names;
}

std::vector<Beam> beamsOfScan(const SensorModel& sensor, std::uint64_t seed, int scan) {
  return sensor.samples > 0 ? rosetteBeams(sensor, seed, scan) : spinningBeams(sensor, seed, scan);
}

}  // namespace beautymap::simulation
