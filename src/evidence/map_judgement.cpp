// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/evidence/map_judgement.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "beautymap/base/two_threads.h"
#include "beautymap/evidence/agreement.h"
#include "beautymap/ground/fine_ground.h"

namespace beautymap {

namespace {

float depthBelowGround(const MatrixConfig& config) {
  // The lowest points are what the ground's height comes from: not even rounding may move them to
  // the cell below.
  constexpr double kRounding = 1e-3;  // [m]
  const double depth = config.bits_below * config.res_h;
  return static_cast<float>(config.bits_below == 0 ? depth : depth + kRounding);
}

/// Tiles of a block are judged together: with their own windows, most of what is looked at would be
/// looked at for several tiles.
std::pair<std::int32_t, std::int32_t> blockOf(ColumnIndex tile) {
  constexpr int kShift = 1;  // two by two tiles: their windows fit into a cache
  return {tile.x >> kShift, tile.y >> kShift};
}

/// The square of columns around some tiles that reaches so many columns farther.
ColumnWindow windowOf(const std::vector<ColumnIndex>& tiles, int margin) {
  ColumnIndex low = tiles.front(), high = low;
  for (const ColumnIndex tile : tiles) {
    low = {std::min(low.x, tile.x), std::min(low.y, tile.y)};
    high = {std::max(high.x, tile.x), std::max(high.y, tile.y)};
  }
  return TileMap::windowOf(low, 1 + std::max(high.x - low.x, high.y - low.y), margin);
}

}  // namespace

MapJudgement::MapJudgement(const Config& config)
    : config_(config),
      encoding_(config.matrix),
      ground_layer_(config.ground_layer, config.matrix.res_h),
      floor_layer_(config.ground_layer, config.matrix),
      below_ground_(depthBelowGround(config.matrix)) {}

int MapJudgement::fineBins() const {
  return usesGroundLayer() ? ground_layer_.bins()
                           : fineBinCount(config_.matrix, config_.fine_ground);
}

void MapJudgement::judgeEvidence(TileMap& map, const std::vector<ColumnIndex>& tiles) const {
  for (const ColumnIndex index : tiles) {
    Tile& tile = *map.findTile(index);
    if (tile.evidence.empty()) continue;
    for (std::size_t column = 0; column < Tile::kColumns; ++column) {
      judgeEvidence(tile, column, ~Bits{0});
    }
  }
}

void MapJudgement::judgeEvidence(Tile& tile, std::size_t column, Bits cells) const {
  const ColumnEvidence& evidence = tile.evidence[column];
  const Bits ever_free = evidence.everFree();
  const int ground_bit = groundBit(tile, column);
  const Bits judged =
      cells & tile.occupied[column] & ~(ground_bit < 0 ? Bits{0} : Bits{1} << ground_bit);
  Bits suspected = 0, strong = 0, leaning = 0, flickering = 0;
  for (Bits rest = judged & (ever_free | evidence.everPassedByFew()); rest != 0; rest &= rest - 1) {
    const int bit = lowestBitIndex(rest);
    if (evidence.isDynamic(bit, config_.evidence)) suspected |= lowestBit(rest);
    if (evidence.isStrong(bit, config_.evidence)) strong |= lowestBit(rest);
    if (evidence.isLeaning(bit, config_.evidence)) leaning |= lowestBit(rest);
    if (evidence.flickers(bit, config_.evidence)) flickering |= lowestBit(rest);
  }
  const Bits unknown = judged & ~ever_free & ~evidence.hitMoreOften(config_.evidence.unknown_hits);
  const auto set = [&](Bits& of_column, Bits found) { of_column = (of_column & ~cells) | found; };
  set(tile.suspected[column], suspected);
  set(tile.strong[column], strong);
  set(tile.leaning[column], leaning);
  set(tile.unknown[column], unknown);
  set(tile.flickering[column], flickering);
}

std::vector<ColumnIndex> MapJudgement::judgeAgreement(TileMap& map,
                                                      std::vector<ColumnIndex> tiles) const {
  std::sort(tiles.begin(), tiles.end(), [](ColumnIndex a, ColumnIndex b) {
    return std::make_tuple(blockOf(a), a.x, a.y) < std::make_tuple(blockOf(b), b.x, b.y);
  });
  std::vector<std::vector<ColumnIndex>> blocks;
  for (const ColumnIndex tile : tiles) {
    if (blocks.empty() || blockOf(blocks.back().front()) != blockOf(tile)) blocks.emplace_back();
    blocks.back().push_back(tile);
  }
  std::vector<std::vector<ColumnIndex>> changed_of(blocks.size());
  inTwoThreads(blocks.size(), [&](std::size_t i) { changed_of[i] = judgeBlock(map, blocks[i]); });
  std::vector<ColumnIndex> changed;
  for (const auto& block : changed_of) changed.insert(changed.end(), block.begin(), block.end());
  return changed;
}

std::vector<ColumnIndex> MapJudgement::judgeBlock(TileMap& map,
                                                  const std::vector<ColumnIndex>& block) const {
  const BitGrid dynamic = dynamicCellsOf(map, block);
  const ColumnIndex corner = dynamic.window().corner;
  std::vector<ColumnIndex> changed;
  for (const ColumnIndex index : block) {
    Tile& tile = *map.findTile(index);
    const auto before = tile.dynamic;
    const int x0 = index.x * Tile::kSide - corner.x, y0 = index.y * Tile::kSide - corner.y;
    for (int x = 0; x < Tile::kSide; ++x) {
      for (int y = 0; y < Tile::kSide; ++y) {
        tile.dynamic[static_cast<std::size_t>(x << Tile::kShift | y)] = dynamic.at(x0 + x, y0 + y);
      }
    }
    if (tile.dynamic != before) changed.push_back(index);
  }
  return changed;
}

BitGrid MapJudgement::dynamicCellsOf(const TileMap& map,
                                     const std::vector<ColumnIndex>& tiles) const {
  const int margin = config_.agreement.enabled ? agreementMargin(config_.agreement) : 0;
  const ColumnWindow window = windowOf(tiles, margin);
  BitGrid suspected = map.extract(window, &Tile::suspected, Bits{0});
  if (!config_.agreement.enabled || suspected.isAll(0)) return suspected;
  return dynamicCells(
      {map.extract(window, &Tile::occupied, Bits{0}), std::move(suspected),
       map.extract(window, &Tile::strong, Bits{0}), map.extract(window, &Tile::leaning, Bits{0}),
       map.extract(window, &Tile::unknown, Bits{0}),
       map.extract(window, &Tile::flickering, Bits{0})},
      config_.matrix.bits_below, config_.agreement);
}

bool MapJudgement::segmentGround(TileMap& map, const std::vector<ColumnIndex>& tiles) const {
  const bool divides = config_.coarse_ground.enabled && config_.fine_ground.enabled;
  bool changed = false;
  for (const ColumnIndex index : tiles) {
    Tile& tile = *map.findTile(index);
    const auto static_bins = tile.static_bins;
    if (usesGroundLayer()) {
      findGroundLayers(tile, ground_layer_, config_.matrix.bits_below, config_.evidence);
    } else if (divides) {
      segmentFineGround(tile, config_.fine_ground,
                        config_.evidence.enabled ? config_.matrix.bits_below : -1);
    }
    changed |= tile.static_bins != static_bins;
  }
  const bool floors_changed = segmentFloors(map, tiles);
  return changed || floors_changed;
}

bool MapJudgement::segmentFloors(TileMap& map, const std::vector<ColumnIndex>& tiles) const {
  if (!usesFloors()) return false;
  bool changed = false;
  for (const ColumnIndex index : tiles) {
    changed |= findFloors(*map.findTile(index), floor_layer_, config_.matrix.bits_below);
  }
  return changed;
}

int MapJudgement::groundBit(const Tile& tile, std::size_t column) const {
  if (config_.evidence.enabled) return config_.matrix.bits_below;
  return tile.occupied[column] == 0 ? -1 : lowestBitIndex(tile.occupied[column]);
}

int MapJudgement::fineBin(const Tile& tile, std::size_t column, float z) const {
  const int bit = encoding_.bitIndex(z, tile.ground[column]);
  const int ground_bit = groundBit(tile, column);
  if (bit < 0 || bit < ground_bit) return -1;
  if (bit > ground_bit) return tile.fineBins();
  const float cell_bottom = tile.ground[column] + static_cast<float>(bit * config_.matrix.res_h);
  return fineBinOf(z - cell_bottom, tile.fineBins(), config_.fine_ground);
}

void MapJudgement::countGroundPoints(TileMap& map, const PlacedScan& scan) const {
  const int bins = map.fineBins();
  const auto count = [&](auto bin_of) {
    forEachTileRun(map, scan, [&](Tile* tile, std::size_t column, const ColumnRun& run) {
      if (tile->flat[column] || !countsGround(*tile, column)) return;
      std::uint32_t* counts = &tile->fine_counts[column * static_cast<std::size_t>(bins)];
      const int lowest = bin_of(*tile, column, run.lowest);
      if (lowest >= bins) return;
      if (lowest >= 0 && lowest == bin_of(*tile, column, run.highest)) {
        counts[lowest] += run.size();
        return;
      }
      for (std::uint32_t i = run.begin; i < run.end; ++i) {
        const int bin = bin_of(*tile, column, scan.z[i]);
        if (bin >= 0 && bin < bins) ++counts[bin];
      }
    });
  };
  // Asked once, not for each point.
  if (usesGroundLayer()) {
    count([this](const Tile& tile, std::size_t column, float z) {
      return layerBin(tile, column, z);
    });
  } else {
    count(
        [this](const Tile& tile, std::size_t column, float z) { return fineBin(tile, column, z); });
  }
}

void MapJudgement::countFloorPoints(TileMap& map, const PlacedScan& scan) const {
  if (!usesFloors()) return;
  forEachTileRun(map, scan, [&](Tile* tile, std::size_t column, const ColumnRun& run) {
    if (!tile->floors.has(column)) return;
    FloorCell& floor = tile->floors.touch(column);
    const float ground = tile->ground[column];
    if (encoding_.bitIndex(run.lowest, ground) > floor.bit ||
        encoding_.bitIndex(run.highest, ground) < floor.bit) {
      return;
    }
    for (std::uint32_t i = run.begin; i < run.end; ++i) {
      const int bin = floor_layer_.binOf(scan.z[i], ground) - floor.bit * FloorCell::kBins;
      if (bin >= 0 && bin < FloorCell::kBins) ++floor.counts[static_cast<std::size_t>(bin)];
    }
  });
}

bool MapJudgement::countsGround(const Tile& tile, std::size_t column) const {
  if (config_.evidence.enabled) return true;
  const Bits occupied = tile.occupied[column];
  return (occupied & lowestBit(occupied) << 1) != 0;
}

int MapJudgement::groundBins(const Tile& tile, std::size_t column, Bits dynamic) const {
  if (!usesGroundLayer()) return tile.static_bins[column];
  return groundBinsOf(tile, column, dynamic, ground_layer_, config_.matrix.bits_below,
                      config_.evidence);
}

bool MapJudgement::isDynamic(const Tile& tile, std::size_t column, float z, Bits dynamic,
                             int ground_bins) const {
  const int bit = dynamic == 0 ? -1 : encoding_.bitIndex(z, tile.ground[column]);
  if (bit < 0) return false;
  const int bin = groundBin(tile, column, z);
  if (usesGroundLayer()) {
    if (bin >= 0 && bin < ground_bins) return false;
    // What lies in the ground cell or a floor cell above the surface goes with the cell above.
    const int judged =
        bit == groundBit(tile, column) || isAboveFloor(tile, column, z, bit) ? bit + 1 : bit;
    return (dynamic >> judged & 1) != 0;
  }
  return (dynamic >> bit & 1) != 0 || (ground_bins > 0 && bin >= ground_bins);
}

bool MapJudgement::isAboveFloor(const Tile& tile, std::size_t column, float z, int bit) const {
  const FloorCell& floor = tile.floors[column];
  return floor.bit == bit &&
         floor_layer_.binOf(z, tile.ground[column]) >= bit * FloorCell::kBins + floor.static_bins;
}

void MapJudgement::classify(const TileMap& map, const PlacedScan& scan,
                            std::vector<PointClass>& classes) const {
  if (scan.isWhole()) {
    classes.assign(scan.cloud_size, PointClass::kStatic);
  } else {
    classes.assign(scan.cloud_size, PointClass::kDropped);
    for (const std::uint32_t source : scan.source_index) classes[source] = PointClass::kStatic;
  }
  forEachTileRun(map, scan, [&](const Tile* tile, std::size_t column, const ColumnRun& run) {
    // Most columns have no dynamic cell: nothing of them is removed.
    if (tile == nullptr || tile->dynamic[column] == 0) return;
    // From some height on all points of a cell are dynamic, or none.
    const float ground = tile->ground[column];
    const bool highest = isDynamic(*tile, column, run.highest);
    const bool alike =
        encoding_.bitIndex(run.lowest, ground) == encoding_.bitIndex(run.highest, ground) &&
        isDynamic(*tile, column, run.lowest) == highest;
    if (alike && !highest) return;
    for (std::uint32_t i = run.begin; i < run.end; ++i) {
      if (alike || isDynamic(*tile, column, scan.z[i])) {
        classes[scan.sourceOf(i)] = PointClass::kDynamic;
      }
    }
  });
}

std::vector<ColumnIndex> tilesOf(const TileMap& map) {
  std::vector<ColumnIndex> tiles;
  tiles.reserve(map.tileCount());
  map.forEachTile([&](ColumnIndex index, const Tile&) { tiles.push_back(index); });
  return tiles;
}

std::vector<ColumnIndex> withNeighbours(const TileMap& map, const std::vector<ColumnIndex>& tiles,
                                        int columns) {
  const int reach = (columns + Tile::kSide - 1) / Tile::kSide;
  std::vector<ColumnIndex> all;
  for (const ColumnIndex tile : tiles) {
    for (int dx = -reach; dx <= reach; ++dx) {
      for (int dy = -reach; dy <= reach; ++dy) {
        const ColumnIndex near{tile.x + dx, tile.y + dy};
        if (map.findTile(near) != nullptr) all.push_back(near);
      }
    }
  }
  const auto before = [](ColumnIndex a, ColumnIndex b) {
    return std::tie(a.x, a.y) < std::tie(b.x, b.y);
  };
  std::sort(all.begin(), all.end(), before);
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

}  // namespace beautymap
