// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <filesystem>

#include "beautymap/io/scan_source.h"
#include "pcd_folder_source.h"
#include "rosbag_source.h"
#include "semantic_kitti_source.h"

namespace beautymap {
namespace {

namespace fs = std::filesystem;

const char* const kExpected =
    "expected are bags (*.bag), a folder with pcd/*.pcd (points in the map frame, sensor poses in "
    "VIEWPOINT) or a SemanticKITTI sequence (velodyne/*.bin, poses.txt, calib.txt)";

/// These options only mean something in bags; nothing is ignored silently.
void refuseBagOptions(const std::string& folder, const SourceOptions& options) {
  const bool given = !options.map_frame.empty() || !options.cloud_topic.empty() ||
                     !options.sensor_frame.empty() || !options.odom_topic.empty();
  if (given) {
    throw InputError(folder +
                     ": is a folder, where topics and frames (--cloud-topic, --odom-topic, "
                     "--map-frame, --sensor-frame) mean nothing");
  }
}

std::unique_ptr<ScanSource> openFolder(const std::string& folder, const SourceOptions& options) {
  if (SemanticKittiSource::accepts(folder)) {
    refuseBagOptions(folder, options);
    if (options.moving_labels != SourceOptions().moving_labels) {
      throw InputError(folder +
                       ": is a SemanticKITTI sequence, whose moving classes are 252 to 259; "
                       "--moving-labels is for bags and PCD folders");
    }
    return std::make_unique<SemanticKittiSource>(folder, options);
  }
  if (PcdFolderSource::accepts(folder)) {
    refuseBagOptions(folder, options);
    return std::make_unique<PcdFolderSource>(folder, options);
  }
  throw InputError(folder + ": the folder holds no scans; " + kExpected);
}

void checkOptions(const SourceOptions& options) {
  if (options.stride < 1) throw InputError("stride must be at least 1");
  if (!(options.start_s >= 0.0) || !(options.duration_s >= 0.0)) {
    throw InputError("start and duration must not be negative");
  }
  const std::vector<std::uint32_t>& moving = options.moving_labels;
  if (moving.empty() || std::find(moving.begin(), moving.end(), 0) != moving.end()) {
    throw InputError("moving labels must be numbers other than 0, which means static");
  }
}

}  // namespace

std::unique_ptr<ScanSource> openScanSource(const std::vector<std::string>& inputs,
                                           const SourceOptions& options) {
  checkOptions(options);
  if (inputs.empty()) throw InputError(std::string("there is no input; ") + kExpected);
  for (const std::string& input : inputs) {
    std::error_code error;
    if (!fs::exists(input, error)) {
      throw InputError(input + ": there is no such file or folder; " + kExpected);
    }
    if (fs::is_directory(input, error)) {
      if (inputs.size() == 1) return openFolder(input, options);
      throw InputError(input + ": is a folder; only bags can be given several at once");
    }
    if (fs::path(input).extension() == ".pcd") {
      throw InputError(input + ": is a single cloud without the scans it was made of; " +
                       kExpected);
    }
  }
  return std::make_unique<RosbagSource>(inputs, options);
}

}  // namespace beautymap
