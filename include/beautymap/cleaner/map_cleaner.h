// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
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

/// A placed scan, what is found out about it, and the memory for that; used again for other scans.
struct ScanView {
  PlacedScan placed;
  DroppedPoints dropped;
  std::optional<Levelling> levelling;  ///< how the placed scan was moved; none: not yet
  StageTimes times;                    ///< of the last of place(), look() and classify()
  std::unique_ptr<ScanFindings> findings;
};

/// Removes what moved from a map that is given as registered scans. The same scans are handed in
/// once per phase:
///
///   observe(scan)...       heights of the columns   -> estimateGround()
///   for each of passes():
///     add(pass, scan)...   what the judgement asks for, as M_map, M_dyn or evidence
///                                                   -> conclude(pass)
///   classify(scan)         static or dynamic, per point
///
/// observe() and add() need the scans in the order of time, though the published judgement takes
/// any order within a phase (the height of the first scan's sensor is where z counts from, so
/// another order may round points on a cell's border otherwise). What a phase computes without
/// changing the map, place(), look() and classify(), is const and may run in threads beside the
/// phase's other calls.
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
  const std::vector<JudgementPass>& passes() const { return passes_; }
  void add(const JudgementPass& pass, const Scan& scan);
  void conclude(const JudgementPass& pass);
  /// One class per point of the scan's cloud.
  std::vector<PointClass> classify(const Scan& scan);

  // The same in parts, so that a scan is placed once, before it is observed: the later phases take
  // it from where it was kept (without x and y where no pass needs them). startAt() must know the
  // first scan's sensor before.
  void startAt(const Eigen::Vector3d& sensor_in_map);
  void place(const Scan& scan, ScanView& view) const;
  void observe(ScanView& view);
  /// Levels the scan first, unless view.levelling says that it is: the later phases take it so.
  void look(const JudgementPass& pass, ScanView& view) const;
  void add(const JudgementPass& pass, const ScanView& view);
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
  /// Brings a placed scan's ground to that of all scans, see scan_levelling.h.
  void level(ScanView& view) const;
  void level(ScanView& view, const std::vector<ColumnLow>& lows) const;

  Config config_;
  std::unique_ptr<const Judgement> judgement_;
  std::vector<JudgementPass> passes_;
  TileMap map_;
  DroppedPoints dropped_;
  ScanView view_;  ///< of the scan at hand; a member so that its memory is used again
  StageTimes times_;
  std::optional<double> z_origin_;
};

/// All phases before classify().
/// @param for_each_scan  calls its argument with each scan, in the order of time
template <typename ForEachScan>
void cleanMap(MapCleaner& cleaner, ForEachScan for_each_scan) {
  for_each_scan([&](const Scan& scan) { cleaner.observe(scan); });
  cleaner.estimateGround();
  for (const JudgementPass& pass : cleaner.passes()) {
    for_each_scan([&](const Scan& scan) { cleaner.add(pass, scan); });
    cleaner.conclude(pass);
  }
}

}  // namespace beautymap
