// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
// The judgement of a map of which all scans are known.
#include "beautymap/evidence/evidence_judgement.h"

#include <algorithm>
#include <utility>

#include "evidence_findings.h"

namespace beautymap {

EvidenceJudgement::EvidenceJudgement(const Config& config)
    : config_(config),
      encoding_(config.matrix),
      height_bins_(config.matrix),
      fine_ground_(config.matrix, config.fine_ground),
      ground_layer_(config.ground_layer, config.matrix.res_h),
      floor_layer_(config.ground_layer, config.matrix),
      below_ground_(depthBelowGround(config.matrix)),
      ground_bit_(config.matrix.bits_below) {}

TileMap EvidenceJudgement::newMap() const {
  const int bins = config_.ground_layer.enabled ? ground_layer_.bins() : fine_ground_.bins();
  return TileMap(bins, std::make_unique<EvidenceTile>());
}

std::unique_ptr<ScanFindings> EvidenceJudgement::newFindings() const {
  return std::make_unique<Findings>();
}

void EvidenceJudgement::observe(TileMap& map, const PlacedScan& scan) const {
  forEachTileRun(map, scan, [&](Tile* tile, std::size_t column, const ColumnRun& run) {
    EvidenceTile& state = evidenceTile(*tile);
    tile->lowest[column] = std::min(tile->lowest[column], run.lowest);
    state.highest[column] = std::max(state.highest[column], run.highest);
    state.possible[column] |= height_bins_.bins(scan, run);
  });
}

void EvidenceJudgement::useGround(TileMap& map) const {
  map.forEachTile([this](ColumnIndex, Tile& tile) { findPossibleCells(tile); });
}

void EvidenceJudgement::findPossibleCells(Tile& tile) const {
  EvidenceTile& state = evidenceTile(tile);
  for (std::size_t column = 0; column < Tile::kColumns; ++column) {
    const float ground = tile.ground[column];
    const int lowest = encoding_.bitIndex(tile.lowest[column], ground);
    const int highest = encoding_.bitIndex(state.highest[column], ground);
    Bits& possible = state.possible[column];
    if (lowest == ground_bit_ && highest == ground_bit_) {
      // The ground cell alone is never judged, only together with what is above it.
      state.flat.set(column);
      possible = 0;
      continue;
    }
    // That the ground cell was seen free says something about the points above it, also where it
    // holds none itself.
    const Bits occupied = lowBits(highest + 1) & ~lowBits(lowest);
    possible = height_bins_.possibleCells(possible, ground) & (occupied | Bits{1} << ground_bit_);
  }
}

std::vector<JudgementPass> EvidenceJudgement::passes() const {
  JudgementPass comparing;
  comparing.name = "comparing";
  comparing.needs_xy = true;
  comparing.look = [this](const TileMap& map, const PlacedScan& scan, ScanFindings& found,
                          StageClock& clock) {
    findFree(map, scan, static_cast<Findings&>(found), clock);
  };
  comparing.add = [this](TileMap& map, const PlacedScan& scan, const ScanFindings& found,
                         StageClock& clock) {
    countGroundPoints(map, scan);
    clock.lap("fine_ground");
    addEvidence(map, scan, static_cast<const Findings&>(found), clock);
  };
  comparing.conclude = [this](TileMap& map, StageClock& clock) { judge(map, clock); };
  if (!usesFloors()) return {comparing};
  // Which cells are floors is known only when all cells are judged.
  JudgementPass floors;
  floors.name = "measuring floors";
  floors.add = [this](TileMap& map, const PlacedScan& scan, const ScanFindings&,
                      StageClock& clock) {
    countFloorPoints(map, scan);
    clock.lap("floors");
  };
  floors.conclude = [this](TileMap& map, StageClock& clock) {
    segmentFloors(map, tilesOf(map));
    clock.lap("floors");
  };
  return {comparing, floors};
}

void EvidenceJudgement::findFree(const TileMap& map, const PlacedScan& scan, Findings& found,
                                 StageClock& clock) const {
  const ColumnWindow window = seenRegion(scan, config_.matrix);
  found.ground = map.extract(window, &Tile::ground, Tile::kNoHeight, std::move(found.ground));
  found.hit = encodeScan(scan, found.ground, config_.matrix, std::move(found.hit));
  clock.lap("binary_encoding");
  // Which cells will be occupied is known only when all scans are added.
  Findings::Seen& seen = found.seen.front();
  seen.candidates.reset(window, 0);
  forEachColumn(map, window, [&](int x, int y, const Tile& tile, std::size_t column) {
    seen.candidates.at(x, y) = evidenceTile(tile).possible[column] & ~found.hit.at(x, y);
  });
  clock.lap("matrix_comparison");
  found.fillBeams(scan, config_.visibility);
  clock.lap("beam_image");
  found.findSeen(seen, scan, config_);
  clock.lap("beam_visibility");
}

void EvidenceJudgement::addEvidence(TileMap& map, const PlacedScan& scan, const Findings& found,
                                    StageClock& clock) const {
  // Points beyond the window are in the map, too, though nothing is judged there.
  const ColumnWindow& window = found.hit.window();
  TileCursor<TileMap> tile_of(map);
  for (const ColumnRun& run : scan.runs) {
    const ColumnIndex index{scan.anchor.x + run.x, scan.anchor.y + run.y};
    if (window.contains(index)) continue;
    Tile& tile = *tile_of(index);
    const auto column = static_cast<std::size_t>(TileMap::indexInTile(index));
    tile.occupied[column] |= encoding_.bits(scan, run, tile.ground[column]);
  }
  clock.lap("binary_encoding");
  const Findings::Seen& seen = found.seen.front();
  forEachColumn(map, window, [&](int x, int y, Tile& tile, std::size_t column) {
    const Bits hit = found.hit.at(x, y);
    const Bits free = seen.free.at(x, y);
    const Bits few = seen.few.at(x, y);
    if ((hit | free | few) == 0) return;
    tile.occupied[column] |= hit;
    EvidenceTile& state = evidenceTile(tile);
    if (state.flat[column]) return;  // nothing would ask for it
    state.evidence.touch(column).observe(hit, free, few);
  });
  clock.lap("evidence");
}

void EvidenceJudgement::judge(TileMap& map, StageClock& clock) const {
  const std::vector<ColumnIndex> tiles = tilesOf(map);
  judgeEvidence(map, tiles);
  clock.lap("evidence");
  judgeAgreement(map, tiles);
  clock.lap("agreement");
  segmentGround(map, tiles);
  clock.lap("fine_ground");
}

}  // namespace beautymap
