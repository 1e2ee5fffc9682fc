// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/cleaner/map_cleaner.h"

#include <cmath>
#include <utility>

#include "beautymap/cleaner/make_judgement.h"
#include "beautymap/ground/coarse_ground.h"

namespace beautymap {

MapCleaner::MapCleaner(const Config& config)
    : config_(config),
      judgement_(makeJudgement(config)),
      passes_(judgement_->passes()),
      map_(judgement_->newMap()) {}

void MapCleaner::startAt(const Eigen::Vector3d& sensor_in_map) {
  if (!z_origin_ && std::isfinite(sensor_in_map.z())) z_origin_ = sensor_in_map.z();
}

void MapCleaner::place(const Scan& scan, ScanView& view) const {
  view.times = {};
  StageClock clock(view.times);
  view.dropped = {};
  view.levelling.reset();
  view.placed = placeScan(scan, zOrigin(), config_.matrix.res_g, config_.scan, view.dropped,
                          std::move(view.placed));
  clock.lap("placing");
  judgement_->place(view.placed, clock);
}

void MapCleaner::observe(const Scan& scan) {
  startAt(scan.sensor_in_map);
  place(scan, view_);
  observe(view_);
}

void MapCleaner::observe(ScanView& view) {
  times_.add(view.times);
  StageClock clock(times_);
  dropped_ += view.dropped;
  if (config_.levelling.enabled) {
    // Against what is known so far: good enough for the lowest heights, which the ground comes
    // from.
    const auto lows = lowestOfColumns(view.placed, config_.levelling.radius);
    addLevels(map_, view.placed.anchor, lows);
    level(view, lows);
    clock.lap("levelling");
  }
  judgement_->observe(map_, view.placed);
  clock.lap("coarse_ground");
}

void MapCleaner::level(ScanView& view) const {
  view.levelling = Levelling();
  if (!config_.levelling.enabled) return;
  StageClock clock(view.times);
  level(view, lowestOfColumns(view.placed, config_.levelling.radius));
  clock.lap("levelling");
}

void MapCleaner::level(ScanView& view, const std::vector<ColumnLow>& lows) const {
  view.levelling =
      findLevelling(map_, view.placed.anchor, lows, config_.matrix.res_g, config_.levelling);
  applyLevelling(*view.levelling, view.placed);
}

void MapCleaner::estimateGround() {
  StageClock clock(times_);
  estimateCoarseGround(map_, config_.coarse_ground);
  const float below = depthBelowGround(config_.matrix);
  map_.forEachTile([&](ColumnIndex, Tile& tile) {
    for (float& ground : tile.ground) ground -= below;
  });
  judgement_->useGround(map_);
  clock.lap("coarse_ground");
}

void MapCleaner::add(const JudgementPass& pass, const Scan& scan) {
  place(scan, view_);
  addTimes(view_);
  look(pass, view_);
  add(pass, view_);
}

void MapCleaner::look(const JudgementPass& pass, ScanView& view) const {
  view.times = {};
  if (!view.levelling) level(view);
  if (!view.findings) view.findings = judgement_->newFindings();
  StageClock clock(view.times);
  if (pass.look) pass.look(map_, view.placed, *view.findings, clock);
}

void MapCleaner::add(const JudgementPass& pass, const ScanView& view) {
  times_.add(view.times);
  StageClock clock(times_);
  pass.add(map_, view.placed, *view.findings, clock);
}

void MapCleaner::conclude(const JudgementPass& pass) {
  StageClock clock(times_);
  if (pass.conclude) pass.conclude(map_, clock);
}

std::vector<PointClass> MapCleaner::classify(const Scan& scan) {
  std::vector<PointClass> classes;
  place(scan, view_);
  level(view_);
  addTimes(view_);
  classify(view_, classes);
  addTimes(view_);
  return classes;
}

void MapCleaner::classify(ScanView& view, std::vector<PointClass>& classes) const {
  view.times = {};
  StageClock clock(view.times);
  judgement_->classify(map_, view.placed, classes);
  clock.lap("classifying");
}

}  // namespace beautymap
