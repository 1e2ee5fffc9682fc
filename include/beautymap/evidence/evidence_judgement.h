// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "beautymap/config/config.h"
#include "beautymap/evidence/evidence_tile.h"
#include "beautymap/evidence/possible_cells.h"
#include "beautymap/ground/fine_ground.h"
#include "beautymap/ground/floor_layer.h"
#include "beautymap/ground/ground_layer.h"
#include "beautymap/judgement/judgement.h"
#include "beautymap/matrix/binary_encoding.h"

namespace beautymap {

/// Beyond the paper: a cell is judged by in how many scans it was hit and seen free, in their
/// order, and by its neighbours. In a finished map only cells that hold points are looked at; in
/// one that grows those up to online.free_height are seen free before anything is in them.
class EvidenceJudgement : public Judgement {
 public:
  explicit EvidenceJudgement(const Config& config);

  TileMap newMap() const override;
  std::unique_ptr<ScanFindings> newFindings() const override;

  void observe(TileMap& map, const PlacedScan& scan) const override;
  void useGround(TileMap& map) const override;
  std::vector<JudgementPass> passes() const override;

  void addHits(TileMap& map, const PlacedScan& scan, ScanFindings& found,
               StageClock& clock) const override;
  void settle(TileMap& map, const std::vector<ColumnIndex>& changed) const override;
  void classifyLatest(const TileMap& map, const PlacedScan& scan, ScanFindings& found,
                      std::vector<PointClass>& classes) const override;
  std::vector<ColumnIndex> addSeenFree(TileMap& map, const PlacedScan& scan, ScanFindings& found,
                                       StageClock& clock) const override;
  bool hangsOverFreeSpace(const Tile& tile, std::size_t column) const override;
  bool anchor(Tile& tile, std::size_t column, float bottom) const override;

  bool isDynamic(const Tile& tile, std::size_t column, float z) const override;
  void classify(const TileMap& map, const PlacedScan& scan,
                std::vector<PointClass>& classes) const override;

  // What the above consists of.

  /// Counts the heights of a scan's points near the ground of their columns; not in columns that
  /// are known to be flat.
  void countGroundPoints(TileMap& map, const PlacedScan& scan) const;
  /// Counts the heights of a scan's points in the floor cells that segmentGround() found.
  void countFloorPoints(TileMap& map, const PlacedScan& scan) const;
  /// Marks the cells that their own evidence holds for dynamic (EvidenceTile::suspected ...).
  void judgeEvidence(TileMap& map, const std::vector<ColumnIndex>& tiles) const;
  /// The same for some cells of one column, which has evidence.
  void judgeEvidence(Tile& tile, std::size_t column, Bits cells) const;
  /// Tile::dynamic: the suspected cells that their neighbours support. The tiles beside those that
  /// judgeEvidence changed depend on them, too: see withNeighbours().
  /// @return  those of the tiles in which it changed
  std::vector<ColumnIndex> judgeAgreement(TileMap& map, std::vector<ColumnIndex> tiles) const;
  /// Divides the ground cells of columns with dynamic cells, and floor cells by what was counted
  /// until now, into points of the surface and of the object on it.
  /// @return  whether any cell is divided otherwise than before
  bool segmentGround(TileMap& map, const std::vector<ColumnIndex>& tiles) const;

 private:
  struct Findings;

  /// When a tile's ground is known: the cells that can be judged.
  void findPossibleCells(Tile& tile) const;
  /// What one scan of a finished map saw free.
  void findFree(const TileMap& map, const PlacedScan& scan, Findings& found,
                StageClock& clock) const;
  void addEvidence(TileMap& map, const PlacedScan& scan, const Findings& found,
                   StageClock& clock) const;
  void judge(TileMap& map, StageClock& clock) const;

  bool segmentFloors(TileMap& map, const std::vector<ColumnIndex>& tiles) const;
  bool usesFloors() const { return config_.ground_layer.enabled && config_.ground_layer.floors; }
  /// judgeAgreement for tiles beside each other.
  std::vector<ColumnIndex> judgeBlock(TileMap& map, const std::vector<ColumnIndex>& block) const;
  /// Tile::dynamic as judgeAgreement finds it for some tiles; valid in these.
  BitGrid dynamicCellsOf(const TileMap& map, const std::vector<ColumnIndex>& tiles) const;

  /// isDynamic() with other dynamic cells in the column, and how many bins are ground then.
  bool isDynamic(const Tile& tile, std::size_t column, float z, Bits dynamic,
                 int ground_bins) const;
  bool isAboveFloor(const Tile& tile, std::size_t column, float z, int bit) const;
  int layerBin(const Tile& tile, std::size_t column, float z) const {
    return ground_layer_.binOf(z - tile.ground[column] - below_ground_);
  }

  // A map that grows.
  struct Seen;
  /// @param seen_at  (x, y in the window) -> Seen
  /// @return  columns whose lowest points turned out to be no ground
  template <typename F>
  std::vector<ColumnIndex> observeCells(TileMap& map, const ColumnWindow& window, F seen_at) const;
  /// The dynamic cells of the latest scan: those of the map, and what of the scan belongs to them.
  void findDynamicInScan(const TileMap& map, Findings& found) const;

  Config config_;
  BinaryEncoding encoding_;
  HeightBins height_bins_;
  FineGround fine_ground_;
  GroundLayer ground_layer_;
  FloorLayer floor_layer_;
  float below_ground_;
  int ground_bit_;
};

}  // namespace beautymap
