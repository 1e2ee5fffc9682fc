// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <string>
#include <vector>

namespace beautymap {

/// The files of a folder with this extension (.pcd, .bin; case does not matter), hidden ones left
/// out, in natural order: scan_2.pcd comes before scan_10.pcd.
std::vector<std::filesystem::path> listFiles(const std::filesystem::path& folder,
                                             const std::string& extension);

/// Whether a comes before b in natural order.
bool naturalLess(const std::string& a, const std::string& b);

/// `x 1.00 y 2.00 z 0.50 m, yaw 90.0 deg`
std::string describePose(const Eigen::Isometry3d& T_map_sensor);

/// An isometry from a translation [m] and a quaternion that need not be normalized.
/// @return false when either is not finite, the translation more than 10000 km, or the quaternion
/// far from length 1
bool makePose(const Eigen::Vector3d& translation, const Eigen::Quaterniond& rotation,
              Eigen::Isometry3d& pose);

}  // namespace beautymap
