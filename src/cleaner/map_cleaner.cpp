// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/cleaner/map_cleaner.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "beautymap/ground/coarse_ground.h"
#include "beautymap/published/matrix_comparison.h"
#include "beautymap/published/reverse_ray_casting.h"

namespace beautymap {

MapCleaner::MapCleaner(const Config& config)
    : config_((checkConfig(config), config)),
      encoding_(config.matrix),
      height_bins_(config.matrix),
      judgement_(config),
      map_(judgement_.fineBins()) {}

void MapCleaner::startAt(const Eigen::Vector3d& sensor_in_map) {
  if (!z_origin_ && std::isfinite(sensor_in_map.z())) z_origin_ = sensor_in_map.z();
}

void MapCleaner::place(const Scan& scan, ScanView& view) const {
  view.times = {};
  StageClock clock(view.times);
  view.dropped = {};
  view.placed = placeScan(scan, zOrigin(), config_.matrix.res_g, config_.scan, view.dropped,
                          std::move(view.placed));
  clock.lap("placing");
  if (!needsEncoding() || !config_.restoration.enabled) return;
  view.placed.steepest_slope = steepestSlope(view.placed, config_.restoration.steepest_share);
  clock.lap("sight_mask");
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
  if (levels()) {
    // Against what is known so far: good enough for the lowest heights, which the ground comes
    // from.
    const auto lows = lowestOfColumns(view.placed, config_.levelling.radius);
    addLevels(map_, view.placed.anchor, lows);
    level(view, lows);
    clock.lap("levelling");
  }
  forEachTileRun(map_, view.placed, [&](Tile* tile, std::size_t column, const ColumnRun& run) {
    tile->lowest[column] = std::min(tile->lowest[column], run.lowest);
    tile->highest[column] = std::max(tile->highest[column], run.highest);
    tile->possible[column] |= height_bins_.bins(view.placed, run);
  });
  clock.lap("coarse_ground");
}

void MapCleaner::level(ScanView& view) const {
  view.levelling = {};
  if (!levels()) return;
  StageClock clock(view.times);
  level(view, lowestOfColumns(view.placed, config_.levelling.radius));
  clock.lap("levelling");
}

void MapCleaner::level(ScanView& view, const std::vector<ColumnLow>& lows) const {
  view.levelling =
      findLevelling(map_, view.placed.anchor, lows, config_.matrix.res_g, config_.levelling);
  applyLevelling(view.levelling, view.placed);
}

void MapCleaner::placeLevelled(const Scan& scan) {
  place(scan, view_);
  level(view_);
  addTimes(view_);
}

void MapCleaner::estimateGround() {
  StageClock clock(times_);
  estimateCoarseGround(map_, config_.coarse_ground);
  map_.forEachTile([&](ColumnIndex, Tile& tile) {
    for (float& ground : tile.ground) ground -= judgement_.belowGround();
    if (config_.evidence.enabled) findPossibleCells(tile);
  });
  clock.lap("coarse_ground");
}

void MapCleaner::findPossibleCells(Tile& tile) const {
  const int ground_bit = config_.matrix.bits_below;
  for (std::size_t column = 0; column < Tile::kColumns; ++column) {
    const float ground = tile.ground[column];
    const int lowest = encoding_.bitIndex(tile.lowest[column], ground);
    const int highest = encoding_.bitIndex(tile.highest[column], ground);
    Bits& possible = tile.possible[column];
    if (lowest == ground_bit && highest == ground_bit) {
      // The ground cell alone is never judged, only together with what is above it.
      tile.flat.set(column);
      possible = 0;
      continue;
    }
    // That the ground cell was seen free says something about the points above it, also where it
    // holds none itself.
    const Bits occupied = lowBits(highest + 1) & ~lowBits(lowest);
    possible = height_bins_.possibleCells(possible, ground) & (occupied | Bits{1} << ground_bit);
  }
}

void MapCleaner::encode(const Scan& scan) {
  place(scan, view_);
  addTimes(view_);
  encode(view_);
}

void MapCleaner::encode(const ScanView& view) {
  StageClock clock(times_);
  forEachTileRun(map_, view.placed, [&](Tile* tile, std::size_t column, const ColumnRun& run) {
    tile->occupied[column] |= encoding_.bits(view.placed, run, tile->ground[column]);
  });
  clock.lap("binary_encoding");
}

void MapCleaner::compare(const Scan& scan) {
  place(scan, view_);
  addTimes(view_);
  look(view_);
  add(view_);
}

void MapCleaner::look(ScanView& view) const {
  view.times = {};
  level(view);
  if (config_.evidence.enabled) {
    findFree(view);
  } else {
    findDynamic(view);
  }
}

void MapCleaner::add(const ScanView& view) {
  times_.add(view.times);
  if (config_.evidence.enabled) {
    addEvidence(view);
  } else {
    StageClock clock(times_);
    judgement_.countGroundPoints(map_, view.placed);
    clock.lap("fine_ground");
    map_.merge(view.free, &Tile::dynamic);
    clock.lap("matrix_comparison");
  }
}

void MapCleaner::findDynamic(ScanView& view) const {
  StageClock clock(view.times);
  const PlacedScan& scan = view.placed;
  MapWindow& map = view.map;
  const ColumnWindow window = regionOfInterest(scan, config_.matrix);
  map.occupied = map_.extract(window, &Tile::occupied, Bits{0}, std::move(map.occupied));
  map.ground = map_.extract(window, &Tile::ground, Tile::kNoHeight, std::move(map.ground));
  map.below_ground =
      map_.extract(window, &Tile::below_ground, std::uint8_t{0}, std::move(map.below_ground));
  view.hit = encodeScan(scan, map.ground, config_.matrix, std::move(view.hit));
  clock.lap("binary_encoding");
  view.free = compareMatrices(map.occupied, view.hit, std::move(view.free));
  clock.lap("matrix_comparison");
  if (!config_.restoration.enabled) return;
  keepOnly(view.free, cellsInSight(scan, view.hit, map, config_.matrix, config_.restoration));
  excludeLowestBits(view.free, map.occupied);
  clock.lap("sight_mask");
  restore(view.free, cellsHidden(view.free, view.hit, map.ground, scan, config_.matrix));
  clock.lap("reverse_ray_casting");
}

void MapCleaner::findFree(ScanView& view) const {
  StageClock clock(view.times);
  const ColumnWindow window = seenRegion(view.placed, config_.matrix);
  HeightGrid& ground = view.map.ground;
  ground = map_.extract(window, &Tile::ground, Tile::kNoHeight, std::move(ground));
  view.hit = encodeScan(view.placed, ground, config_.matrix, std::move(view.hit));
  clock.lap("binary_encoding");
  // Which cells will be occupied is known only when all scans are added.
  BitGrid& candidates = view.map.occupied;
  candidates.reset(window, 0);
  forEachColumn(map_, window, [&](int x, int y, const Tile& tile, std::size_t column) {
    candidates.at(x, y) = tile.possible[column] & ~view.hit.at(x, y);
  });
  clock.lap("matrix_comparison");
  if (!view.beams) view.beams.emplace(config_.visibility);
  view.beams->fill(view.placed);
  clock.lap("beam_image");
  view.free = cellsSeenFree(*view.beams, candidates, ground, view.placed, config_.matrix,
                            config_.visibility, std::move(view.free), &view.few);
  clock.lap("beam_visibility");
}

void MapCleaner::addEvidence(const ScanView& view) {
  StageClock clock(times_);
  judgement_.countGroundPoints(map_, view.placed);
  clock.lap("fine_ground");
  // Points beyond the window are in the map, too, though nothing is judged there.
  const ColumnWindow& window = view.hit.window();
  TileCursor<TileMap> tile_of(map_);
  for (const ColumnRun& run : view.placed.runs) {
    const ColumnIndex index{view.placed.anchor.x + run.x, view.placed.anchor.y + run.y};
    if (window.contains(index)) continue;
    Tile& tile = *tile_of(index);
    const auto column = static_cast<std::size_t>(TileMap::indexInTile(index));
    tile.occupied[column] |= encoding_.bits(view.placed, run, tile.ground[column]);
  }
  clock.lap("binary_encoding");
  forEachColumn(map_, window, [&](int x, int y, Tile& tile, std::size_t column) {
    const Bits hit = view.hit.at(x, y);
    const Bits free = view.free.at(x, y);
    const Bits few = view.few.at(x, y);
    if ((hit | free | few) == 0) return;
    tile.occupied[column] |= hit;
    if (tile.flat[column]) return;  // nothing would ask for it
    tile.evidence.touch(column).observe(hit, free, few);
  });
  clock.lap("evidence");
}

void MapCleaner::segmentGround() {
  StageClock clock(times_);
  const std::vector<ColumnIndex> tiles = tilesOf(map_);
  if (config_.evidence.enabled) {
    judgement_.judgeEvidence(map_, tiles);
    clock.lap("evidence");
    judgement_.judgeAgreement(map_, tiles);
    clock.lap("agreement");
  }
  judgement_.segmentGround(map_, tiles);
  clock.lap("fine_ground");
}

void MapCleaner::measureFloors(const Scan& scan) {
  placeLevelled(scan);
  measureFloors(view_);
}

void MapCleaner::measureFloors(const ScanView& view) {
  StageClock clock(times_);
  judgement_.countFloorPoints(map_, view.placed);
  clock.lap("floors");
}

void MapCleaner::segmentFloors() {
  StageClock clock(times_);
  judgement_.segmentFloors(map_, tilesOf(map_));
  clock.lap("floors");
}

std::vector<PointClass> MapCleaner::classify(const Scan& scan) {
  std::vector<PointClass> classes;
  placeLevelled(scan);
  classify(view_, classes);
  addTimes(view_);
  return classes;
}

void MapCleaner::classify(ScanView& view, std::vector<PointClass>& classes) const {
  view.times = {};
  StageClock clock(view.times);
  judgement_.classify(map_, view.placed, classes);
  clock.lap("classifying");
}

}  // namespace beautymap
