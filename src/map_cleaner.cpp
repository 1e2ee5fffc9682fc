// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/map_cleaner.h"

#include <algorithm>
#include <utility>

#include "beautymap/agreement.h"
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
      ground_layer_(config.ground_layer),
      map_(usesGroundLayer() ? ground_layer_.bins()
                             : fineBinCount(config.matrix, config.fine_ground)) {
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
  countGroundPoints(placed);
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

void MapCleaner::judgeEvidence() {
  StageClock clock(times_);
  map_.forEachTile([&](ColumnIndex, Tile& tile) {
    for (std::size_t column = 0; column < tile.evidence.size(); ++column) {
      const ColumnEvidence& evidence = tile.evidence[column];
      Bits dynamic = 0, strong = 0;
      for (Bits rest = tile.occupied[column] & evidence.everFree(); rest != 0; rest &= rest - 1) {
        const int bit = lowestBitIndex(rest);
        if (bit == groundBit(tile, column) || !evidence.isDynamic(bit, config_.evidence)) continue;
        dynamic |= lowestBit(rest);
        if (evidence.isStrong(bit, config_.evidence)) strong |= lowestBit(rest);
      }
      tile.dynamic[column] = dynamic;
      tile.strong[column] = strong;
    }
  });
  clock.lap("evidence");
}

void MapCleaner::keepUnsupported() {
  StageClock clock(times_);
  std::vector<BitGrid> unsupported;
  std::as_const(map_).forEachTile([&](ColumnIndex index, const Tile&) {
    const ColumnWindow window{{index.x * Tile::kSide - 1, index.y * Tile::kSide - 1},
                              Tile::kSide + 2};
    unsupported.push_back(unsupportedCells({map_.extract(window, &Tile::occupied, Bits{0}),
                                            map_.extract(window, &Tile::dynamic, Bits{0}),
                                            map_.extract(window, &Tile::strong, Bits{0})},
                                           config_.matrix.bits_below, config_.agreement));
  });
  // Only when all tiles are judged, so that their order is irrelevant.
  for (const BitGrid& grid : unsupported) {
    forEachColumn(map_, grid.window(), [&](int x, int y, Tile& tile, std::size_t column) {
      tile.dynamic[column] &= ~grid.at(x, y);
    });
  }
  clock.lap("agreement");
}

int MapCleaner::groundBit(const Tile& tile, std::size_t column) const {
  if (config_.evidence.enabled) return config_.matrix.bits_below;
  return tile.occupied[column] == 0 ? -1 : lowestBitIndex(tile.occupied[column]);
}

void MapCleaner::segmentGround() {
  if (config_.evidence.enabled) {
    judgeEvidence();
    if (config_.agreement.enabled) keepUnsupported();
  }
  StageClock clock(times_);
  if (usesGroundLayer()) {
    findGroundLayers(map_, ground_layer_);
  } else if (config_.coarse_ground.enabled && config_.fine_ground.enabled) {
    segmentFineGround(map_, config_.fine_ground,
                      config_.evidence.enabled ? config_.matrix.bits_below : -1);
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

int MapCleaner::groundBin(const Tile& tile, std::size_t column, float z) const {
  if (usesGroundLayer()) {
    const float ground =
        tile.ground[column] + static_cast<float>(config_.matrix.bits_below * config_.matrix.res_h);
    const int bin = ground_layer_.binOf(z - ground);
    return bin < ground_layer_.bins() ? bin : -1;
  }
  const int bit = encoding_.bitIndex(z, tile.ground[column]);
  if (bit < 0 || bit != groundBit(tile, column)) return -1;
  const float cell_bottom = tile.ground[column] + static_cast<float>(bit * config_.matrix.res_h);
  return fineBinOf(z - cell_bottom, map_.fineBins(), config_.fine_ground);
}

void MapCleaner::countGroundPoints(const PlacedScan& scan) {
  const auto bins = static_cast<std::size_t>(map_.fineBins());
  forEachTilePoint(map_, scan, config_.matrix.res_g, [&](Tile* tile, std::size_t column, float z) {
    const int bin = groundBin(*tile, column, z);
    if (bin >= 0) ++tile->fine_counts[column * bins + static_cast<std::size_t>(bin)];
  });
}

bool MapCleaner::isDynamic(const Tile& tile, std::size_t column, float z) const {
  const Bits dynamic = tile.dynamic[column];
  const int bit = dynamic == 0 ? -1 : encoding_.bitIndex(z, tile.ground[column]);
  if (bit < 0) return false;
  const int bin = groundBin(tile, column, z);
  const int ground_bins = tile.static_bins[column];
  if (usesGroundLayer()) {
    if (bin >= 0 && bin < ground_bins) return false;
    // What lies in the ground cell above the ground surface goes with the cell above.
    const int judged = bit == groundBit(tile, column) ? bit + 1 : bit;
    return (dynamic >> judged & 1) != 0;
  }
  return (dynamic >> bit & 1) != 0 || (ground_bins > 0 && bin >= ground_bins);
}

}  // namespace beautymap
