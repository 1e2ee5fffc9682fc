// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/PCLPointCloud2.h>
#include <tbb/enumerable_thread_specific.h>

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "beautymap/cleaner/map_cleaner.h"
#include "beautymap/evaluation/evaluation.h"
#include "beautymap/io/moving_labels.h"
#include "beautymap/io/scan_source.h"
#include "beautymap/offline/offline_cleaner.h"
#include "beautymap/offline/pictures.h"
#include "point_file.h"

namespace beautymap {

/// What a scan adds to the map that is written. Its memory is used again for later scans.
struct ScanOutput {
  /// What becomes of a point without one of its own in the cleaned map is found by searching.
  struct Unmatched {
    Eigen::Vector3d position;
    bool moving;
  };
  /// Points of one class.
  struct Part {
    std::uint64_t points = 0;
    std::vector<std::uint8_t> records;  ///< of those that are written
  };

  pcl::PCLPointCloud2 in_map;  ///< all fields, x y z in the map frame
  std::vector<PointClass> classes;
  std::vector<PointLabel> labels;  ///< empty without
  Part kept, removed;
  std::uint64_t kept_static = 0, kept_moving = 0;  ///< labelled points that cleaned.pcd holds
  std::vector<Unmatched> unmatched;                ///< the other labelled ones
  StageTimes times;
};

/// Writes the judged map: cleaned.pcd, dynamic.pcd and the pictures, and scores it.
class MapWriter {
 public:
  /// @param cleaner   has judged the map
  /// @param source    says what the labels mean
  /// @param labelled  whether all scans have labels
  /// @param report    gets what was written
  MapWriter(const MapCleaner& cleaner, const ScanSource& source, bool labelled,
            const OfflineOptions& options, OfflineReport& report);

  /// Finds what becomes of a scan's points; several threads may do so at once.
  /// @param scan  as it came; its points' memory is taken
  void prepare(ScanView& view, SourceScan& scan, ScanOutput& output);
  /// For each scan, in their order.
  void write(ScanOutput& output);
  /// After the last scan.
  void finish();

 private:
  struct Block;

  /// Whether a point is written depends on those of the scans before.
  bool thins() const { return options_.voxel_m > 0.0; }
  void split(ScanOutput& output);
  void splitRun(const Block& block, std::size_t first, std::size_t last, TopView& top_view,
                ScanOutput& output);
  void put(const Block& block, std::size_t first, std::size_t last, bool written,
           ScanOutput& output) const;
  void score();
  void writePictures() const;

  const MapCleaner& cleaner_;
  const ScanSource& source_;
  const bool labelled_;
  const OfflineOptions& options_;
  OfflineReport& report_;
  PointFile cleaned_, dynamic_;
  Evaluator evaluator_;
  Eigen::Isometry3d T_level_map_;  ///< for the top view
  TopView top_view_;
  tbb::enumerable_thread_specific<TopView> top_views_;  ///< of each thread, until finish()
};

}  // namespace beautymap
