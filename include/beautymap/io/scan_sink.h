// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "beautymap/io/scan_source.h"

namespace beautymap {

/// Where scans are written to. The output appears under its name only when close() succeeded;
/// without it, everything written is removed again.
class ScanSink {
 public:
  virtual ~ScanSink() = default;
  /// @throws InputError when it cannot be written (disk full).
  virtual void write(const SourceScan& scan) = 0;
  virtual void close() = 0;
};

struct SinkOptions {
  std::string cloud_topic = "/cloud";  ///< bags only
  std::string map_frame = "map";       ///< bags only
  std::string sensor_frame = "lidar";  ///< bags only
};

/// A path that ends in .bag: PointCloud2 in the sensor frame, /tf and /odom; scans without a stamp
/// get 1.0 s, 1.1 s, ... Any other path: a PCD folder in the dynamic-map benchmark's layout
/// (pcd/NNNNNN.pcd in the map frame with the sensor's pose in VIEWPOINT, gt_cloud.pcd where the
/// scans have a `label` field), x y z in float32, or in float64 where float32 would be coarser than
/// 1 mm. A `label` that means "not moving" to the source is written as 0, so that what is read back
/// has the same moving points (see ScanSource::isMoving).
/// @param source  must outlive the sink
/// @throws InputError when the path cannot be written, or is a folder that is not empty.
std::unique_ptr<ScanSink> openScanSink(const std::string& path, const SinkOptions& options,
                                       const ScanSource& source);

}  // namespace beautymap
