// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "semantic_kitti_source.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>

#include "beautymap/io/cloud_fields.h"
#include "scan_files.h"

namespace beautymap {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPointBytes = 16;
constexpr std::size_t kLabelBytes = 4;
// Stamp 0 means "unknown" (and "the latest" to tf), so the first scan is not at 0.
constexpr double kFirstStampS = 1.0;
constexpr double kScanPeriodS = 0.1;

/// Reads the upper three rows of a transform. They come with few digits: the rotation is made
/// orthogonal again.
bool readTransform(std::istream& in, Eigen::Isometry3d& transform) {
  Eigen::Matrix<double, 3, 4> rows;
  for (int i = 0; i < 12; ++i) {
    if (!(in >> rows(i / 4, i % 4))) return false;
  }
  return makePose(rows.col(3), Eigen::Quaterniond(Eigen::Matrix3d(rows.leftCols<3>())), transform);
}

Eigen::Isometry3d readCalibration(const fs::path& path) {
  std::ifstream in(path);
  if (!in) {
    throw InputError(path.string() +
                     ": missing; a SemanticKITTI folder needs calib.txt with a line `Tr:` (the "
                     "velodyne's pose in the camera's frame)");
  }
  std::string line;
  while (std::getline(in, line)) {
    std::istringstream words(line);
    std::string key;
    Eigen::Isometry3d T_camera_velodyne;
    if (!(words >> key) || (key != "Tr:" && key != "Tr")) continue;
    if (readTransform(words, T_camera_velodyne)) return T_camera_velodyne;
    break;
  }
  throw InputError(path.string() + ": has no line `Tr:` with the 12 numbers of a transform");
}

std::vector<Eigen::Isometry3d> readPoses(const fs::path& path,
                                         const Eigen::Isometry3d& T_camera_velodyne) {
  std::ifstream in(path);
  if (!in) {
    throw InputError(
        path.string() +
        ": missing; a SemanticKITTI folder needs poses.txt with 12 numbers a scan (the "
        "camera's poses)");
  }
  std::vector<Eigen::Isometry3d> poses;
  std::string line;
  while (std::getline(in, line)) {
    std::istringstream words(line);
    Eigen::Isometry3d pose;
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    if (!readTransform(words, pose)) {
      throw InputError(path.string() + ": line " + std::to_string(poses.size() + 1) +
                       " does not hold the 12 numbers of a pose");
    }
    poses.push_back(T_camera_velodyne.inverse() * pose * T_camera_velodyne);
  }
  return poses;
}

std::vector<double> readTimes(const fs::path& path) {
  std::ifstream in(path);
  std::vector<double> times;
  double time = 0.0;
  while (in >> time && std::isfinite(time) && time >= 0.0) times.push_back(time);
  return times;
}

bool readBytes(const fs::path& path, std::vector<char>& bytes) {
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  if (!in) return false;
  const std::streamoff size = in.tellg();
  if (size < 0) return false;
  bytes.resize(static_cast<std::size_t>(size));
  in.seekg(0);
  return static_cast<bool>(in.read(bytes.data(), static_cast<std::streamsize>(bytes.size())));
}

pcl::PCLPointCloud2 layout(bool has_labels) {
  pcl::PCLPointCloud2 cloud;
  for (const char* name : {"x", "y", "z", "intensity", "label"}) {
    if (std::strcmp(name, "label") == 0 && !has_labels) continue;
    pcl::PCLPointField field;
    field.name = name;
    field.offset = static_cast<std::uint32_t>(4 * cloud.fields.size());
    field.datatype =
        std::strcmp(name, "label") == 0 ? pcl::PCLPointField::UINT32 : pcl::PCLPointField::FLOAT32;
    field.count = 1;
    cloud.fields.push_back(field);
  }
  cloud.point_step = static_cast<std::uint32_t>(4 * cloud.fields.size());
  cloud.height = 1;
  cloud.is_dense = false;
  cloud.is_bigendian = false;
  return cloud;
}

}  // namespace

bool SemanticKittiSource::accepts(const fs::path& folder) {
  std::error_code error;
  return fs::is_directory(folder / "velodyne", error);
}

SemanticKittiSource::SemanticKittiSource(const fs::path& folder, const SourceOptions& options)
    : folder_(folder), has_labels_(fs::is_directory(folder / "labels")) {
  T_map_velodyne_ = readPoses(folder / "poses.txt", readCalibration(folder / "calib.txt"));
  listScans(options);
}

