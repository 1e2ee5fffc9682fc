// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/published/published_judgement.h"

#include <algorithm>
#include <cmath>

#include "beautymap/ground/ground_anchor.h"
#include "beautymap/published/matrix_comparison.h"
#include "beautymap/published/reverse_ray_casting.h"
#include "beautymap/published/sight_mask.h"

namespace beautymap {
namespace {

/// What is remembered of a map's columns.
struct PublishedTile : TileState {
  std::array<Bits, Tile::kColumns> seen_free{};  ///< cells that any scan saw free

  std::unique_ptr<TileState> clone() const override {
    return std::make_unique<PublishedTile>(*this);
  }
  std::size_t memoryBytes() const override { return sizeof(*this); }
  void write(ByteSink& sink) const override { sink.write(seen_free.data(), sizeof(seen_free)); }
  bool read(ByteSource& source) override {
    source.read(seen_free.data(), sizeof(seen_free));
    return true;
  }
};

PublishedTile& publishedTile(Tile& tile) { return static_cast<PublishedTile&>(*tile.state); }
const PublishedTile& publishedTile(const Tile& tile) {
  return static_cast<const PublishedTile&>(*tile.state);
}

/// The ground cell: a column's lowest occupied one; -1 for an empty column.
int groundBit(const Tile& tile, std::size_t column) {
  return tile.occupied[column] == 0 ? -1 : lowestBitIndex(tile.occupied[column]);
}

}  // namespace

struct PublishedJudgement::Findings : ScanFindings {
  MapWindow map;
  BitGrid hit;        ///< M_scan
  BitGrid seen_free;  ///< M_dyn
};

PublishedJudgement::PublishedJudgement(const Config& config)
    : config_(config), encoding_(config.matrix), fine_ground_(config.matrix, config.fine_ground) {}

TileMap PublishedJudgement::newMap() const {
  return TileMap(fine_ground_.bins(), std::make_unique<PublishedTile>());
}

std::unique_ptr<ScanFindings> PublishedJudgement::newFindings() const {
  return std::make_unique<Findings>();
}

void PublishedJudgement::place(PlacedScan& scan, StageClock& clock) const {
  if (!config_.restoration.enabled) return;
  scan.steepest_slope = steepestSlope(scan, config_.restoration.steepest_share);
  clock.lap("sight_mask");
}

std::vector<JudgementPass> PublishedJudgement::passes() const {
  JudgementPass encoding, comparing;
  encoding.name = "encoding";
  encoding.add = [this](TileMap& map, const PlacedScan& scan, const ScanFindings&,
                        StageClock& clock) {
    encode(map, scan);
    clock.lap("binary_encoding");
  };
  comparing.name = "comparing";
  comparing.look = [this](const TileMap& map, const PlacedScan& scan, ScanFindings& found,
                          StageClock& clock) {
    compare(map, scan, static_cast<Findings&>(found), clock);
  };
  comparing.add = [this](TileMap& map, const PlacedScan& scan, const ScanFindings& found,
                         StageClock& clock) {
    // Only a ground cell with another one on it is ever divided.
    countGroundPoints(map, scan,
                      [](Bits occupied) { return (occupied & lowestBit(occupied) << 1) != 0; });
    clock.lap("fine_ground");
    addVotes(map, static_cast<const Findings&>(found).seen_free);
    clock.lap("matrix_comparison");
  };
  comparing.conclude = [this](TileMap& map, StageClock& clock) {
    map.forEachTile([this](ColumnIndex, Tile& tile) { judge(tile); });
    clock.lap("fine_ground");
  };
  return {encoding, comparing};
}

void PublishedJudgement::encode(TileMap& map, const PlacedScan& scan) const {
  forEachTileRun(map, scan, [&](Tile* tile, std::size_t column, const ColumnRun& run) {
    tile->occupied[column] |= encoding_.bits(scan, run, tile->ground[column]);
  });
}

void PublishedJudgement::lookAround(const TileMap& map, const PlacedScan& scan, Findings& found,
                                    StageClock& clock) const {
  MapWindow& around = found.map;
  const ColumnWindow window = regionOfInterest(scan, config_.matrix);
  around.occupied = map.extract(window, &Tile::occupied, Bits{0}, std::move(around.occupied));
  around.ground = map.extract(window, &Tile::ground, Tile::kNoHeight, std::move(around.ground));
  around.below_ground =
      map.extract(window, &Tile::below_ground, std::uint8_t{0}, std::move(around.below_ground));
  found.hit = encodeScan(scan, around.ground, config_.matrix, std::move(found.hit));
  clock.lap("binary_encoding");
}

void PublishedJudgement::compare(const TileMap& map, const PlacedScan& scan, Findings& found,
                                 StageClock& clock) const {
  lookAround(map, scan, found, clock);
  found.seen_free = compareMatrices(found.map.occupied, found.hit, std::move(found.seen_free));
  clock.lap("matrix_comparison");
  if (!config_.restoration.enabled) return;
  excludeLowestBits(found.seen_free, found.map.occupied);
  restoreStatic(scan, found, clock);
}

void PublishedJudgement::restoreStatic(const PlacedScan& scan, Findings& found,
                                       StageClock& clock) const {
  keepOnly(found.seen_free,
           cellsInSight(scan, found.hit, found.map, config_.matrix, config_.restoration));
  clock.lap("sight_mask");
  restore(found.seen_free,
          cellsHidden(found.seen_free, found.hit, found.map.ground, scan, config_.matrix));
  clock.lap("reverse_ray_casting");
}

template <typename Counts>
void PublishedJudgement::countGroundPoints(TileMap& map, const PlacedScan& scan,
                                           Counts counts) const {
  countHeights(
      map, scan,
      [&](const Tile& tile, std::size_t column) { return counts(tile.occupied[column]); },
      [this](const Tile& tile, std::size_t column, float z) {
        return fine_ground_.binOf(z, tile.ground[column], groundBit(tile, column));
      });
}

/// One vote is enough.
void PublishedJudgement::addVotes(TileMap& map, const BitGrid& seen_free) const {
  forEachColumn(map, seen_free.window(), [&](int x, int y, Tile& tile, std::size_t column) {
    const Bits free = seen_free.at(x, y);
    if (free == 0) return;
    publishedTile(tile).seen_free[column] |= free;
    if ((free & tile.occupied[column]) != 0) tile.unsettled = true;
  });
}

void PublishedJudgement::judge(Tile& tile) const {
  const auto& seen_free = publishedTile(tile).seen_free;
  for (std::size_t column = 0; column < Tile::kColumns; ++column) {
    const Bits occupied = tile.occupied[column];
    const Bits ground_cell = config_.restoration.enabled ? lowestBit(occupied) : Bits{0};
    tile.dynamic[column] = occupied & seen_free[column] & ~ground_cell;
  }
  if (config_.coarse_ground.enabled && config_.fine_ground.enabled) {
    segmentFineGround(tile, config_.fine_ground);
  }
}

void PublishedJudgement::addHits(TileMap& map, const PlacedScan& scan, ScanFindings&,
                                 StageClock& clock) const {
  forEachTileRun(map, scan, [&](Tile* tile, std::size_t column, const ColumnRun& run) {
    const Bits bits = encoding_.bits(scan, run, tile->ground[column]);
    Bits& occupied = tile->occupied[column];
    if ((bits & ~occupied) == 0) return;
    if (bits != 0 && lowestBit(bits) < lowestBit(occupied)) {
      // Another cell is the ground cell now, of which nothing is counted yet.
      std::fill_n(tile->fineCounts(column), tile->fineBins(), 0U);
    }
    occupied |= bits;
    tile->unsettled = true;
  });
  clock.lap("binary_encoding");
  countGroundPoints(map, scan, [](Bits) { return true; });
  clock.lap("fine_ground");
}

std::vector<ColumnIndex> PublishedJudgement::addSeenFree(TileMap& map, const PlacedScan& scan,
                                                         ScanFindings& findings,
                                                         StageClock& clock) const {
  auto& found = static_cast<Findings&>(findings);
  lookAround(map, scan, found, clock);
  const auto height = static_cast<int>(config_.online.free_height / config_.matrix.res_h);
  const Bits remembered =
      lowBits(std::min(config_.matrix.bits_below + height, config_.matrix.n_bit));
  // What may become occupied, and needs no second vote.
  forEachColumn(map, found.hit.window(), [&](int x, int y, const Tile& tile, std::size_t column) {
    if (tile.ground[column] == Tile::kNoHeight) return;
    found.map.occupied.at(x, y) =
        (tile.occupied[column] | remembered) & ~publishedTile(tile).seen_free[column];
  });
  found.seen_free = compareMatrices(found.map.occupied, found.hit, std::move(found.seen_free));
  clock.lap("matrix_comparison");
  if (config_.restoration.enabled) restoreStatic(scan, found, clock);
  addVotes(map, found.seen_free);
  clock.lap("matrix_comparison");
  return {};
}

void PublishedJudgement::settle(TileMap& map, const std::vector<ColumnIndex>& changed) const {
  for (const ColumnIndex index : changed) {
    Tile& tile = *map.findTile(index);
    const auto dynamic = tile.dynamic;
    const auto static_bins = tile.static_bins;
    judge(tile);
    if (tile.dynamic != dynamic || tile.static_bins != static_bins) ++tile.revision;
  }
}

bool PublishedJudgement::anchor(Tile& tile, std::size_t column, float bottom) const {
  Bits& seen_free = publishedTile(tile).seen_free[column];
  Bits& occupied = tile.occupied[column];
  const double up = static_cast<double>(tile.ground[column]) - bottom;
  const bool cells_known = tile.ground[column] != Tile::kNoHeight && (occupied | seen_free) != 0;
  if (cells_known && up == 0.0F) return false;
  tile.ground[column] = bottom;
  if (!cells_known) return false;
  // Exactly to the estimate, as a cell that holds the ground and 0.1 m of an object is all ground
  // or all object. What is remembered moves to the nearest cell; where that is not the same one,
  // the next scans say it again.
  const int bits = static_cast<int>(std::lround(up / config_.matrix.res_h));
  seen_free = shifted(seen_free, bits) & lowBits(config_.matrix.n_bit);
  occupied = shiftedUpToTop(occupied, bits, config_.matrix.n_bit);
  const double within_cell = up - bits * config_.matrix.res_h;
  shiftCounts(tile, column, std::lround(within_cell / config_.fine_ground.bin_height));
  return true;
}

bool PublishedJudgement::isDynamic(const Tile& tile, std::size_t column, float z) const {
  return fine_ground_.isDynamic(z, tile.ground[column], tile.dynamic[column],
                                tile.static_bins[column], groundBit(tile, column));
}

void PublishedJudgement::classify(const TileMap& map, const PlacedScan& scan,
                                  std::vector<PointClass>& classes) const {
  classifyRuns(
      map, scan, encoding_, classes,
      [this](const Tile& tile, std::size_t column, float z) { return isDynamic(tile, column, z); });
}

}  // namespace beautymap
