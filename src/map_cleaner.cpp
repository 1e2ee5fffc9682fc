// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/map_cleaner.h"

#include <algorithm>
#include <utility>

#include "beautymap/coarse_ground.h"
#include "beautymap/matrix_comparison.h"
#include "beautymap/reverse_ray_casting.h"

namespace beautymap {

MapCleaner::MapCleaner(const Config& config)
    : config_((checkConfig(config), config)),
      encoding_(config.matrix),
      judgement_(config),
      map_(judgement_.fineBins()) {
  if (config.evidence.enabled) beams_.emplace(config.visibility);
}

void MapCleaner::observe(const Scan& scan) {
  StageClock clock(times_);
  const double z_origin = z_origin_.value_or(scan.sensor_in_map.z());
  placed_ =
      placeScan(scan, z_origin, config_.matrix.res_g, config_.scan, dropped_, std::move(placed_));
  z_origin_ = z_origin;  // only now: placeScan refuses poses that are not finite
  clock.lap("placing");
  forEachTilePoint(map_, placed_, config_.matrix.res_g,
                   [](Tile* tile, std::size_t column, float z) {
                     tile->lowest[column] = std::min(tile->lowest[column], z);
                   });
  clock.lap("coarse_ground");
}

void MapCleaner::estimateGround() {
  StageClock clock(times_);
  estimateCoarseGround(map_, config_.coarse_ground);
  const float below = static_cast<float>(config_.matrix.bits_below * config_.matrix.res_h);
  map_.forEachTile([&](ColumnIndex, Tile& tile) {
    for (float& ground : tile.ground) ground -= below;
  });
  clock.lap("coarse_ground");
}

void MapCleaner::encode(const Scan& scan) {
  StageClock clock(times_);
  const PlacedScan& placed = place(scan);
  clock.lap("placing");
  forEachTilePoint(map_, placed, config_.matrix.res_g,
                   [&](Tile* tile, std::size_t column, float z) {
                     tile->occupied[column] |= encoding_.bit(z, tile->ground[column]);
                   });
  clock.lap("binary_encoding");
}

void MapCleaner::compare(const Scan& scan) {
  StageClock clock(times_);
  const PlacedScan& placed = place(scan);
  clock.lap("placing");
  judgement_.countGroundPoints(map_, placed);
  clock.lap("fine_ground");
  const MapWindow map = windowAround(placed);
  const BitGrid scan_bits = encodeScan(placed, map.ground, config_.matrix);
  clock.lap("binary_encoding");
  if (config_.evidence.enabled) {
    gatherEvidence(placed, map, scan_bits);
  } else {
    findDynamic(placed, map, scan_bits);
  }
}

void MapCleaner::findDynamic(const PlacedScan& scan, const MapWindow& map,
                             const BitGrid& scan_bits) {
  StageClock clock(times_);
  BitGrid dynamic = compareMatrices(map.occupied, scan_bits);
  clock.lap("matrix_comparison");
  if (config_.restoration.enabled) {
    keepOnly(dynamic, cellsInSight(scan, scan_bits, map, config_.matrix, config_.restoration));
    excludeLowestBits(dynamic, map.occupied);
    clock.lap("sight_mask");
    restore(dynamic, cellsHidden(dynamic, scan_bits, map.ground, scan, config_.matrix));
    clock.lap("reverse_ray_casting");
  }
  map_.merge(dynamic, &Tile::dynamic);
  clock.lap("matrix_comparison");
}

void MapCleaner::gatherEvidence(const PlacedScan& scan, const MapWindow& map,
                                const BitGrid& scan_bits) {
  StageClock clock(times_);
  const BitGrid candidates = compareMatrices(map.occupied, scan_bits);
  clock.lap("matrix_comparison");
  beams_->fill(scan);
  clock.lap("beam_image");
  const BitGrid seen_free =
      cellsSeenFree(*beams_, candidates, map.ground, scan, config_.matrix, config_.visibility);
  clock.lap("beam_visibility");
  forEachColumn(map_, candidates.window(), [&](int x, int y, Tile& tile, std::size_t column) {
    const Bits hit = scan_bits.at(x, y);
    const Bits free = seen_free.at(x, y);
    if ((hit | free) == 0) return;
    if (tile.evidence.empty()) tile.evidence.resize(Tile::kColumns);
    tile.evidence[column].observe(hit, free);
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

std::vector<PointClass> MapCleaner::classify(const Scan& scan) {
  StageClock clock(times_);
  const PlacedScan& placed = place(scan);
  clock.lap("placing");
  std::vector<PointClass> classes(scan.cloud.size(), PointClass::kDropped);
  auto source = placed.source_index.begin();
  forEachTilePoint(std::as_const(map_), placed, config_.matrix.res_g,
                   [&](const Tile* tile, std::size_t column, float z) {
                     const bool dynamic = tile && judgement_.isDynamic(*tile, column, z);
                     classes[*source++] = dynamic ? PointClass::kDynamic : PointClass::kStatic;
                   });
  clock.lap("classifying");
  return classes;
}

const PlacedScan& MapCleaner::place(const Scan& scan) {
  DroppedPoints counted_while_observing;
  placed_ = placeScan(scan, zOrigin(), config_.matrix.res_g, config_.scan, counted_while_observing,
                      std::move(placed_));
  return placed_;
}

MapWindow MapCleaner::windowAround(const PlacedScan& scan) const {
  const int half =
      std::max(1, static_cast<int>(0.5 * config_.matrix.roi_size / config_.matrix.res_g));
  const ColumnWindow window{{scan.anchor.x - half, scan.anchor.y - half}, 2 * half + 1};
  return {map_.extract(window, &Tile::occupied, Bits{0}),
          map_.extract(window, &Tile::ground, Tile::kNoHeight),
          map_.extract(window, &Tile::below_ground, std::uint8_t{0})};
}

}  // namespace beautymap
