// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "beautymap/base/stage_times.h"
#include "beautymap/config/config.h"
#include "beautymap/evidence/beam_visibility.h"
#include "beautymap/evidence/map_judgement.h"
#include "beautymap/ground/scan_levelling.h"
#include "beautymap/matrix/binary_encoding.h"
#include "beautymap/matrix/scan.h"
#include "beautymap/matrix/tile_map.h"
#include "beautymap/published/sight_mask.h"

namespace beautymap {

/// What one scan says about the map, and the memory to find it out; used again for other scans.
struct ScanView {
  PlacedScan placed;
  DroppedPoints dropped;
  Levelling levelling;  ///< how the placed scan was moved
  MapWindow map;  ///< the map around the sensor; evidence has possible cells for occupied ones
  BitGrid hit;    ///< cells around the sensor that the scan hit
  /// Evidence: cells that it saw free. Published method: the map's cells that it finds dynamic.
  BitGrid free;
  BitGrid few;                     ///< evidence: cells that too few beams passed
  StageTimes times;                ///< of the last of place(), look() and classify()
  std::optional<BeamImage> beams;  ///< large, and only evidence needs it
};

/// Removes what moved from a map that is given as registered scans: BeautyMap as published (RA-L
/// 2024), or by evidence over all scans. The same scans are handed in once per phase:
///
///   observe(scan)...   heights of the columns       -> estimateGround()
///   encode(scan)...    M_map; not with evidence, which finds it while comparing
///   compare(scan)...   M_dyn or evidence per scan   -> segmentGround()
///   measureFloors(scan)...  heights on surfaces above the ground, only with evidence
///                                                   -> segmentFloors()
///   classify(scan)     static or dynamic, per point
///
/// Evidence needs observe() and compare() in the order of time. Otherwise any order will do within
/// a phase (the height of the first scan's sensor is where z counts from, so another order may
/// round points on a cell's border otherwise). What a phase computes without changing the map,
/// place(), look() and classify(), is const and may run in threads beside the phase's other calls.
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
  bool needsEncoding() const { return !config_.evidence.enabled; }
  void encode(const Scan& scan);
  void compare(const Scan& scan);
  void segmentGround();
  bool needsFloors() const { return judgement_.usesFloors(); }
  void measureFloors(const Scan& scan);
  void segmentFloors();

  /// One class per point of the scan's cloud.
  std::vector<PointClass> classify(const Scan& scan);

  // The same in parts, so that a scan is placed once, before it is observed: the later phases take
  // it from where it was kept (measureFloors() and classify() need no x and y, the published method
  // only in place()). startAt() must know the first scan's sensor before.
  void startAt(const Eigen::Vector3d& sensor_in_map);
  void place(const Scan& scan, ScanView& view) const;
  void observe(ScanView& view);
  void encode(const ScanView& view);
  /// Levels the scan, too: the later phases take it so, or view.levelling is applied to it again.
  void look(ScanView& view) const;
  void add(const ScanView& view);
  void measureFloors(const ScanView& view);
  void classify(ScanView& view, std::vector<PointClass>& classes) const;
  /// Counts a view's times, which observe() and add() do by themselves.
  void addTimes(const ScanView& view) { times_.add(view.times); }

  const Config& config() const { return config_; }
  const TileMap& map() const { return map_; }
  /// Points dropped while observing.
  const DroppedPoints& dropped() const { return dropped_; }
  /// Time of each stage over all scans.
  const StageTimes& times() const { return times_; }
  /// Height of the map frame [m] that the map's heights count from.
  double zOrigin() const { return z_origin_.value_or(0.0); }

 private:
  bool levels() const { return config_.evidence.enabled && config_.levelling.enabled; }
  /// Brings a placed scan's ground to that of all scans, see scan_levelling.h.
  void level(ScanView& view) const;
  void level(ScanView& view, const std::vector<ColumnLow>& lows) const;
  void placeLevelled(const Scan& scan);
  /// When a tile's ground is known: the cells that can be judged by evidence.
  void findPossibleCells(Tile& tile) const;
  /// The published judgement of one scan: every candidate it leaves is dynamic.
  void findDynamic(ScanView& view) const;
  /// What one scan saw, for a judgement over all scans.
  void findFree(ScanView& view) const;
  void addEvidence(const ScanView& view);

  Config config_;
  BinaryEncoding encoding_;
  HeightBins height_bins_;
  MapJudgement judgement_;
  TileMap map_;
  DroppedPoints dropped_;
  ScanView view_;  ///< of the scan at hand; a member so that its memory is used again
  StageTimes times_;
  std::optional<double> z_origin_;
};

}  // namespace beautymap
