// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
// The judgement of a map that grows.
#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "beautymap/base/two_threads.h"
#include "beautymap/evidence/agreement.h"
#include "beautymap/evidence/ground_under_objects.h"
#include "beautymap/evidence/object_growth.h"
#include "beautymap/ground/ground_anchor.h"
#include "evidence_findings.h"

namespace beautymap {
namespace {

/// Free space that was seen in so many scans says that what lies above it is no ground.
constexpr int kNoGroundFrees = 5;

/// Whether any of these cells was seen free so often before its first hit, no more and no less.
bool anySeenFree(const ColumnEvidence& evidence, Bits cells, int times) {
  for (; cells != 0; cells &= cells - 1) {
    if (evidence.freeBefore(lowestBitIndex(cells)) == times) return true;
  }
  return false;
}

}  // namespace

/// What a scan says about the cells of one column.
struct EvidenceJudgement::Seen {
  Bits hit, free, few;
};

void EvidenceJudgement::addHits(TileMap& map, const PlacedScan& scan, ScanFindings& findings,
                                StageClock& clock) const {
  auto& found = static_cast<Findings&>(findings);
  forEachTileRun(map, scan, [&](Tile* tile, std::size_t column, const ColumnRun& run) {
    const Bits bits = encoding_.bits(scan, run, tile->ground[column]);
    if ((bits & ~tile->occupied[column]) == 0) return;
    tile->occupied[column] |= bits;
    tile->unsettled = true;
  });
  clock.lap("binary_encoding");
  countGroundPoints(map, scan);
  countFloorPoints(map, scan);
  clock.lap("fine_ground");
  const ColumnWindow window = seenRegion(scan, config_.matrix);
  found.ground = map.extract(window, &Tile::ground, Tile::kNoHeight, std::move(found.ground));
  found.hit = encodeScan(scan, found.ground, config_.matrix, std::move(found.hit));
  observeCells(map, window, [&](int x, int y) { return Seen{found.hit.at(x, y), 0, 0}; });
  clock.lap("evidence");
}

template <typename F>
std::vector<ColumnIndex> EvidenceJudgement::observeCells(TileMap& map, const ColumnWindow& window,
                                                         F seen_at) const {
  const Bits far_below = lowBits(ground_bit_ - 1);
  std::vector<ColumnIndex> no_ground;
  forEachColumn(map, window, [&](int x, int y, Tile& tile, std::size_t column) {
    const Seen seen = seen_at(x, y);
    const Bits observed = seen.hit | seen.free | seen.few;
    if (observed == 0) return;
    EvidenceTile& state = evidenceTile(tile);
    ColumnEvidence& evidence = state.evidence.touch(column);
    evidence.observe(seen.hit, seen.free, seen.few);
    // Free space far below a column's ground says that it is none.
    if (seen.free != 0 && tile.lowest[column] != Tile::kNoHeight &&
        anySeenFree(evidence, seen.free & far_below, kNoGroundFrees)) {
      no_ground.push_back({window.corner.x + x, window.corner.y + y});
    }
    if ((observed & tile.occupied[column]) == 0) return;
    const auto judged = [&] {
      return std::make_tuple(state.suspected[column], state.strong[column], state.leaning[column],
                             state.unknown[column], state.flickering[column]);
    };
    const auto before = judged();
    judgeEvidence(tile, column, observed);
    if (judged() != before) tile.unsettled = true;
  });
  return no_ground;
}

void EvidenceJudgement::settle(TileMap& map, const std::vector<ColumnIndex>& changed) const {
  const std::vector<ColumnIndex> affected =
      withNeighbours(map, changed, agreementMargin(config_.agreement));
  for (const ColumnIndex index : judgeAgreement(map, affected)) ++map.findTile(index)->revision;
  inTwoThreads(affected.size(), [&](std::size_t i) {
    if (segmentGround(map, {affected[i]})) ++map.findTile(affected[i])->revision;
  });
}

void EvidenceJudgement::findDynamicInScan(const TileMap& map, Findings& found) const {
  const ColumnWindow& window = found.hit.window();
  const Bits above_ground = ~lowBits(ground_bit_ + 1);
  EvidenceWindow& cells = found.live;
  for (BitGrid* grid :
       {&cells.occupied, &cells.leaning, &cells.unknown, &cells.flickering, &found.dynamic}) {
    grid->reset(window, 0);
  }
  forEachColumn(map, window, [&](int x, int y, const Tile& tile, std::size_t column) {
    const Bits hit = found.hit.at(x, y) & above_ground;
    if (hit == 0) return;
    const EvidenceTile& state = evidenceTile(tile);
    const Bits dynamic = hit & tile.dynamic[column];
    cells.occupied.at(x, y) = hit;
    found.dynamic.at(x, y) = dynamic;
    cells.leaning.at(x, y) = hit & (state.leaning[column] | state.suspected[column]) & ~dynamic;
    cells.flickering.at(x, y) = hit & state.flickering[column];
    const Bits unknown = hit & state.unknown[column] & ~dynamic;
    if (unknown == 0) return;
    // What has been there for longer does not belong to what has just entered.
    const int longer = config_.online.live_unknown_hits;
    cells.unknown.at(x, y) = unknown & ~state.evidence[column].hitMoreOften(longer);
  });
  // The finished map waits for more evidence; of an object that has just entered, the cells that
  // were never seen before are all that is known.
  AgreementConfig agreement = config_.agreement;
  agreement.unknown_share = config_.online.live_share;
  agreement.join_share = 1.5 * config_.online.live_share;
  agreement.join_rounds = config_.online.live_rounds;
  growObjects(cells, found.dynamic, ground_bit_, agreement);
}

void EvidenceJudgement::classifyLatest(const TileMap& map, const PlacedScan& scan,
                                       ScanFindings& findings,
                                       std::vector<PointClass>& classes) const {
  auto& found = static_cast<Findings&>(findings);
  findDynamicInScan(map, found);
  const BitGrid& grown = found.dynamic;
  const ColumnIndex corner = grown.window().corner;
  classes.assign(scan.cloud_size, PointClass::kDropped);
  forEachTileRun(map, scan, [&](const Tile* tile, std::size_t column, const ColumnRun& run) {
    const int x = scan.anchor.x + run.x - corner.x, y = scan.anchor.y + run.y - corner.y;
    const Bits more = grown.inside(x, y) ? grown.at(x, y) & ~tile->dynamic[column] : Bits{0};
    const Bits dynamic = tile->dynamic[column] | more;
    int ground_bins = tile->static_bins[column];
    if (more != 0 && config_.ground_layer.enabled) {
      ground_bins =
          groundBinsOf(*tile, column, dynamic, ground_layer_, ground_bit_, config_.evidence);
    }
    for (std::uint32_t i = run.begin; i < run.end; ++i) {
      const bool is_dynamic =
          dynamic != 0 && isDynamic(*tile, column, scan.z[i], dynamic, ground_bins);
      classes[scan.sourceOf(i)] = is_dynamic ? PointClass::kDynamic : PointClass::kStatic;
    }
  });
}

std::vector<ColumnIndex> EvidenceJudgement::addSeenFree(TileMap& map, const PlacedScan& scan,
                                                        ScanFindings& findings,
                                                        StageClock& clock) const {
  auto& found = static_cast<Findings&>(findings);
  found.fillBeams(scan, config_.visibility);
  clock.lap("beam_image");
  const auto height = static_cast<int>(config_.online.free_height / config_.matrix.res_h);
  const Bits remembered = lowBits(std::min(ground_bit_ + height, config_.matrix.n_bit));
  const ColumnWindow& window = found.hit.window();
  const int middle = window.size / 2;
  for (auto& half : found.seen) half.candidates.reset(window, 0);
  forEachColumn(std::as_const(map), window,
                [&](int x, int y, const Tile& tile, std::size_t column) {
                  if (tile.ground[column] == Tile::kNoHeight) return;
                  found.seen[x < middle ? 0 : 1].candidates.at(x, y) =
                      (tile.occupied[column] | remembered) & ~found.hit.at(x, y);
                });
  clock.lap("matrix_comparison");
  inTwoThreads(found.seen.size(),
               [&](std::size_t i) { found.findSeen(found.seen[i], scan, config_); });
  clock.lap("beam_visibility");
  auto no_ground = observeCells(map, window, [&](int x, int y) {
    const auto& half = found.seen[x < middle ? 0 : 1];
    return Seen{0, half.free.at(x, y), half.few.at(x, y)};
  });
  clock.lap("evidence");
  return no_ground;
}

bool EvidenceJudgement::hangsOverFreeSpace(const Tile& tile, std::size_t column) const {
  const auto& columns = evidenceTile(tile).evidence;
  if (columns.empty() || tile.ground[column] == Tile::kNoHeight) return false;
  // One cell below a surface is still in the footprint of beams that graze it.
  const int below = encoding_.bitIndex(tile.lowest[column], tile.ground[column]) - 1;
  if (below <= 0) return false;
  const ColumnEvidence& evidence = columns[column];
  Bits rest = evidence.everFree() & ~tile.occupied[column] & lowBits(below);
  for (; rest != 0; rest &= rest - 1) {
    if (evidence.freeBefore(lowestBitIndex(rest)) >= kNoGroundFrees) return true;
  }
  return false;
}

bool EvidenceJudgement::anchor(Tile& tile, std::size_t column, float bottom) const {
  EvidenceTile& state = evidenceTile(tile);
  const bool cells_known = tile.occupied[column] != 0 || state.evidence.has(column);
  const int bits =
      anchorColumn(tile, column, bottom, config_.online.ground_drift, cells_known, config_.matrix);
  if (bits == 0) return false;
  const Bits mask = lowBits(config_.matrix.n_bit);
  for (auto* cells :
       {&state.suspected, &state.strong, &state.leaning, &state.unknown, &state.flickering}) {
    (*cells)[column] = shifted((*cells)[column], bits) & mask;
  }
  if (state.evidence.has(column)) state.evidence.touch(column).shift(bits, mask);
  if (state.floors.has(column)) state.floors.touch(column).bit += bits;
  // Without a ground layer the bins divide one cell: they belong to another one now.
  const double up = bits * config_.matrix.res_h;
  shiftCounts(tile, column,
              config_.ground_layer.enabled ? std::lround(up / config_.ground_layer.bin_height)
                                           : tile.fineBins());
  // Another cell is the ground's now, and what was taken for ground may be an object.
  if (!state.evidence.empty()) judgeEvidence(tile, column, ~Bits{0});
  return true;
}

}  // namespace beautymap
