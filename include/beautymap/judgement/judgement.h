// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "beautymap/base/stage_times.h"
#include "beautymap/matrix/binary_encoding.h"
#include "beautymap/matrix/scan.h"
#include "beautymap/matrix/tile_map.h"

namespace beautymap {

enum class PointClass : std::uint8_t {
  kStatic,
  kDynamic,
  kDropped,  ///< not part of the map: not finite, zero, or out of range
};

/// What a judgement finds out about one scan, and the memory for it; used again for other scans.
class ScanFindings {
 public:
  virtual ~ScanFindings() = default;
};

/// One pass over the scans of a finished map.
struct JudgementPass {
  std::string name;       ///< "comparing", for a user who waits
  bool needs_xy = false;  ///< of the points, not only their columns and heights
  /// What a scan says; changes nothing and runs for several scans at once. May be empty.
  std::function<void(const TileMap&, const PlacedScan&, ScanFindings&, StageClock&)> look;
  /// Adds it to the map, in the order of the scans.
  std::function<void(TileMap&, const PlacedScan&, const ScanFindings&, StageClock&)> add;
  /// After the last scan. May be empty.
  std::function<void(TileMap&, StageClock&)> conclude;
};

/// How a map is judged: what a scan says about it, what is remembered of it in each column, and
/// which points go. MapCleaner and OnlineMap own the map and call, in the order that stands here.
class Judgement {
 public:
  virtual ~Judgement() = default;

  /// An empty map whose tiles hold what this judgement remembers.
  virtual TileMap newMap() const = 0;
  virtual std::unique_ptr<ScanFindings> newFindings() const = 0;

  /// Notes what a scan's beams say all together, while the scan is placed.
  virtual void place(PlacedScan&, StageClock&) const {}

  // --- A map of which all scans are known
  /// The heights of its columns; lowest ones at least.
  virtual void observe(TileMap& map, const PlacedScan& scan) const;
  /// When the ground of all columns is known.
  virtual void useGround(TileMap&) const {}
  /// Then, in this order. The passes refer to the judgement.
  virtual std::vector<JudgementPass> passes() const = 0;

  // --- A map that grows, scan by scan
  /// Adds what a scan hit. The columns' ground is as good as it is known.
  virtual void addHits(TileMap& map, const PlacedScan& scan, ScanFindings& found,
                       StageClock& clock) const = 0;
  /// Judges what changed. Counts up the revision of tiles whose points may be judged otherwise.
  virtual void settle(TileMap& map, const std::vector<ColumnIndex>& changed) const = 0;
  /// The classes of the latest scan's points: by what was known before, and by the scan itself.
  virtual void classifyLatest(const TileMap& map, const PlacedScan& scan, ScanFindings&,
                              std::vector<PointClass>& classes) const {
    classify(map, scan, classes);
  }
  /// Adds what the same scan saw free.
  /// @return  columns whose lowest points turned out to be no ground
  virtual std::vector<ColumnIndex> addSeenFree(TileMap& map, const PlacedScan& scan,
                                               ScanFindings& found, StageClock& clock) const = 0;
  /// Whether the lowest points of a column hang in the air, as of a ceiling or a roof.
  virtual bool hangsOverFreeSpace(const Tile&, std::size_t) const { return false; }
  /// Brings the bottom of a column to an estimate [m], and what is known of its cells with it.
  /// @return  whether its points may lie in other cells now
  virtual bool anchor(Tile& tile, std::size_t column, float bottom) const = 0;

  // --- At any time
  /// Whether a point of a column is removed.
  /// @param z  its height [m] above the map's z origin
  virtual bool isDynamic(const Tile& tile, std::size_t column, float z) const = 0;
  /// Sets one class per point of the scan's cloud.
  virtual void classify(const TileMap& map, const PlacedScan& scan,
                        std::vector<PointClass>& classes) const = 0;
};

/// Sets one class per point of a scan's cloud, run by run.
/// @param is_dynamic  (tile, column, z): from some height of a cell on all its points are, or none
template <typename IsDynamic>
void classifyRuns(const TileMap& map, const PlacedScan& scan, const BinaryEncoding& encoding,
                  std::vector<PointClass>& classes, IsDynamic is_dynamic) {
  if (scan.isWhole()) {
    classes.assign(scan.cloud_size, PointClass::kStatic);
  } else {
    classes.assign(scan.cloud_size, PointClass::kDropped);
    for (const std::uint32_t source : scan.source_index) classes[source] = PointClass::kStatic;
  }
  forEachTileRun(map, scan, [&](const Tile* tile, std::size_t column, const ColumnRun& run) {
    // Most columns have no dynamic cell: nothing of them is removed.
    if (tile == nullptr || tile->dynamic[column] == 0) return;
    const float ground = tile->ground[column];
    const bool highest = is_dynamic(*tile, column, run.highest);
    const bool alike =
        encoding.bitIndex(run.lowest, ground) == encoding.bitIndex(run.highest, ground) &&
        is_dynamic(*tile, column, run.lowest) == highest;
    if (alike && !highest) return;
    for (std::uint32_t i = run.begin; i < run.end; ++i) {
      if (alike || is_dynamic(*tile, column, scan.z[i])) {
        classes[scan.sourceOf(i)] = PointClass::kDynamic;
      }
    }
  });
}

}  // namespace beautymap
