// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <string>
#include <unordered_set>
#include <vector>

#include "beautymap/config/config.h"
#include "beautymap/matrix/scan.h"

namespace beautymap {

/// Which way is up in the map frame. The method works where that is z: scans are turned to it on
/// their way in, and only there.
struct UpDirection {
  enum class Basis : std::uint8_t {
    kTold,      ///< by map.up
    kFound,     ///< from the ground
    kDoubtful,  ///< the same, but another surface could be the ground as well
    kAssumed,   ///< no ground was found: z
    kContinued  ///< as the map was begun with
  };

  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< unit vector of the map frame
  Basis basis = Basis::kAssumed;
  std::size_t scans = 0;  ///< that were looked at

  bool isZ() const { return up == Eigen::Vector3d::UnitZ(); }
  bool isCertain() const { return basis != Basis::kDoubtful && basis != Basis::kAssumed; }
  /// T_level_map, which turns the map frame so that up becomes z; exact where up is an axis.
  Eigen::Isometry3d levelFromMap() const;
  /// Turns where a scan was taken.
  void level(Scan& scan) const;
  /// A sentence for the user.
  std::string describe() const;
};

/// Finds it in the first scans of a map: ground is a large surface below the sensor with little
/// underneath.
class UpFinder {
 public:
  /// @param sensor_z  z axis of the sensor in the map frame: most sensors stand upright
  void add(const Scan& scan, const Eigen::Vector3d& sensor_z);
  /// What map.up says, or else the scans. The same scans give the same result.
  UpDirection find(const Config& config) const;

 private:
  struct Surface;
  Surface surfaceOf(const Eigen::Vector3f& normal, float height) const;
  std::vector<Surface> surfaces() const;
  void refine(Surface& surface) const;
  bool hasRival(const Surface& ground, const std::vector<Surface>& all) const;

  std::size_t scans_ = 0;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();  ///< the first sensor [m] in the map frame
  Eigen::Vector3d sensor_sum_ = Eigen::Vector3d::Zero(), sensor_z_sum_ = Eigen::Vector3d::Zero();
  std::unordered_set<std::uint64_t> voxels_;
  std::vector<Eigen::Vector3f> points_;  ///< the first in each voxel, relative to origin_ [m]
};

}  // namespace beautymap