void SemanticKittiSource::listScans(const SourceOptions& options) {
  const auto paths = listFiles(folder_ / "velodyne", ".bin");
  if (paths.empty()) throw InputError((folder_ / "velodyne").string() + ": holds no .bin files");
  const std::vector<double> times = readTimes(folder_ / "times.txt");
  double first_s = 0.0;
  std::size_t counted = 0;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const std::string stem = paths[i].stem().string();
    const bool is_number =
        stem.size() < 10 && stem.find_first_not_of("0123456789") == std::string::npos;
    const std::size_t number = is_number ? std::stoul(stem) : i;
    const double time_s =
        number < times.size() ? times[number] : static_cast<double>(number) * kScanPeriodS;
    if (i == 0) first_s = time_s;
    const double since_s = time_s - first_s;
    if (since_s < options.start_s) continue;
    if (options.duration_s > 0.0 && since_s >= options.start_s + options.duration_s) continue;
    if (counted++ % static_cast<std::size_t>(std::max(1, options.stride)) != 0) continue;
    scans_.push_back({paths[i], number,
                      static_cast<std::uint64_t>(std::llround((kFirstStampS + time_s) * 1e9))});
  }
}

std::vector<std::string> SemanticKittiSource::describe() const {
  std::vector<std::string> lines = {
      "SemanticKITTI folder " + folder_.string() + ": " + std::to_string(scans_.size()) +
          " scans, " + std::to_string(T_map_velodyne_.size()) + " poses, " +
          (has_labels_ ? "labels (moving: 252 to 259)" : "no labels"),
      "points in the velodyne's frame; map frame: Tr^-1 * poses.txt * Tr, Tr from calib.txt"};
  if (!scans_.empty() && scans_.front().number < T_map_velodyne_.size()) {
    lines.push_back("first pose: " + describePose(T_map_velodyne_[scans_.front().number]));
  }
  return lines;
}

bool SemanticKittiSource::isMoving(std::uint32_t label) const {
  const std::uint32_t semantic_class = label & 0xFFFF;
  return semantic_class >= 252 && semantic_class <= 259;
}

bool SemanticKittiSource::read(const Scan& file, SourceScan& scan) {
  if (file.number >= T_map_velodyne_.size()) {
    skip("no pose in poses.txt", file.path.string() + ": poses.txt has " +
                                     std::to_string(T_map_velodyne_.size()) + " lines");
    return false;
  }
  std::vector<char> points;
  if (!readBytes(file.path, points) || points.size() % kPointBytes != 0) {
    skip("unreadable velodyne file",
         file.path.string() + ": its size is not a multiple of 16 bytes (x y z intensity)");
    return false;
  }
  const std::size_t count = points.size() / kPointBytes;
  if (count == 0) {
    skip("empty cloud", file.path.string());
    return false;
  }
  std::vector<char> labels;
  if (has_labels_) {
    const fs::path path = folder_ / "labels" / file.path.filename().replace_extension(".label");
    if (!readBytes(path, labels) || labels.size() != count * kLabelBytes) {
      skip("labels missing or not one a point",
           path.string() + ": " + std::to_string(labels.size() / kLabelBytes) + " labels for " +
               std::to_string(count) + " points");
      return false;
    }
  }
  scan.cloud = layout(has_labels_);
  scan.cloud.width = static_cast<std::uint32_t>(count);
  scan.cloud.row_step = static_cast<std::uint32_t>(count * scan.cloud.point_step);
  scan.cloud.data.resize(count * scan.cloud.point_step);
  for (std::size_t i = 0; i < count; ++i) {
    auto* record = scan.cloud.data.data() + i * scan.cloud.point_step;
    std::memcpy(record, points.data() + i * kPointBytes, kPointBytes);
    if (has_labels_) {
      std::memcpy(record + kPointBytes, labels.data() + i * kLabelBytes, kLabelBytes);
    }
  }
  scan.T_map_cloud = scan.T_map_sensor = T_map_velodyne_[file.number];
  scan.stamp_ns = file.stamp_ns;
  return true;
}

bool SemanticKittiSource::next(SourceScan& scan) {
  while (next_ < scans_.size()) {
    if (read(scans_[next_++], scan)) return true;
  }
  return false;
}

void SemanticKittiSource::rewind() {
  next_ = 0;
  skipped_.clear();
}

}  // namespace beautymap
