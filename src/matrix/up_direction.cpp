// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/matrix/up_direction.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <random>

namespace beautymap {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kVoxel = 0.5;      // [m] one point in each, so that area counts and not density
constexpr double kNear = 30.0;      // [m] from the sensor
constexpr float kOn = 0.25F;        // [m] from a surface: belongs to it
constexpr float kUnder = 0.5F;      // [m] below a surface: speaks against it
constexpr float kStands = 2.0F;     // [m] most sensors stand no higher
constexpr int kTries = 3000;        // surfaces through three random points
constexpr int kRefinements = 3;     // of the best one, by all points on it
constexpr double kSlope = 15.0;     // [deg] up is an axis of the map: ground may slope so
constexpr double kProbable = 30.0;  // [deg] from the z axis of the map or of the sensor
constexpr double kFewest = 50.0;    // voxels of a surface that can be the ground
constexpr double kShareOfAll = 0.05;
constexpr double kRival = 0.3;  // of the ground's weight: in doubt which of both it is

double cosine(double degrees) { return std::cos(degrees * M_PI / 180.0); }

struct Axis {
  const char* name;
  Vector3d direction;
};

const std::array<Axis, 6>& axes() {
  static const std::array<Axis, 6> kAxes{{{"z", Vector3d::UnitZ()},
                                          {"-z", -Vector3d::UnitZ()},
                                          {"y", Vector3d::UnitY()},
                                          {"-y", -Vector3d::UnitY()},
                                          {"x", Vector3d::UnitX()},
                                          {"-x", -Vector3d::UnitX()}}};
  return kAxes;
}

}  // namespace

Eigen::Isometry3d UpDirection::levelFromMap() const {
  Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(up[axis]) != 1.0) continue;
    // The axes in their order, so that LOAM's and optical frames become x forward, y left, z up.
    turn.linear().setZero();
    turn.linear()(0, (axis + 1) % 3) = 1.0;
    turn.linear()(1, (axis + 2) % 3) = up[axis];
    turn.linear()(2, axis) = up[axis];
    return turn;
  }
  turn.linear() = Eigen::Quaterniond::FromTwoVectors(up, Vector3d::UnitZ()).toRotationMatrix();
  return turn;
}

void UpDirection::level(Scan& scan) const {
  if (isZ()) return;
  const Eigen::Isometry3d turn = levelFromMap();
  scan.T_map_cloud = turn * scan.T_map_cloud;
  scan.sensor_in_map = turn * scan.sensor_in_map;
}

std::string UpDirection::describe() const {
  std::array<char, 64> direction{};
  std::snprintf(direction.data(), direction.size(), "%.2f %.2f %.2f", up.x(), up.y(), up.z());
  std::string name = direction.data();
  for (const Axis& axis : axes()) {
    if (up == axis.direction) name = axis.name;
  }
  const std::string said = "up is " + name + " of the map frame";
  const std::string of_scans = std::to_string(scans) + (scans == 1 ? " scan" : " scans");
  switch (basis) {
    case Basis::kTold:
      return said + ", as map.up says";
    case Basis::kContinued:
      return said + ", as the session has it";
    case Basis::kFound:
      return said + ", found from the ground of " + of_scans + "; map.up sets it";
    case Basis::kDoubtful:
      return said + " as the first " + of_scans +
             " look, but another surface could be the ground as well: set map.up";
    default:
      return said + " as long as nothing else is told: the first " + of_scans +
             " show no ground; set map.up";
  }
}

/// A plane through points, the sensor above it.
struct UpFinder::Surface {
  Vector3f normal;      ///< towards the sensor
  float height = 0.0F;  ///< of the plane's points along the normal [m]
  double area = 0.0;    ///< voxels on it, less those under it
  int votes = 0;        ///< of the map and of the sensor: their z axes point roughly so, too
  double weight = 0.0;  ///< how probably it is the ground
};

void UpFinder::add(const Scan& scan, const Vector3d& sensor_z) {
  if (!scan.sensor_in_map.allFinite() || !scan.T_map_cloud.matrix().allFinite()) return;
  if (!sensor_z.allFinite()) return;
  if (scans_++ == 0) origin_ = scan.sensor_in_map;
  sensor_sum_ += scan.sensor_in_map - origin_;
  sensor_z_sum_ += sensor_z;
  const Vector3d from_sensor = scan.T_map_cloud.translation() - scan.sensor_in_map;
  for (const pcl::PointXYZ& point : scan.cloud) {
    const Vector3d p = point.getVector3fMap().cast<double>();
    if (p.isZero(0.0)) continue;  // what drivers write for no return
    const Vector3d relative = scan.T_map_cloud.linear() * p + from_sensor;
    // False for NaN.
    if (!(relative.squaredNorm() <= kNear * kNear)) continue;
    const Vector3d in_map = relative + (scan.sensor_in_map - origin_);
    std::uint64_t key = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const auto cell = static_cast<std::int64_t>(std::floor(in_map[axis] / kVoxel));
      key = key << 21 | (static_cast<std::uint64_t>(cell) & 0x1fffff);
    }
    if (voxels_.insert(key).second) points_.push_back(in_map.cast<float>());
  }
}

