// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "pcd_folder_sink.h"

#include <cstdio>
#include <cstring>
#include <filesystem>

#include "beautymap/io/cloud_fields.h"
#include "beautymap/io/moving_labels.h"
#include "beautymap/io/new_file.h"
#include "scan_files.h"

namespace beautymap {
namespace {

namespace fs = std::filesystem;

// Beyond that distance from the origin float32 is coarser than 1 mm.
constexpr double kFloat32Range = 1e4;

template <typename Coordinate>
pcl::PCLPointCloud2 groundTruthLayout(std::uint8_t coordinate_type) {
  pcl::PCLPointCloud2 cloud;
  std::uint32_t offset = 0;
  for (const char* name : {"x", "y", "z", "intensity"}) {
    const bool is_intensity = std::strcmp(name, "intensity") == 0;
    pcl::PCLPointField field;
    field.name = name;
    field.offset = offset;
    field.datatype = is_intensity ? std::uint8_t{pcl::PCLPointField::FLOAT32} : coordinate_type;
    field.count = 1;
    offset += static_cast<std::uint32_t>(is_intensity ? sizeof(float) : sizeof(Coordinate));
    cloud.fields.push_back(field);
  }
  cloud.point_step = offset;
  cloud.height = 1;
  return cloud;
}

template <typename Coordinate>
void appendPoints(const pcl::PCLPointCloud2& cloud, const std::vector<PointLabel>& labels,
                  PcdStreamWriter& writer) {
  const FieldReader coordinates[] = {{cloud, "x"}, {cloud, "y"}, {cloud, "z"}};
  std::uint8_t record[3 * sizeof(Coordinate) + sizeof(float)];
  for (std::size_t i = 0; i < labels.size(); ++i) {
    // Not every evaluation knows a third value.
    if (labels[i] == PointLabel::kIgnored) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto value = static_cast<Coordinate>(coordinates[axis](i));
      std::memcpy(record + axis * sizeof(value), &value, sizeof(value));
    }
    const float intensity = labels[i] == PointLabel::kMoving ? 1.0F : 0.0F;
    std::memcpy(record + 3 * sizeof(Coordinate), &intensity, sizeof(intensity));
    writer.append(record);
  }
}

}  // namespace

PcdFolderSink::PcdFolderSink(const std::string& path, const ScanSource& source)
    : path_(path), source_(source) {
  std::error_code error;
  if (fs::exists(path_, error) && !(fs::is_directory(path_, error) && fs::is_empty(path_, error))) {
    throw InputError(path_ + ": exists already and is not an empty folder; nothing was written");
  }
  temporary_path_ = newFolderBeside(path_);
  fs::create_directory(fs::path(temporary_path_) / "pcd", error);
  if (error) throw InputError("cannot create " + temporary_path_ + ": " + error.message());
}

PcdFolderSink::~PcdFolderSink() {
  std::error_code error;
  ground_truth_.reset();
  if (!closed_) fs::remove_all(temporary_path_, error);
}

void PcdFolderSink::write(const SourceScan& scan) {
  if (scans_ == 0) {
    as_float64_ = scan.T_map_sensor.translation().cwiseAbs().maxCoeff() > kFloat32Range;
  }
  pcl::PCLPointCloud2 cloud = moveCloud(scan.cloud, scan.T_map_cloud, as_float64_);
  const std::vector<PointLabel> labels = labelsOf(scan.cloud, source_);
  unifyLabels(cloud, source_);
  writeScan(cloud, scan.T_map_sensor);
  if (!labels.empty()) appendGroundTruth(cloud, labels);
  ++scans_;
}

void PcdFolderSink::writeScan(const pcl::PCLPointCloud2& cloud,
                              const Eigen::Isometry3d& T_map_sensor) {
  char name[32];
  std::snprintf(name, sizeof(name), "%06zu.pcd", scans_);
  PcdStreamWriter writer((fs::path(temporary_path_) / "pcd" / name).string(), cloud, T_map_sensor);
  for (std::size_t i = 0; i < pointCount(cloud); ++i) {
    writer.append(cloud.data.data() + i * cloud.point_step);
  }
  writer.close();
}

void PcdFolderSink::appendGroundTruth(const pcl::PCLPointCloud2& cloud,
                                      const std::vector<PointLabel>& labels) {
  if (ground_truth_ == nullptr) {
    ground_truth_ = std::make_unique<PcdStreamWriter>(
        (fs::path(temporary_path_) / "gt_cloud.pcd").string(),
        as_float64_ ? groundTruthLayout<double>(pcl::PCLPointField::FLOAT64)
                    : groundTruthLayout<float>(pcl::PCLPointField::FLOAT32));
  }
  as_float64_ ? appendPoints<double>(cloud, labels, *ground_truth_)
              : appendPoints<float>(cloud, labels, *ground_truth_);
}

void PcdFolderSink::close() {
  if (closed_) return;
  if (ground_truth_ != nullptr) ground_truth_->close();
  std::error_code error;
  // A folder replaces an empty one.
  fs::rename(temporary_path_, path_, error);
  if (error)
    throw InputError("cannot rename " + temporary_path_ + " to " + path_ + ": " + error.message());
  closed_ = true;
}

}  // namespace beautymap
