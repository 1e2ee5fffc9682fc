// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/ground/floor_layer.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "beautymap/ground/ground_layer.h"

namespace beautymap {

FloorLayer::FloorLayer(const GroundLayerConfig& config, const MatrixConfig& matrix)
    : bins_per_metre_(static_cast<float>(FloorCell::kBins / matrix.res_h)),
      end_(static_cast<float>(FloorCell::kBins * matrix.n_bit)),
      max_bins_above_peak_(std::max(
          1,
          static_cast<int>(std::lround(config.max_thickness * FloorCell::kBins / matrix.res_h)))),
      tail_share_(config.tail_share),
      min_contrast_(config.min_contrast) {}

int FloorLayer::staticBins(const FloorCell::Counts& counts) const {
  const auto* begin = counts.data();
  const auto* end = begin + counts.size();
  const auto* peak = std::max_element(begin, end);
  if (*peak == 0) return FloorCell::kBins;
  const auto* last = std::min(end - 1, peak + max_bins_above_peak_);
  const auto* above = topOfLayer(peak, last, tail_share_) + 1;
  const double rest = std::accumulate(above, end, 0.0);
  // Of a wall or a bush every bin holds as much as the next.
  const bool is_surface = *peak * static_cast<double>(end - above) >= min_contrast_ * rest;
  return is_surface ? static_cast<int>(above - begin) : FloorCell::kBins;
}

int floorBit(Bits occupied, Bits dynamic, int ground_bit) {
  const Bits floors = occupied & ~dynamic & dynamic >> 1 & ~lowBits(ground_bit + 1);
  return floors == 0 ? -1 : lowestBitIndex(floors);
}

bool findFloors(const Tile& tile, FloorCells& floors, const FloorLayer& layer, int ground_bit) {
  bool changed = false;
  for (std::size_t column = 0; column < Tile::kColumns; ++column) {
    if (tile.dynamic[column] == 0) continue;  // nothing depends on its floor
    const int bit = floorBit(tile.occupied[column], tile.dynamic[column], ground_bit);
    if (bit < 0) continue;
    FloorCell& floor = floors.touch(column);
    const FloorCell before = floor;
    if (floor.bit != bit) floor = {bit};
    floor.static_bins = layer.staticBins(floor.counts);
    changed |= floor.bit != before.bit || floor.static_bins != before.static_bins;
  }
  return changed;
}

}  // namespace beautymap
