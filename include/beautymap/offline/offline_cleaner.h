// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "beautymap/base/stage_times.h"
#include "beautymap/config/config.h"
#include "beautymap/evaluation/evaluation.h"
#include "beautymap/io/scan_source.h"
#include "beautymap/matrix/scan.h"
#include "beautymap/matrix/up_direction.h"

namespace beautymap {

struct OfflineOptions {
  std::string output;    ///< folder for the cleaned map, the report and the pictures
  double voxel_m = 0.0;  ///< keep the first point per cube of this side; 0: every point
  double score_radius_m = 0.05;
};

/// What was done, for the report and the user.
struct OfflineReport {
  std::size_t scans = 0;
  std::uint64_t points = 0;  ///< of the scans used, as they came
  std::uint64_t static_points = 0;
  std::uint64_t dynamic_points = 0;
  std::map<std::string, Skipped> skipped_scans;
  DroppedPoints dropped_points;
  StageTimes stages;     ///< time of each stage over all scans [ms]
  double seconds = 0.0;  ///< whole run
  double peak_memory_mb = 0.0;
  UpDirection up;
  double cell_size_m = 0.0;  ///< horizontally: matrix.res_g or room_res_g
  double matrix_memory_mb = 0.0;
  std::size_t tiles = 0;
  bool float64_coordinates = false;
  std::optional<Score> score;  ///< where the scans have labels
};

/// Told at the begin of each pass over the scans (its name and number of scans), and after each
/// scan.
struct ProgressListener {
  std::function<void(const std::string& pass, std::size_t scans)> begin;
  std::function<void()> step;
};

/// Cleans the map that the scans make and writes it: cleaned.pcd, dynamic.pcd, report.json,
/// before.png, after.png, matrix.png and, with labels, mistakes.png. The source is read once; later
/// passes read a temporary file in the output folder.
/// @throws InputError when no scan can be used or the output cannot be written; unfinished files
/// are removed.
OfflineReport cleanOffline(ScanSource& source, const Config& config, const OfflineOptions& options,
                           const ProgressListener& progress);

/// The report as JSON text.
std::string toJson(const OfflineReport& report, const Config& config);

}  // namespace beautymap
