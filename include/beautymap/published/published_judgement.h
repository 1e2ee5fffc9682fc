// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "beautymap/config/config.h"
#include "beautymap/ground/fine_ground.h"
#include "beautymap/judgement/judgement.h"
#include "beautymap/matrix/binary_encoding.h"

namespace beautymap {

/// The method as published (RA-L 2024): each scan is compared with the map on its own, and what any
/// scan finds dynamic is removed.
///
/// A map that grows holds nothing yet where an object will come: cells are remembered as seen free
/// whether they are occupied or not, and what is in one that any scan saw free is dynamic. Up to
/// online.free_height above the bottom of the column.
class PublishedJudgement : public Judgement {
 public:
  explicit PublishedJudgement(const Config& config);

  TileMap newMap() const override;
  std::unique_ptr<ScanFindings> newFindings() const override;
  void place(PlacedScan& scan, StageClock& clock) const override;

  std::vector<JudgementPass> passes() const override;

  void addHits(TileMap& map, const PlacedScan& scan, ScanFindings& found,
               StageClock& clock) const override;
  void settle(TileMap& map, const std::vector<ColumnIndex>& changed) const override;
  std::vector<ColumnIndex> addSeenFree(TileMap& map, const PlacedScan& scan, ScanFindings& found,
                                       StageClock& clock) const override;
  bool anchor(Tile& tile, std::size_t column, float bottom) const override;

  bool isDynamic(const Tile& tile, std::size_t column, float z) const override;
  void classify(const TileMap& map, const PlacedScan& scan,
                std::vector<PointClass>& classes) const override;

 private:
  struct Findings;
  void encode(TileMap& map, const PlacedScan& scan) const;
  /// The map around the sensor, and the scan's matrix.
  void lookAround(const TileMap& map, const PlacedScan& scan, Findings& found,
                  StageClock& clock) const;
  void compare(const TileMap& map, const PlacedScan& scan, Findings& found,
               StageClock& clock) const;
  /// Takes the candidates away that the scan could not have seen.
  void restoreStatic(const PlacedScan& scan, Findings& found, StageClock& clock) const;
  template <typename Counts>
  void countGroundPoints(TileMap& map, const PlacedScan& scan, Counts counts) const;
  void addVotes(TileMap& map, const BitGrid& seen_free) const;
  /// The cells of a tile that got a vote, and the object points in its ground cells.
  void judge(Tile& tile) const;

  Config config_;
  BinaryEncoding encoding_;
  FineGround fine_ground_;
};

}  // namespace beautymap
