// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/cleaner/online_map.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "beautymap/base/two_threads.h"
#include "beautymap/evidence/agreement.h"
#include "beautymap/ground/coarse_ground.h"
#include "beautymap/ground/ground_anchor.h"
#include "beautymap/matrix/binary_encoding.h"

namespace beautymap {
namespace {

// Lowest heights fall by millimetres in every scan: not a reason to estimate the ground again.
constexpr float kNoticeable = 0.02F;  // [m]

/// Whether any of these cells was seen free so often before its first hit, no more and no less.
bool anySeenFree(const ColumnEvidence& evidence, Bits cells, int times) {
  for (; cells != 0; cells &= cells - 1) {
    if (evidence.freeBefore(lowestBitIndex(cells)) == times) return true;
  }
  return false;
}

const Config& checked(const Config& config) {
  checkConfig(config);
  if (!config.evidence.enabled) {
    throw ConfigError("evidence.enabled = false: a map that grows is judged by evidence only");
  }
  if (!config.coarse_ground.enabled) {
    throw ConfigError(
        "coarse_ground.enabled = false: the lowest point of a map that grows is "
        "not known");
  }
  return config;
}

}  // namespace

OnlineMap::OnlineMap(const Config& config)
    : config_(checked(config)),
      judgement_(config),
      map_(judgement_.fineBins()),
      beams_(config.visibility) {}

const std::vector<PointClass>& OnlineMap::addHits(const Scan& scan) {
  StageClock clock(times_);
  const double z_origin = z_origin_.value_or(scan.sensor_in_map.z());
  placed_ =
      placeScan(scan, z_origin, config_.matrix.res_g, config_.scan, dropped_, std::move(placed_));
  z_origin_ = z_origin;
  clock.lap("placing");
  if (config_.levelling.enabled) {
    const auto lows = lowestOfColumns(placed_, config_.levelling.radius);
    addLevels(map_, placed_.anchor, lows);
    level(placed_, lows);
    clock.lap("levelling");
  }
  addLowest();
  updateGround();
  clock.lap("coarse_ground");
  addOccupied();
  clock.lap("binary_encoding");
  judgement_.countGroundPoints(map_, placed_);
  judgement_.countFloorPoints(map_, placed_);
  clock.lap("fine_ground");
  addHitEvidence();
  clock.lap("evidence");
  settle();
  clock.lap("agreement");
  classifyLive();
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
  const float below = judgement_.belowGround();
  const auto anchor = [&](std::size_t column, float ground) {
    if (anchorColumn(tile, column, ground - below, config_.online.ground_drift, config_)) {
      // Another cell is the ground's now, and what was taken for ground may be an object.
      if (!tile.evidence.empty()) judgement_.judgeEvidence(tile, column, ~Bits{0});
      tile.unsettled = true;
      ++tile.revision;
    }
  };
  std::bitset<Tile::kColumns> has_ground;
  std::vector<float> neighbours;
  for (std::size_t column = 0; column < Tile::kColumns; ++column) {
    if (tile.lowest[column] == Tile::kNoHeight ||
        hangsOverFreeSpace(tile, column, tile.lowest[column], config_)) {
      continue;
    }
    has_ground.set(column);
    if (!tile.stale_ground[column]) continue;
    const int x = static_cast<int>(column) >> Tile::kShift;
    const int y = static_cast<int>(column) & (Tile::kSide - 1);
    const float ground = coarseGroundAt(lowest, x + margin, y + margin, neighbours, config).height;
    // A column that was seen through a gap, beside others of which only a ceiling was seen yet,
    // must not be lifted over its points: what lies below its bits is in no cell.
    anchor(column, std::min(ground, tile.lowest[column] + below));
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

void OnlineMap::addOccupied() {
  const BinaryEncoding encoding(config_.matrix);
  forEachTileRun(map_, placed_, [&](Tile* tile, std::size_t column, const ColumnRun& run) {
    const Bits bits = encoding.bits(placed_, run, tile->ground[column]);
    if ((bits & ~tile->occupied[column]) == 0) return;
    tile->occupied[column] |= bits;
    tile->unsettled = true;
  });
}

template <typename F>
void OnlineMap::addEvidence(F seen_at) {
  const Bits far_below = lowBits(config_.matrix.bits_below - 1);
  const ColumnWindow& window = hits_.window();
  forEachColumn(map_, window, [&](int x, int y, Tile& tile, std::size_t column) {
    const Seen seen = seen_at(x, y);
    const Bits observed = seen.hit | seen.free | seen.few;
    if (observed == 0) return;
    ColumnEvidence& evidence = tile.evidence.touch(column);
    evidence.observe(seen.hit, seen.free, seen.few);
    // Free space far below a column's ground says that it is none.
    if (seen.free != 0 && tile.lowest[column] != Tile::kNoHeight &&
        anySeenFree(evidence, seen.free & far_below, config_.evidence.min_free_in_order)) {
      lowered_.push_back({window.corner.x + x, window.corner.y + y});
    }
    if ((observed & tile.occupied[column]) == 0) return;
    const auto judged = [&] {
      return std::make_tuple(tile.suspected[column], tile.strong[column], tile.leaning[column],
                             tile.unknown[column], tile.flickering[column]);
    };
    const auto before = judged();
    judgement_.judgeEvidence(tile, column, observed);
    if (judged() != before) tile.unsettled = true;
  });
}

void OnlineMap::addHitEvidence() {
  const ColumnWindow window = seenRegion(placed_, config_.matrix);
  ground_ = map_.extract(window, &Tile::ground, Tile::kNoHeight, std::move(ground_));
  hits_ = encodeScan(placed_, ground_, config_.matrix, std::move(hits_));
  addEvidence([this](int x, int y) { return Seen{hits_.at(x, y), 0, 0}; });
}

void OnlineMap::addSeenFree() {
  StageClock clock(times_);
  beams_.fill(placed_);
  clock.lap("beam_image");
  const int height = static_cast<int>(config_.online.free_height / config_.matrix.res_h);
  const Bits remembered =
      lowBits(std::min(config_.matrix.bits_below + height, config_.matrix.n_bit));
  const int middle = hits_.size() / 2;
  for (Half& half : halves_) half.candidates.reset(hits_.window(), 0);
  forEachColumn(std::as_const(map_), hits_.window(),
                [&](int x, int y, const Tile& tile, std::size_t column) {
                  if (tile.ground[column] == Tile::kNoHeight) return;
                  halves_[x < middle ? 0 : 1].candidates.at(x, y) =
                      (tile.occupied[column] | remembered) & ~hits_.at(x, y);
                });
  clock.lap("matrix_comparison");
  inTwoThreads(halves_.size(), [&](std::size_t i) {
    Half& half = halves_[i];
    half.seen_free = cellsSeenFree(beams_, half.candidates, ground_, placed_, config_.matrix,
                                   config_.visibility, std::move(half.seen_free), &half.few);
  });
  clock.lap("beam_visibility");
  addEvidence([&](int x, int y) {
    const Half& half = halves_[x < middle ? 0 : 1];
    return Seen{0, half.seen_free.at(x, y), half.few.at(x, y)};
  });
  clock.lap("evidence");
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
  const std::vector<ColumnIndex> affected =
      withNeighbours(map_, changed, agreementMargin(config_.agreement));
  for (const ColumnIndex index : judgement_.judgeAgreement(map_, affected)) {
    ++map_.findTile(index)->revision;
  }
  inTwoThreads(affected.size(), [&](std::size_t i) {
    if (judgement_.segmentGround(map_, {affected[i]})) ++map_.findTile(affected[i])->revision;
  });
}

void OnlineMap::findDynamicInScan() {
  const ColumnWindow& window = hits_.window();
  const Bits above_ground = ~lowBits(config_.matrix.bits_below + 1);
  EvidenceWindow& cells = live_;
  for (BitGrid* grid :
       {&cells.occupied, &cells.leaning, &cells.unknown, &cells.flickering, &dynamic_in_scan_}) {
    grid->reset(window, 0);
  }
  forEachColumn(map_, window, [&](int x, int y, const Tile& tile, std::size_t column) {
    const Bits hit = hits_.at(x, y) & above_ground;
    if (hit == 0) return;
    const Bits dynamic = hit & tile.dynamic[column];
    cells.occupied.at(x, y) = hit;
    dynamic_in_scan_.at(x, y) = dynamic;
    cells.leaning.at(x, y) = hit & (tile.leaning[column] | tile.suspected[column]) & ~dynamic;
    cells.flickering.at(x, y) = hit & tile.flickering[column];
    const Bits unknown = hit & tile.unknown[column] & ~dynamic;
    if (unknown == 0) return;
    // What has been there for longer does not belong to what has just entered.
    const int longer = config_.online.live_unknown_hits;
    cells.unknown.at(x, y) = unknown & ~tile.evidence[column].hitMoreOften(longer);
  });
  // The finished map waits for more evidence; of an object that has just entered, the cells that
  // were never seen before are all that is known.
  AgreementConfig agreement = config_.agreement;
  agreement.unknown_share = config_.online.live_share;
  agreement.join_share = 1.5 * config_.online.live_share;
  agreement.join_rounds = config_.online.live_rounds;
  growObjects(cells, dynamic_in_scan_, config_.matrix.bits_below, agreement);
}

std::vector<PointClass> OnlineMap::classify(const Scan& scan) const {
  DroppedPoints dropped;
  PlacedScan placed = placeScan(scan, zOrigin(), config_.matrix.res_g, config_.scan, dropped);
  if (config_.levelling.enabled) level(placed, lowestOfColumns(placed, config_.levelling.radius));
  std::vector<PointClass> classes;
  judgement_.classify(map_, placed, classes);
  return classes;
}

void OnlineMap::classifyLive() {
  findDynamicInScan();
  const BitGrid& grown = dynamic_in_scan_;
  const ColumnIndex corner = grown.window().corner;
  classes_.assign(placed_.cloud_size, PointClass::kDropped);
  forEachTileRun(
      std::as_const(map_), placed_,
      [&](const Tile* tile, std::size_t column, const ColumnRun& run) {
        const int x = placed_.anchor.x + run.x - corner.x, y = placed_.anchor.y + run.y - corner.y;
        const Bits more = grown.inside(x, y) ? grown.at(x, y) & ~tile->dynamic[column] : Bits{0};
        const Bits dynamic = tile->dynamic[column] | more;
        const int ground_bins =
            more == 0 ? tile->static_bins[column] : judgement_.groundBins(*tile, column, dynamic);
        for (std::uint32_t i = run.begin; i < run.end; ++i) {
          const bool is_dynamic = dynamic != 0 && judgement_.isDynamic(*tile, column, placed_.z[i],
                                                                       dynamic, ground_bins);
          classes_[placed_.sourceOf(i)] = is_dynamic ? PointClass::kDynamic : PointClass::kStatic;
        }
      });
}

}  // namespace beautymap
