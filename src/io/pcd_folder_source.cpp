// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "pcd_folder_source.h"

#include <algorithm>

#include "beautymap/io/cloud_fields.h"
#include "beautymap/io/pcd_stream.h"
#include "scan_files.h"

namespace beautymap {
namespace {

std::vector<std::filesystem::path> listScans(const std::filesystem::path& folder) {
  const auto inner = listFiles(folder / "pcd", ".pcd");
  return inner.empty() ? listFiles(folder, ".pcd") : inner;
}

bool isDefaultViewpoint(const PcdHeader& header) {
  return header.origin == Eigen::Vector3d::Zero() &&
         header.orientation.coeffs() == Eigen::Quaterniond::Identity().coeffs();
}

/// Half of the points lie nearer to `center` than this [m].
double medianDistance(const pcl::PCLPointCloud2& cloud, const Eigen::Vector3d& center) {
  const FieldReader x(cloud, "x"), y(cloud, "y"), z(cloud, "z");
  std::vector<double> distances;
  for (std::size_t i = 0; i < pointCount(cloud); ++i) {
    const double distance = (Eigen::Vector3d(x(i), y(i), z(i)) - center).norm();
    if (std::isfinite(distance)) distances.push_back(distance);
  }
  if (distances.empty()) return 0.0;
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

/// Scans taken far from the map's origin have their points around the sensor, unless somebody wrote
/// them in the sensor's frame.
bool liesAroundTheOrigin(const std::filesystem::path& file, const Eigen::Vector3d& sensor) {
  constexpr double kFar = 10.0;
  constexpr double kFactor = 3.0;
  if (sensor.norm() < kFar) return false;
  try {
    const pcl::PCLPointCloud2 cloud = readPcd(file.string());
    return medianDistance(cloud, sensor) > kFactor * medianDistance(cloud, Eigen::Vector3d::Zero());
  } catch (const std::exception&) {
    return false;  // next() counts the file as unreadable
  }
}

}  // namespace

bool PcdFolderSource::accepts(const std::filesystem::path& folder) {
  return !listScans(folder).empty();
}

PcdFolderSource::PcdFolderSource(const std::filesystem::path& folder, const SourceOptions& options)
    : folder_(folder) {
  moving_labels_ = options.moving_labels;
  if (options.start_s > 0.0 || options.duration_s > 0.0) {
    throw InputError(
        folder.string() +
        ": a PCD folder has no stamps, so start and duration mean nothing; use stride, "
        "or remove files");
  }
  const auto paths = listScans(folder);
  if (paths.empty()) throw InputError(folder.string() + ": holds no PCD files");
  const auto stride = static_cast<std::size_t>(std::max(1, options.stride));
  for (std::size_t i = 0; i < paths.size(); i += stride) {
    files_.emplace_back();
    files_.back().path = paths[i];
  }
  readViewpoints();
  makeDescription();
}

void PcdFolderSource::readViewpoints() {
  std::size_t readable = 0;
  std::size_t defaults = 0;
  for (File& file : files_) {
    try {
      const PcdHeader header = readPcdHeader(file.path.string());
      ++readable;
      defaults += isDefaultViewpoint(header) ? 1 : 0;
      if (!makePose(header.origin, header.orientation, file.T_map_sensor)) {
        file.unusable = "VIEWPOINT is not a pose";
        file.example = file.path.string() + ": not finite, or its quaternion is far from length 1";
      }
    } catch (const std::exception& error) {
      file.unusable = "unreadable PCD file";
      file.example = error.what();
    }
  }
  if (readable >= 2 && defaults == readable) {
    throw InputError(
        folder_.string() +
        ": the pose of every scan is the origin (VIEWPOINT 0 0 0 1 0 0 0 in all " +
        std::to_string(readable) +
        " files). The points must be in the map frame and VIEWPOINT must hold the sensor's pose in "
        "it (tx ty tz qw qx qy qz) when the scan was taken; beautymap_convert writes such folders "
        "from bags");
  }
}

void PcdFolderSource::makeDescription() {
  description_.push_back("PCD folder " + folder_.string() + ": " + std::to_string(files_.size()) +
                         " scans, no stamps");
  description_.push_back(
      "points are taken as they are, in the map frame; VIEWPOINT is the sensor's "
      "pose");
  const File* first = nullptr;
  const File* farthest = nullptr;
  double path_m = 0.0;
  const File* last = nullptr;
  for (const File& file : files_) {
    if (!file.unusable.empty()) continue;
    const auto& position = file.T_map_sensor.translation();
    if (first == nullptr) first = farthest = &file;
    if (position.norm() > farthest->T_map_sensor.translation().norm()) farthest = &file;
    if (last != nullptr) path_m += (position - last->T_map_sensor.translation()).norm();
    last = &file;
  }
  if (first == nullptr) return;
  char path[64];
  std::snprintf(path, sizeof(path), "; the sensor's path is %.1f m long", path_m);
  description_.push_back("first pose: " + describePose(first->T_map_sensor) + path);
  if (liesAroundTheOrigin(farthest->path, farthest->T_map_sensor.translation())) {
    description_.push_back("WARNING: the points of " + farthest->path.filename().string() +
                           " lie around the origin and not around its VIEWPOINT; they look as if "
                           "they were in the sensor's frame instead of the map frame");
  }
}

bool PcdFolderSource::next(SourceScan& scan) {
  while (next_ < files_.size()) {
    const File& file = files_[next_++];
    if (!file.unusable.empty()) {
      skip(file.unusable, file.example);
      continue;
    }
    try {
      scan.cloud = readPcd(file.path.string());
    } catch (const std::exception& error) {  // too large for the memory, for instance
      skip("unreadable PCD file", error.what());
      continue;
    }
    if (pointCount(scan.cloud) == 0) {
      skip("empty cloud", file.path.string());
      continue;
    }
    scan.T_map_cloud.setIdentity();
    scan.T_map_sensor = file.T_map_sensor;
    scan.stamp_ns = 0;
    return true;
  }
  return false;
}

void PcdFolderSource::rewind() {
  next_ = 0;
  skipped_.clear();
}

}  // namespace beautymap
