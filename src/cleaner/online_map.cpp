// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/cleaner/online_map.h"

#include <algorithm>
#include <utility>

#include "beautymap/base/two_threads.h"
#include "beautymap/cleaner/make_judgement.h"
#include "beautymap/ground/coarse_ground.h"
#include "beautymap/ground/ground_anchor.h"
#include "beautymap/matrix/binary_encoding.h"

namespace beautymap {
namespace {

// Lowest heights fall by millimetres in every scan: not a reason to estimate the ground again.
constexpr float kNoticeable = 0.02F;  // [m]

const Config& checked(const Config& config) {
  if (!config.coarse_ground.enabled) {
    throw ConfigError(
        "coarse_ground.enabled = false: the lowest point of a map that grows is not known");
  }
  return config;
}

}  // namespace

OnlineMap::OnlineMap(const Config& config)
    : config_(checked(config)),
      judgement_(makeJudgement(config)),
      map_(judgement_->newMap()),
      findings_(judgement_->newFindings()) {}

const std::vector<PointClass>& OnlineMap::addHits(const Scan& scan) {
  StageClock clock(times_);
  const double z_origin = z_origin_.value_or(scan.sensor_in_map.z());
  placed_ =
      placeScan(scan, z_origin, config_.matrix.res_g, config_.scan, dropped_, std::move(placed_));
  z_origin_ = z_origin;
  clock.lap("placing");
  judgement_->place(placed_, clock);
  if (config_.levelling.enabled) {
    const auto lows = lowestOfColumns(placed_, config_.levelling.radius);
    addLevels(map_, placed_.anchor, lows);
    level(placed_, lows);
    clock.lap("levelling");
  }
  addLowest();
  updateGround();
  clock.lap("coarse_ground");
  judgement_->addHits(map_, placed_, *findings_, clock);
  settle();
  clock.lap("agreement");
  judgement_->classifyLatest(map_, placed_, *findings_, classes_);
  clock.lap("classifying");
  return classes_;
}

void OnlineMap::level(PlacedScan& placed, const std::vector<ColumnLow>& lows) const {
  applyLevelling(findLevelling(map_, placed.anchor, lows, config_.matrix.res_g, config_.levelling),
                 placed);
}

void OnlineMap::addLowest() {
  TileCursor<TileMap> tile_of(map_);
  for (const ColumnRun& run : placed_.runs) {
    const ColumnIndex column{placed_.anchor.x + run.x, placed_.anchor.y + run.y};
    float& lowest = tile_of(column)->lowest[static_cast<std::size_t>(TileMap::indexInTile(column))];
    if (run.lowest >= lowest) continue;
    if (lowest - run.lowest > kNoticeable) lowered_.push_back(column);
    lowest = run.lowest;
  }
}

void OnlineMap::updateGround() {
  // Not to the wide radius: a quantile of so many columns hardly moves with one of them.
  const int r = config_.coarse_ground.radius;
  std::vector<ColumnIndex> stale;
  for (const ColumnIndex column : lowered_) {
    const ColumnIndex corner{column.x - r, column.y - r};
    forEachColumn(map_, {corner, 2 * r + 1}, [&](int x, int y, Tile& tile, std::size_t near) {
      if (tile.stale_ground[near]) return;
      if (tile.stale_ground.none()) {
        stale.push_back(TileMap::tileOf({corner.x + x, corner.y + y}));
      }
      tile.stale_ground[near] = true;
    });
  }
  lowered_.clear();
  inTwoThreads(stale.size(),
               [&](std::size_t i) { estimateStaleGround(stale[i], *map_.findTile(stale[i])); });
}

void OnlineMap::estimateStaleGround(ColumnIndex index, Tile& tile) {
  const CoarseGroundConfig& config = config_.coarse_ground;
  const int margin = coarseGroundMargin(config);
  const HeightGrid lowest =
      map_.extract(TileMap::windowOf(index, 1, margin), &Tile::lowest, Tile::kNoHeight);
  const float below = depthBelowGround(config_.matrix);
  const auto anchor = [&](std::size_t column, float ground) {
    if (!judgement_->anchor(tile, column, ground - below)) return;
    tile.unsettled = true;
    ++tile.revision;
  };
  std::bitset<Tile::kColumns> has_ground;
  std::vector<float> neighbours;
  for (std::size_t column = 0; column < Tile::kColumns; ++column) {
    if (tile.lowest[column] == Tile::kNoHeight || judgement_->hangsOverFreeSpace(tile, column)) {
      continue;
    }
    has_ground.set(column);
    if (!tile.stale_ground[column]) continue;
    const int x = static_cast<int>(column) >> Tile::kShift;
    const int y = static_cast<int>(column) & (Tile::kSide - 1);
    const GroundEstimate estimate =
        coarseGroundAt(lowest, x + margin, y + margin, neighbours, config);
    tile.below_ground[column] = estimate.below_ground ? 1 : 0;
    // A column that was seen through a gap, beside others of which only a ceiling was seen yet,
    // must not be lifted over its points: what lies below its bits is in no cell. As published,
    // outliers are to lie there.
    const float most =
        config_.matrix.bits_below > 0 ? tile.lowest[column] + below : Tile::kNoHeight;
    anchor(column, std::min(estimate.height, most));
  }
  tile.stale_ground.reset();
  const auto others = groundOfOtherColumns(tile, has_ground);
  for (std::size_t column = 0; column < Tile::kColumns; ++column) {
    // A column that holds points moves down only, so that they stay in cells.
    const bool lifts =
        tile.lowest[column] != Tile::kNoHeight && others[column] >= tile.ground[column];
    if (others[column] == Tile::kNoHeight || lifts) continue;
    // The nearest column's bottom, which lies below its ground already.
    anchor(column, others[column] + below);
  }
}

void OnlineMap::addSeenFree() {
  StageClock clock(times_);
  const auto no_ground = judgement_->addSeenFree(map_, placed_, *findings_, clock);
  lowered_.insert(lowered_.end(), no_ground.begin(), no_ground.end());
  // Nothing of a scan may wait for the next one: the tiles may be stored before.
  updateGround();
  clock.lap("coarse_ground");
}

void OnlineMap::settle() {
  std::vector<ColumnIndex> changed;
  map_.forEachTile([&](ColumnIndex index, Tile& tile) {
    if (tile.unsettled) changed.push_back(index);
    tile.unsettled = false;
  });
  judgement_->settle(map_, changed);
}

std::vector<PointClass> OnlineMap::classify(const Scan& scan) const {
  DroppedPoints dropped;
  PlacedScan placed = placeScan(scan, zOrigin(), config_.matrix.res_g, config_.scan, dropped);
  if (config_.levelling.enabled) level(placed, lowestOfColumns(placed, config_.levelling.radius));
  std::vector<PointClass> classes;
  judgement_->classify(map_, placed, classes);
  return classes;
}

}  // namespace beautymap
