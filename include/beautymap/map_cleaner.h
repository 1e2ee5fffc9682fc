// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "beautymap/beam_visibility.h"
#include "beautymap/binary_encoding.h"
#include "beautymap/config.h"
#include "beautymap/map_judgement.h"
#include "beautymap/scan.h"
#include "beautymap/sight_mask.h"
#include "beautymap/stage_times.h"
#include "beautymap/tile_map.h"

namespace beautymap {

enum class PointClass : std::uint8_t {
  kStatic,
  kDynamic,
  kDropped,  ///< not part of the map: not finite, zero, or out of range
};

/// Removes what moved from a map that is given as registered scans: BeautyMap as published (RA-L
/// 2024). The same scans are handed in once per phase, in any order within a phase (the height of
/// the first scan's sensor is where z counts from, so another order may round points on a cell's
/// border otherwise):
///
///   observe(scan)...   lowest heights      -> estimateGround()
///   encode(scan)...    M_map
///   compare(scan)...   M_dyn of each scan  -> segmentGround()
///   classify(scan)     static or dynamic, per point
///
/// Memory grows with the mapped area, not with the number of points.
class MapCleaner {
 public:
  /// @throws ConfigError when the configuration contradicts itself.
  explicit MapCleaner(const Config& config);

  // Each takes a scan whose pose is finite; std::invalid_argument otherwise, the map is then
  // unchanged.
  void observe(const Scan& scan);
  void estimateGround();
  void encode(const Scan& scan);
  void compare(const Scan& scan);
  void segmentGround();

  /// One class per point of the scan's cloud.
  std::vector<PointClass> classify(const Scan& scan);

  const Config& config() const { return config_; }
  const TileMap& map() const { return map_; }
  /// Points dropped while observing.
  const DroppedPoints& dropped() const { return dropped_; }
  /// Time of each stage over all scans.
  const StageTimes& times() const { return times_; }
  /// Height of the map frame [m] that the map's heights count from.
  double zOrigin() const { return z_origin_.value_or(0.0); }

 private:
  const PlacedScan& place(const Scan& scan);
  MapWindow windowAround(const PlacedScan& scan) const;
  /// The published judgement of one scan: every candidate it leaves is dynamic.
  void findDynamic(const PlacedScan& scan, const MapWindow& map, const BitGrid& scan_bits);
  /// What one scan saw, for a judgement over all scans.
  void gatherEvidence(const PlacedScan& scan, const MapWindow& map, const BitGrid& scan_bits);

  Config config_;
  BinaryEncoding encoding_;
  MapJudgement judgement_;
  TileMap map_;
  std::optional<BeamImage> beams_;  ///< large, and only evidence needs it
  DroppedPoints dropped_;
  PlacedScan placed_;  ///< the scan at hand; a member so that its memory is used again
  StageTimes times_;
  std::optional<double> z_origin_;
};

}  // namespace beautymap
