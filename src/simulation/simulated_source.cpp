// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/simulation/simulated_source.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "beautymap/simulation/random.h"

namespace beautymap::simulation {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kDegree = M_PI / 180.0;
constexpr std::uint64_t kFirstStamp_ns = 1'700'000'000'000'000'000ULL;
constexpr std::uint64_t kScanPeriod_ns = 100'000'000ULL;
constexpr double kHandheldHeight_m = 1.4;

SimulationOptions checked(SimulationOptions options) {
  const auto require = [](bool good, const std::string& message) {
    if (!good) throw InputError(message);
  };
  const auto notNegative = [&](double value, const std::string& name) {
    require(value >= 0.0 && std::isfinite(value), name + ": must be 0 or more");
  };
  require(options.scans >= 1 && options.scans <= kMaxScans,
          "scans: must be 1 to " + std::to_string(kMaxScans));
  require(options.threads >= 1 && options.threads <= 256, "threads: must be 1 to 256");
  notNegative(options.pose_noise_m, "pose noise [m]");
  notNegative(options.pose_noise_deg, "pose noise [deg]");
  notNegative(options.drift_m, "drift [m]");
  notNegative(options.drift_deg, "drift [deg]");
  return options;
}

/// An unknown name is the user's mistake, like any other unusable input.
template <typename Make>
auto orInputError(const Make& make) {
  try {
    return make();
  } catch (const std::invalid_argument& error) {
    throw InputError(error.what());
  }
}

Vector3d normalVector(Random& random) {
  const double x = random.normal();
  const double y = random.normal();
  return {x, y, random.normal()};
}

Isometry3d rotationOf(const Vector3d& angles_rad) {
  Isometry3d rotation = Isometry3d::Identity();
  const double angle = angles_rad.norm();
  if (angle > 0.0) rotation.linear() = AngleAxisd(angle, angles_rad / angle).toRotationMatrix();
  return rotation;
}

/// Springs and steps: how the carrier shakes the sensor.
Isometry3d shake(Carrier carrier, double time_s) {
  const double strength = carrier == Carrier::kHandheld ? 3.0 : 1.0;
  const Vector3d angles(0.4 * std::sin(7.1 * time_s), 0.5 * std::sin(5.3 * time_s + 1.0),
                        0.15 * std::sin(3.7 * time_s));
  Isometry3d motion = rotationOf(strength * kDegree * angles);
  motion.translation().z() = 0.01 * strength * std::sin(9.4 * time_s);
  return motion;
}

/// How the points of a scan are laid out; like in drivers' clouds, a few bytes are left unused for
/// alignment.
struct Layout {
  static constexpr std::size_t kStep = 24;
  static constexpr std::size_t kIntensity = 12;
  static constexpr std::size_t kRing = 16;
  static constexpr std::size_t kLabel = 18;
  static constexpr std::size_t kTime = 20;
};

pcl::PCLPointField makeField(const char* name, std::size_t offset, std::uint8_t datatype) {
  pcl::PCLPointField field;
  field.name = name;
  field.offset = static_cast<std::uint32_t>(offset);
  field.datatype = datatype;
  field.count = 1;
  return field;
}

pcl::PCLPointCloud2 makeCloud(const std::vector<Return>& returns, bool has_ring) {
  pcl::PCLPointCloud2 cloud;
  cloud.fields = {makeField("x", 0, pcl::PCLPointField::FLOAT32),
                  makeField("y", 4, pcl::PCLPointField::FLOAT32),
                  makeField("z", 8, pcl::PCLPointField::FLOAT32),
                  makeField("intensity", Layout::kIntensity, pcl::PCLPointField::FLOAT32)};
  if (has_ring) {
    cloud.fields.push_back(makeField("ring", Layout::kRing, pcl::PCLPointField::UINT16));
  }
  cloud.fields.push_back(makeField("label", Layout::kLabel, pcl::PCLPointField::UINT8));
  cloud.fields.push_back(makeField("time", Layout::kTime, pcl::PCLPointField::FLOAT32));
  cloud.height = 1;
  cloud.width = static_cast<std::uint32_t>(returns.size());
  cloud.point_step = Layout::kStep;
  cloud.row_step = cloud.width * cloud.point_step;
  cloud.is_dense = 1;
  cloud.is_bigendian = 0;
  cloud.data.assign(returns.size() * Layout::kStep, 0);
  std::uint8_t* at = cloud.data.data();
  for (const Return& point : returns) {
    std::memcpy(at, point.position.data(), 3 * sizeof(float));
    std::memcpy(at + Layout::kIntensity, &point.intensity, sizeof(float));
    if (has_ring) std::memcpy(at + Layout::kRing, &point.ring, sizeof(point.ring));
    at[Layout::kLabel] = point.moving ? kLabelMoving : kLabelStatic;
    std::memcpy(at + Layout::kTime, &point.time_s, sizeof(float));
    at += Layout::kStep;
  }
  return cloud;
}

}  // namespace

