// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "beautymap/config/ground_config.h"
#include "beautymap/matrix/binary_encoding.h"
#include "beautymap/matrix/tile_map.h"

namespace beautymap {

/// The fine bins of the ground cell: of the lowest occupied cell, or of the same bit of each
/// column.
class FineGround {
 public:
  FineGround(const MatrixConfig& matrix, const FineGroundConfig& config);

  /// How many fine bins a cell has.
  int bins() const { return bins_; }
  /// The bin of a height above the bottom of its cell [m].
  int binInCell(float height_in_cell) const;
  /// The bin of a height in a column; -1 below its ground cell, bins() above.
  /// @param bottom  of bit 0 [m]
  int binOf(float z, float bottom, int ground_bit) const;
  /// Whether a height belongs to a dynamic cell of a column, or to the object in its ground cell.
  /// @param static_bins  of the ground cell; 0: all
  bool isDynamic(float z, float bottom, Bits dynamic, int static_bins, int ground_bit) const;

 private:
  BinaryEncoding encoding_;
  double res_h_;
  float bin_height_;
  int bins_;
};

/// How many bins, from below, are ground: up to the one at which the accumulated share of the
/// points reaches the ground points number ratio. The bins above are dynamic.
int groundBins(const std::uint32_t* counts, int bins, double ground_ratio);

/// Counts the heights of a scan's points, run by run.
/// @param counts  (tile, column) -> whether the column's heights count
/// @param bin_of  (tile, column, z) -> bin, monotonic in z; -1 or the number of bins: none
template <typename Counts, typename BinOf>
void countHeights(TileMap& map, const PlacedScan& scan, Counts counts, BinOf bin_of) {
  const int bins = map.fineBins();
  forEachTileRun(map, scan, [&](Tile* tile, std::size_t column, const ColumnRun& run) {
    if (!counts(*tile, column)) return;
    std::uint32_t* count = tile->fineCounts(column);
    const int lowest = bin_of(*tile, column, run.lowest);
    if (lowest >= bins) return;
    if (lowest >= 0 && lowest == bin_of(*tile, column, run.highest)) {
      count[lowest] += run.size();
      return;
    }
    for (std::uint32_t i = run.begin; i < run.end; ++i) {
      const int bin = bin_of(*tile, column, scan.z[i]);
      if (bin >= 0 && bin < bins) ++count[bin];
    }
  });
}

/// Fine ground segmentation: splits the ground cell (lowest occupied bit) of each column of a tile
/// whose upper neighbour is dynamic, by the counts of the points in the fine bins.
/// @param ground_bit  of every column; -1: each column's lowest occupied one
void segmentFineGround(Tile& tile, const FineGroundConfig& config, int ground_bit = -1);

}  // namespace beautymap
