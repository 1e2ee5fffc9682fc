// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "beautymap/config/config.h"
#include "beautymap/matrix/sparse_columns.h"
#include "beautymap/matrix/tile_map.h"

namespace beautymap {

/// A cell above the ground that stays while something moved on its surface, and the heights of its
/// points: see FloorLayer.
struct FloorCell {
  static constexpr int kBins = 8;
  using Counts = std::array<std::uint32_t, kBins>;
  std::int32_t bit = -1;             ///< of the column; -1: none
  std::int32_t static_bins = kBins;  ///< bins, from below, that stay
  Counts counts{};                   ///< points per bin, since the cell is known as a floor
};
using FloorCells = SparseColumns<FloorCell, Tile::kColumns>;

/// The surface in a floor cell (a deck, a step, a storey's floor, on which something moved), from
/// the heights of the cell's points: what lies above it goes with the moving cell above.
class FloorLayer {
 public:
  FloorLayer(const GroundLayerConfig& config, const MatrixConfig& matrix);

  /// The bin of a height in its column, counted from the bottom of bit 0: kBins to each bit. -1
  /// below it, or where no ground is known.
  int binOf(float z, float ground) const {
    const float bin = (z - ground) * bins_per_metre_;
    return bin >= 0.0F ? static_cast<int>(std::min(bin, end_)) : -1;
  }
  /// How many bins of a cell, from below, stay: up to where the counts above their peak have fallen
  /// off. All, where the rest holds too much for the peak to be a surface.
  /// @param counts  points per bin
  int staticBins(const FloorCell::Counts& counts) const;

 private:
  float bins_per_metre_;
  float end_;
  int max_bins_above_peak_;
  double tail_share_;
  double min_contrast_;
};

/// The lowest cell above the ground cell that stays while the one on it is dynamic; -1: none.
int floorBit(Bits occupied, Bits dynamic, int ground_bit);

/// Notes the floor cells of a tile, whose points count from then on, and divides those that hold
/// counts.
/// @return  whether a cell is divided otherwise than before
bool findFloors(const Tile& tile, FloorCells& floors, const FloorLayer& layer, int ground_bit);

}  // namespace beautymap
