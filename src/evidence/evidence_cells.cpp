// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
// What the remembered evidence says about cells and points: the part of the judgement that needs no
// scan at hand.
#include <algorithm>
#include <tuple>
#include <utility>

#include "beautymap/base/two_threads.h"
#include "beautymap/evidence/agreement.h"
#include "beautymap/evidence/evidence_judgement.h"
#include "beautymap/evidence/ground_under_objects.h"

namespace beautymap {
namespace {

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

void EvidenceJudgement::judgeEvidence(TileMap& map, const std::vector<ColumnIndex>& tiles) const {
  for (const ColumnIndex index : tiles) {
    Tile& tile = *map.findTile(index);
    if (evidenceTile(tile).evidence.empty()) continue;
    for (std::size_t column = 0; column < Tile::kColumns; ++column) {
      judgeEvidence(tile, column, ~Bits{0});
    }
  }
}

void EvidenceJudgement::judgeEvidence(Tile& tile, std::size_t column, Bits cells) const {
  EvidenceTile& state = evidenceTile(tile);
  const ColumnEvidence& evidence = std::as_const(state).evidence[column];
  const Bits ever_free = evidence.everFree();
  const Bits judged = cells & tile.occupied[column] & ~(Bits{1} << ground_bit_);
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
  set(state.suspected[column], suspected);
  set(state.strong[column], strong);
  set(state.leaning[column], leaning);
  set(state.unknown[column], unknown);
  set(state.flickering[column], flickering);
}

std::vector<ColumnIndex> EvidenceJudgement::judgeAgreement(TileMap& map,
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

std::vector<ColumnIndex> EvidenceJudgement::judgeBlock(
    TileMap& map, const std::vector<ColumnIndex>& block) const {
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

BitGrid EvidenceJudgement::dynamicCellsOf(const TileMap& map,
                                          const std::vector<ColumnIndex>& tiles) const {
  const int margin = config_.agreement.enabled ? agreementMargin(config_.agreement) : 0;
  const ColumnWindow window = windowOf(tiles, margin);
  BitGrid suspected = cellsOf(map, window, &EvidenceTile::suspected);
  if (!config_.agreement.enabled || suspected.isAll(0)) return suspected;
  return dynamicCells(
      {map.extract(window, &Tile::occupied, Bits{0}), std::move(suspected),
       cellsOf(map, window, &EvidenceTile::strong), cellsOf(map, window, &EvidenceTile::leaning),
       cellsOf(map, window, &EvidenceTile::unknown),
       cellsOf(map, window, &EvidenceTile::flickering)},
      ground_bit_, config_.agreement);
}

bool EvidenceJudgement::segmentGround(TileMap& map, const std::vector<ColumnIndex>& tiles) const {
  const bool divides = config_.coarse_ground.enabled && config_.fine_ground.enabled;
  bool changed = false;
  for (const ColumnIndex index : tiles) {
    Tile& tile = *map.findTile(index);
    const auto static_bins = tile.static_bins;
    if (config_.ground_layer.enabled) {
      findGroundLayers(tile, ground_layer_, ground_bit_, config_.evidence);
    } else if (divides) {
      segmentFineGround(tile, config_.fine_ground, ground_bit_);
    }
    changed |= tile.static_bins != static_bins;
  }
  const bool floors_changed = segmentFloors(map, tiles);
  return changed || floors_changed;
}

bool EvidenceJudgement::segmentFloors(TileMap& map, const std::vector<ColumnIndex>& tiles) const {
  if (!usesFloors()) return false;
  bool changed = false;
  for (const ColumnIndex index : tiles) {
    Tile& tile = *map.findTile(index);
    changed |= findFloors(tile, evidenceTile(tile).floors, floor_layer_, ground_bit_);
  }
  return changed;
}

void EvidenceJudgement::countGroundPoints(TileMap& map, const PlacedScan& scan) const {
  const auto counts = [](const Tile& tile, std::size_t column) {
    return !evidenceTile(tile).flat[column];
  };
  // Asked once, not for each point.
  if (config_.ground_layer.enabled) {
    countHeights(map, scan, counts, [this](const Tile& tile, std::size_t column, float z) {
      return layerBin(tile, column, z);
    });
  } else {
    countHeights(map, scan, counts, [this](const Tile& tile, std::size_t column, float z) {
      return fine_ground_.binOf(z, tile.ground[column], ground_bit_);
    });
  }
}

void EvidenceJudgement::countFloorPoints(TileMap& map, const PlacedScan& scan) const {
  if (!usesFloors()) return;
  forEachTileRun(map, scan, [&](Tile* tile, std::size_t column, const ColumnRun& run) {
    FloorCells& floors = evidenceTile(*tile).floors;
    if (!floors.has(column)) return;
    FloorCell& floor = floors.touch(column);
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

bool EvidenceJudgement::isDynamic(const Tile& tile, std::size_t column, float z) const {
  return isDynamic(tile, column, z, tile.dynamic[column], tile.static_bins[column]);
}

bool EvidenceJudgement::isDynamic(const Tile& tile, std::size_t column, float z, Bits dynamic,
                                  int ground_bins) const {
  if (!config_.ground_layer.enabled) {
    return fine_ground_.isDynamic(z, tile.ground[column], dynamic, ground_bins, ground_bit_);
  }
  const int bit = dynamic == 0 ? -1 : encoding_.bitIndex(z, tile.ground[column]);
  if (bit < 0) return false;
  const int bin = layerBin(tile, column, z);
  if (bin >= 0 && bin < ground_bins) return false;
  // What lies in the ground cell or a floor cell above the surface goes with the cell above.
  const int judged = bit == ground_bit_ || isAboveFloor(tile, column, z, bit) ? bit + 1 : bit;
  return (dynamic >> judged & 1) != 0;
}

bool EvidenceJudgement::isAboveFloor(const Tile& tile, std::size_t column, float z, int bit) const {
  const FloorCell& floor = evidenceTile(tile).floors[column];
  return floor.bit == bit &&
         floor_layer_.binOf(z, tile.ground[column]) >= bit * FloorCell::kBins + floor.static_bins;
}

void EvidenceJudgement::classify(const TileMap& map, const PlacedScan& scan,
                                 std::vector<PointClass>& classes) const {
  classifyRuns(map, scan, encoding_, classes,
               [this](const Tile& tile, std::size_t column, float z) {
                 return isDynamic(tile, column, z, tile.dynamic[column], tile.static_bins[column]);
               });
}

}  // namespace beautymap