UpFinder::Surface UpFinder::surfaceOf(const Vector3f& normal, float height) const {
  Surface surface;
  const double scans = static_cast<double>(scans_);
  const float sensor = normal.dot((sensor_sum_ / scans).cast<float>());
  const float side = sensor < height ? -1.0F : 1.0F;
  surface.normal = side * normal;
  surface.height = side * height;
  int on = 0, under = 0;
  for (const Vector3f& p : points_) {
    const float above = surface.normal.dot(p) - surface.height;
    on += static_cast<int>(std::abs(above) <= kOn);
    under += static_cast<int>(above < -kUnder);
  }
  surface.area = on - under;
  const Vector3d up = surface.normal.cast<double>();
  surface.votes = static_cast<int>(up.z() >= cosine(kProbable)) +
                  static_cast<int>(up.dot(sensor_z_sum_.normalized()) >= cosine(kProbable));
  // A sensor is nearer to what it stands on than to most walls and ceilings.
  surface.weight =
      (1 << surface.votes) * surface.area / std::max(kStands, std::abs(sensor - height));
  return surface;
}

std::vector<UpFinder::Surface> UpFinder::surfaces() const {
  std::vector<Surface> found;
  if (points_.size() < kFewest) return found;
  std::mt19937 random(1);  // its raw values are the same everywhere
  const auto any = [&]() -> const Vector3f& { return points_[random() % points_.size()]; };
  for (int i = 0; i < kTries; ++i) {
    const Vector3f &a = any(), &b = any(), &c = any();
    const Vector3f normal = (b - a).cross(c - a);
    if (normal.norm() < 1.0F) continue;  // a sliver has no direction
    const Surface surface = surfaceOf(normal.normalized(), normal.normalized().dot(a));
    if (surface.area > 0.0) found.push_back(surface);
  }
  return found;
}

void UpFinder::refine(Surface& surface) const {
  Vector3d mean = Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  double count = 0.0;
  for (const Vector3f& p : points_) {
    if (std::abs(surface.normal.dot(p) - surface.height) > kOn) continue;
    const Vector3d exact = p.cast<double>();
    mean += exact;
    squares += exact * exact.transpose();
    count += 1.0;
  }
  mean /= count;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(squares / count -
                                                              mean * mean.transpose());
  const Vector3d normal = solver.eigenvectors().col(0);
  surface = surfaceOf(normal.cast<float>(), static_cast<float>(normal.dot(mean)));
}

bool UpFinder::hasRival(const Surface& ground, const std::vector<Surface>& all) const {
  return std::any_of(all.begin(), all.end(), [&](const Surface& other) {
    return other.weight > kRival * ground.weight &&
           other.normal.dot(ground.normal) < static_cast<float>(cosine(kProbable));
  });
}

UpDirection UpFinder::find(const Config& config) const {
  UpDirection result;
  for (const Axis& axis : axes()) {
    if (config.map.up != axis.name) continue;
    result.up = axis.direction;
    result.basis = UpDirection::Basis::kTold;
    return result;
  }
  result.scans = scans_;
  const std::vector<Surface> all = surfaces();
  const auto best =
      std::max_element(all.begin(), all.end(),
                       [](const Surface& a, const Surface& b) { return a.weight < b.weight; });
  const double least = std::max(kFewest, kShareOfAll * static_cast<double>(points_.size()));
  if (best == all.end() || best->area < least) return result;
  Surface ground = *best;
  for (int i = 0; i < kRefinements; ++i) refine(ground);
  // Where map and sensor say the same, a ceiling may be as large.
  const bool is_doubtful = ground.votes < 2 && hasRival(ground, all);
  result.basis = is_doubtful ? UpDirection::Basis::kDoubtful : UpDirection::Basis::kFound;
  result.up = ground.normal.cast<double>().normalized();
  for (const Axis& axis : axes()) {
    if (result.up.dot(axis.direction) >= cosine(kSlope)) result.up = axis.direction;
  }
  return result;
}

}  // namespace beautymap
