// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "beautymap/config/config.h"
#include "beautymap/ground/floor_layer.h"
#include "beautymap/ground/ground_layer.h"
#include "beautymap/matrix/binary_encoding.h"
#include "beautymap/matrix/scan.h"
#include "beautymap/matrix/tile_map.h"

namespace beautymap {

enum class PointClass : std::uint8_t {
  kStatic,
  kDynamic,
  kDropped,  ///< not part of the map: not finite, zero, or out of range
};

/// What the state of the map says about its cells and points: the part of the method that needs no
/// scan at hand. Works on any tiles, all of them or those that changed, in this order:
/// judgeEvidence, judgeAgreement, segmentGround.
class MapJudgement {
 public:
  explicit MapJudgement(const Config& config);

  /// How far bit 0 of a column lies below its coarse ground [m].
  float belowGround() const { return below_ground_; }
  /// How many bins per column a TileMap needs for the heights near the ground.
  int fineBins() const;

  /// Counts the heights of a scan's points near the ground of their columns; not in columns that
  /// are known to be flat.
  void countGroundPoints(TileMap& map, const PlacedScan& scan) const;
  /// Counts the heights of a scan's points in the floor cells that segmentGround() found.
  void countFloorPoints(TileMap& map, const PlacedScan& scan) const;

  /// Marks the cells that their own evidence holds for dynamic (Tile::suspected, Tile::strong).
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
  /// The same for the floor cells alone, when more was counted.
  bool segmentFloors(TileMap& map, const std::vector<ColumnIndex>& tiles) const;
  /// Whether floor cells are divided at all.
  bool usesFloors() const { return usesGroundLayer() && config_.ground_layer.floors; }

  /// Whether a point of a column is removed.
  /// @param z  its height [m] above the map's z origin
  bool isDynamic(const Tile& tile, std::size_t column, float z) const {
    return isDynamic(tile, column, z, tile.dynamic[column], tile.static_bins[column]);
  }
  /// The same with other dynamic cells in the column, and groundBins() of them.
  bool isDynamic(const Tile& tile, std::size_t column, float z, Bits dynamic,
                 int ground_bins) const;
  int groundBins(const Tile& tile, std::size_t column, Bits dynamic) const;

  /// Sets one class per point of the scan's cloud.
  void classify(const TileMap& map, const PlacedScan& scan, std::vector<PointClass>& classes) const;

 private:
  bool usesGroundLayer() const { return config_.evidence.enabled && config_.ground_layer.enabled; }
  /// The bit of a column's ground cell, which only the fine ground segmentation divides; -1 for an
  /// empty column.
  int groundBit(const Tile& tile, std::size_t column) const;
  /// judgeAgreement for tiles beside each other.
  std::vector<ColumnIndex> judgeBlock(TileMap& map, const std::vector<ColumnIndex>& block) const;
  /// Tile::dynamic as judgeAgreement finds it for some tiles; valid in these.
  BitGrid dynamicCellsOf(const TileMap& map, const std::vector<ColumnIndex>& tiles) const;
  /// Whether anything can depend on the counts of a column: the published method divides a ground
  /// cell only below an occupied one.
  bool countsGround(const Tile& tile, std::size_t column) const;
  /// The bin of a height in the column's histogram of ground heights; -1 outside.
  int groundBin(const Tile& tile, std::size_t column, float z) const {
    const int bin = usesGroundLayer() ? layerBin(tile, column, z) : fineBin(tile, column, z);
    return bin < tile.fineBins() ? bin : -1;
  }
  bool isAboveFloor(const Tile& tile, std::size_t column, float z, int bit) const;
  // groundBin(), but the number of bins above them: monotonic.
  int layerBin(const Tile& tile, std::size_t column, float z) const {
    return ground_layer_.binOf(z - tile.ground[column] - below_ground_);
  }
  int fineBin(const Tile& tile, std::size_t column, float z) const;

  Config config_;
  BinaryEncoding encoding_;
  GroundLayer ground_layer_;
  FloorLayer floor_layer_;
  float below_ground_;
};

/// All tiles of a map.
std::vector<ColumnIndex> tilesOf(const TileMap& map);

/// Tiles of a map and those within so many columns of each, each once.
std::vector<ColumnIndex> withNeighbours(const TileMap& map, const std::vector<ColumnIndex>& tiles,
                                        int columns);

}  // namespace beautymap
