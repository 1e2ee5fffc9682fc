// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "beautymap/io/scan_source.h"
#include "odometry_history.h"
#include "tf_history.h"

namespace beautymap {

/// Where a recording's scans were taken: from tf, or from odometry.
class ScanPoses {
 public:
  virtual ~ScanPoses() = default;

  /// Fills in T_map_cloud and T_map_sensor of a cloud that was taken at a time.
  /// @return false where they are not known; `reason` then says what is missing
  virtual bool find(const std::string& cloud_frame, std::uint64_t stamp_ns, SourceScan& scan,
                    std::string& reason) = 0;
  /// What is known instead and the likely cure, after find() returned false.
  virtual std::string explain(const std::string& cloud_frame, std::uint64_t stamp_ns) const = 0;
  virtual std::vector<std::string> describe() const = 0;
};

/// @param cloud_frame  of the first cloud
/// @throws InputError when the map frame cannot be chosen, a named frame does not exist, or it is
/// not known where the sensor of registered clouds is.
std::unique_ptr<ScanPoses> posesFromTf(TfHistory tf, const SourceOptions& options,
                                       const std::string& cloud_frame);

/// @param tf  static transforms between the odometry's child frame and the sensor; may be empty
/// @throws InputError as posesFromTf.
std::unique_ptr<ScanPoses> posesFromOdometry(OdometryHistory odometry, TfHistory tf,
                                             const SourceOptions& options,
                                             const std::string& cloud_frame);

}  // namespace beautymap
