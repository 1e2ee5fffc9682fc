// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/map_cleaner.h"

#include <algorithm>
#include <utility>

#include "beautymap/coarse_ground.h"
#include "beautymap/fine_ground.h"
#include "beautymap/matrix_comparison.h"
#include "beautymap/reverse_ray_casting.h"

namespace beautymap {
namespace {

/// Calls f(tile, column in tile, z) for each point of a scan; tile is nullptr where a const map has
/// none.
template <typename Map, typename F>
void forEachTilePoint(Map& map, const PlacedScan& scan, double res_g, F f) {
  TileCursor<Map> tile_of(map);
  forEachColumnPoint(scan, res_g, [&](int x, int y, float z) {
    const ColumnIndex column{scan.anchor.x + x, scan.anchor.y + y};
    f(tile_of(column), static_cast<std::size_t>(TileMap::indexInTile(column)), z);
  });
}

}  // namespace

MapCleaner::MapCleaner(const Config& config)
    : config_((checkConfig(config), config)),
      encoding_(config.matrix),
      map_(fineBinCount(config.matrix, config.fine_ground)) {}

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
  countFineBins(placed);
  clock.lap("fine_ground");
  const MapWindow map = windowAround(placed);
  const BitGrid scan_bits = encodeScan(placed, map.ground, config_.matrix);
  clock.lap("binary_encoding");
  BitGrid dynamic = compareMatrices(map.occupied, scan_bits);
  clock.lap("matrix_comparison");
  if (config_.restoration.enabled) {
    keepOnly(dynamic, cellsInSight(placed, scan_bits, map, config_.matrix, config_.restoration));
    excludeLowestBits(dynamic, map.occupied);
    clock.lap("sight_mask");
    restore(dynamic, cellsHidden(dynamic, scan_bits, map.ground, placed, config_.matrix));
    clock.lap("reverse_ray_casting");
  }
  map_.merge(dynamic, &Tile::dynamic);
  clock.lap("matrix_comparison");
}

void MapCleaner::segmentGround() {
  StageClock clock(times_);
  if (config_.coarse_ground.enabled && config_.fine_ground.enabled) {
    segmentFineGround(map_, config_.fine_ground);
  }
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
                     const bool dynamic = tile && isDynamic(*tile, column, z);
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

int MapCleaner::fineBin(const Tile& tile, std::size_t column, int bit, float z) const {
  const float cell_bottom = tile.ground[column] + static_cast<float>(bit * config_.matrix.res_h);
  return fineBinOf(z - cell_bottom, map_.fineBins(), config_.fine_ground);
}

void MapCleaner::countFineBins(const PlacedScan& scan) {
  const auto bins = static_cast<std::size_t>(map_.fineBins());
  forEachTilePoint(map_, scan, config_.matrix.res_g, [&](Tile* tile, std::size_t column, float z) {
    const int bit = encoding_.bitIndex(z, tile->ground[column]);
    if (bit < 0 || tile->occupied[column] == 0 || bit != lowestBitIndex(tile->occupied[column])) {
      return;
    }
    ++tile->fine_counts[column * bins + static_cast<std::size_t>(fineBin(*tile, column, bit, z))];
  });
}

bool MapCleaner::isDynamic(const Tile& tile, std::size_t column, float z) const {
  if (tile.dynamic[column] == 0 && tile.static_bins[column] == 0) return false;
  const int bit = encoding_.bitIndex(z, tile.ground[column]);
  if (bit < 0) return false;
  if ((tile.dynamic[column] >> bit & 1) != 0) return true;
  return tile.static_bins[column] > 0 && bit == lowestBitIndex(tile.occupied[column]) &&
         fineBin(tile, column, bit, z) >= tile.static_bins[column];
}

}  // namespace beautymap
