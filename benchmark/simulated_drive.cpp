// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulated_drive.h"

#include <cmath>
#include <map>

#include "beautymap/simulation/scanner.h"
#include "beautymap/simulation/scene.h"
#include "beautymap/simulation/sensor.h"
#include "beautymap/simulation/simulated_source.h"
#include "beautymap/simulation/world.h"

namespace beautymap::benchmarks {
namespace {

constexpr int kScans = 8;
constexpr std::uint64_t kSeed = 1;

simulation::SensorModel spinningSensor(int beams) {
  constexpr double kLowest_deg = -24.8, kHighest_deg = 2.0;
  simulation::SensorModel sensor = simulation::makeSensor("hdl64");
  sensor.ring_elevation_rad.clear();
  for (int beam = 0; beam < beams; ++beam) {
    const double share = static_cast<double>(beam) / (beams - 1);
    sensor.ring_elevation_rad.push_back((kHighest_deg + share * (kLowest_deg - kHighest_deg)) *
                                        M_PI / 180.0);
  }
  return sensor;
}

std::vector<Scan> drive(int beams) {
  const simulation::SensorModel sensor = spinningSensor(beams);
  const simulation::Scene scene =
      simulation::makeScene("street", kScans * simulation::kScanPeriod_s, kSeed);
  simulation::World world(scene.fixed, scene.ground);
  std::vector<Scan> scans(kScans);
  for (int s = 0; s < kScans; ++s) {
    const double time_s = s * simulation::kScanPeriod_s;
    simulation::Shapes bodies;
    for (const simulation::Actor& actor : scene.actors) {
      const simulation::Placement place = actor.motion(time_s);
      if (place.present) actor.body(place, world, bodies);
    }
    world.placeActors(std::move(bodies));
    const simulation::Placement place = scene.sensor(time_s);
    Eigen::Isometry3d T_scene_sensor = Eigen::Isometry3d::Identity();
    T_scene_sensor.translation() =
        place.position + sensor.mount_height_m * Eigen::Vector3d::UnitZ();
    T_scene_sensor.rotate(Eigen::AngleAxisd(place.yaw_rad, Eigen::Vector3d::UnitZ()));
    Scan& scan = scans[static_cast<std::size_t>(s)];
    scan.T_map_cloud = simulation::SimulatedSource::mapFromScene() * T_scene_sensor;
    scan.sensor_in_map = scan.T_map_cloud.translation();
    for (const auto& r : simulation::takeScan(world, {sensor, T_scene_sensor, kSeed, s})) {
      scan.cloud.push_back({r.position.x(), r.position.y(), r.position.z()});
    }
  }
  return scans;
}

}  // namespace

const std::vector<Scan>& simulatedDrive(int beams) {
  static std::map<int, std::vector<Scan>> drives;
  const auto found = drives.find(beams);
  return found != drives.end() ? found->second : drives.emplace(beams, drive(beams)).first->second;
}

Scan shifted(const Scan& scan, double x_m, double y_m) {
  Scan moved = scan;
  const Eigen::Vector3d shift(x_m, y_m, 0.0);
  moved.T_map_cloud.pretranslate(shift);
  moved.sensor_in_map += shift;
  return moved;
}

}  // namespace beautymap::benchmarks
