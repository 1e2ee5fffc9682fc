// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "beautymap/base/stage_times.h"
#include "beautymap/config/config.h"
#include "beautymap/ground/scan_levelling.h"
#include "beautymap/judgement/judgement.h"
#include "beautymap/matrix/scan.h"
#include "beautymap/matrix/tile_map.h"

namespace beautymap {

/// The matrix of a map that grows: one pass over the scans, in the order of time, with a judgement
/// at any moment. What differs from MapCleaner, which knows the finished map: a column's ground is
/// provisional, its cells are anchored again when it moves; and cells are remembered as seen free
/// before anything was in them, so that an object that enters them is dynamic at once.
///
///   addHits(scan)   ground, occupancy, hits  -> the class of each of its points, from what was
///                                               known before and from the scan itself
///   addSeenFree()   what that scan saw free; may follow after the classes are published
///
/// Memory grows with the mapped area. Uses a second thread itself, but is not thread-safe.
class OnlineMap {
 public:
  /// @throws ConfigError when the configuration contradicts itself, or is without coarse ground,
  /// which a map that grows needs.
  explicit OnlineMap(const Config& config);

  /// @return one class per point of the scan's cloud; valid until the next call
  /// @throws std::invalid_argument when the pose is not finite; the map is then unchanged.
  const std::vector<PointClass>& addHits(const Scan& scan);
  void addSeenFree();

  /// Judges the tiles that changed. Between calls of add...() and this, isDynamic() knows the
  /// state before; a tile's revision becomes another one when its points may be judged otherwise.
  void settle();
  bool isDynamic(const Tile& tile, std::size_t column, float z) const {
    return judgement_->isDynamic(tile, column, z);
  }
  /// What the map says, as of settle(), about the points of any scan.
  /// @return one class per point of its cloud
  std::vector<PointClass> classify(const Scan& scan) const;

  const Config& config() const { return config_; }
  const TileMap& map() const { return map_; }
  TileMap& map() { return map_; }
  /// The usable points of the last scan.
  const PlacedScan& placed() const { return placed_; }
  const DroppedPoints& dropped() const { return dropped_; }
  const StageTimes& times() const { return times_; }
  /// Height of the map frame [m] that the map's heights count from; the first sensor's.
  double zOrigin() const { return z_origin_.value_or(0.0); }
  /// Continues a map whose heights count from another height; before the first scan.
  void setZOrigin(double z_origin) { z_origin_ = z_origin; }

 private:
  /// Brings a placed scan's ground to that of the scans before it, see scan_levelling.h.
  void level(PlacedScan& placed, const std::vector<ColumnLow>& lows) const;
  void addLowest();
  void updateGround();
  void estimateStaleGround(ColumnIndex index, Tile& tile);

  Config config_;
  std::unique_ptr<const Judgement> judgement_;
  TileMap map_;
  DroppedPoints dropped_;
  StageTimes times_;
  std::optional<double> z_origin_;
  PlacedScan placed_;  ///< the last scan
  std::unique_ptr<ScanFindings> findings_;
  std::vector<PointClass> classes_;
  /// Columns whose lowest height fell, or whose ground was seen to be none.
  std::vector<ColumnIndex> lowered_;
};

}  // namespace beautymap
