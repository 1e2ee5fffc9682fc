// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mutex>
#include <string>

#include "beautymap/io/scan_source.h"
#include "beautymap/io/scan_spool.h"
#include "beautymap/online/pose_correction.h"

namespace beautymap {

/// All scans of a map in a temporary file, so that it can be made again with corrected poses. Scans
/// may be appended while others are read.
class ScanLog {
 public:
  /// @throws InputError when no file can be made in the folder.
  explicit ScanLog(const std::string& folder) : spool_(folder) {}

  /// @return false for a scan with other fields than the first one's, which is not kept
  /// @throws InputError when the disk is full.
  bool append(const SourceScan& scan);
  /// Reads from the first scan on.
  void rewind();
  /// The next scan, with the pose that setPose() gave it; false when there is none (yet).
  bool next(SourceScan& scan);
  /// T_map_sensor of all scans, as they are in the map.
  StampedPoses poses() const;
  /// Moves the poses of the scans that are there now.
  void correct(const PoseCorrection& correction);
  std::size_t size() const;

 private:
  mutable std::mutex mutex_;
  ScanSpool spool_;
  StampedPoses poses_;                    ///< T_map_sensor in use
  std::vector<Eigen::Isometry3d> moves_;  ///< of each scan, since it was appended
  std::vector<std::uint64_t> stamps_;
  std::size_t read_ = 0;
};

}  // namespace beautymap