SimulatedSource::SimulatedSource(SimulationOptions options)
    : options_(checked(std::move(options))),
      sensor_(orInputError([this] { return makeSensor(options_.sensor); })),
      scene_(orInputError([this] {
        return makeScene(options_.scene, options_.scans * kScanPeriod_s, options_.seed);
      })),
      world_(scene_.fixed, scene_.ground) {}

Isometry3d SimulatedSource::mapFromScene() {
  Isometry3d T_map_scene = Isometry3d::Identity();
  T_map_scene.linear() = AngleAxisd(17.0 * kDegree, Vector3d::UnitZ()).toRotationMatrix();
  T_map_scene.translation() = Vector3d(-137.3, 81.6, 4.2);
  return T_map_scene;
}

Isometry3d SimulatedSource::sensorInScene(int scan) const {
  const double time_s = scan * kScanPeriod_s;
  const Placement place = scene_.sensor(time_s);
  Isometry3d pose = Isometry3d::Identity();
  double height = sensor_.mount_height_m;
  double pitch = 0.0;
  if (scene_.carrier == Carrier::kVehicle) {
    const bool car = sensor_.mount_height_m > 1.5;
    pose = poseOnSurface(place, car ? 2.7 : 0.8, car ? 1.6 : 0.6, world_);
  } else {
    pose.linear() = AngleAxisd(place.yaw_rad, Vector3d::UnitZ()).toRotationMatrix();
    pose.translation() = place.position;
    height = kHandheldHeight_m;
    pitch = sensor_.handheld_pitch_rad;
  }
  Isometry3d mount = shake(scene_.carrier, time_s);
  mount.translation().z() += height;
  return pose * mount * AngleAxisd(pitch + sensor_.mount_pitch_rad, Vector3d::UnitY()) *
         AngleAxisd(sensor_.mount_roll_rad, Vector3d::UnitX());
}

void SimulatedSource::placeActors(int scan) {
  constexpr double kHorizon_m = 130.0;  // beyond every sensor's range
  constexpr double kClearance_m = 0.4;
  const Vector3d sensor = sensorInScene(scan).translation();
  Shapes all;
  for (const Actor& actor : scene_.actors) {
    const Placement place = actor.motion(scan * kScanPeriod_s);
    if (!place.present || (place.position - sensor).head<2>().norm() > kHorizon_m) continue;
    Shapes body;
    actor.body(place, world_, body);
    // Nobody walks or drives through the sensor: where ways cross, that one is left out.
    const bool in_the_way = std::any_of(body.begin(), body.end(), [&](const Shape& shape) {
      return signedDistance(shape, sensor) < kClearance_m;
    });
    if (!in_the_way) all.insert(all.end(), body.begin(), body.end());
  }
  world_.placeActors(std::move(all));
}

Isometry3d SimulatedSource::withPoseError(const Isometry3d& T_map_sensor, int scan) {
  constexpr double kScansOfDrift = 100.0;
  Random random(hashOf(options_.seed, scan, 0x905e));
  Isometry3d pose = T_map_sensor;
  if (scan > 0) {
    drift_m_ += options_.drift_m / std::sqrt(kScansOfDrift) * normalVector(random);
    drift_yaw_rad_ += options_.drift_deg * kDegree / std::sqrt(kScansOfDrift) * random.normal();
  }
  pose.linear() = AngleAxisd(drift_yaw_rad_, Vector3d::UnitZ()) * pose.linear();
  pose.translation() += drift_m_ + options_.pose_noise_m * normalVector(random);
  return pose * rotationOf(options_.pose_noise_deg * kDegree * normalVector(random));
}

bool SimulatedSource::next(SourceScan& scan) {
  if (scan_ >= options_.scans) return false;
  placeActors(scan_);
  const Isometry3d T_scene_sensor = sensorInScene(scan_);
  scan.cloud =
      makeCloud(takeScan(world_, {sensor_, T_scene_sensor, options_.seed, scan_, options_.threads}),
                sensor_.has_ring);
  scan.stamp_ns = kFirstStamp_ns + static_cast<std::uint64_t>(scan_) * kScanPeriod_ns;
  scan.cloud.header.stamp = scan.stamp_ns / 1000;  // PCL counts microseconds
  scan.cloud.header.seq = static_cast<std::uint32_t>(scan_);
  scan.cloud.header.frame_id = "lidar";
  scan.T_map_cloud = withPoseError(mapFromScene() * T_scene_sensor, scan_);
  scan.T_map_sensor = scan.T_map_cloud;
  ++scan_;
  return true;
}

void SimulatedSource::rewind() {
  scan_ = 0;
  drift_m_.setZero();
  drift_yaw_rad_ = 0.0;
  skipped_.clear();
}

std::vector<std::string> SimulatedSource::describe() const {
  std::ostringstream line;
  line << "simulated scene " << options_.scene << ", sensor " << options_.sensor << ", "
       << options_.scans << " scans, seed " << options_.seed;
  std::ostringstream size;
  size << scene_.fixed.size() << " fixed shapes, " << scene_.actors.size() << " actors";
  return {line.str(), size.str()};
}

}  // namespace beautymap::simulation
