// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/ground/fine_ground.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace beautymap {

FineGround::FineGround(const MatrixConfig& matrix, const FineGroundConfig& config)
    : encoding_(matrix),
      res_h_(matrix.res_h),
      bin_height_(static_cast<float>(config.bin_height)),
      // The small amount keeps 0.2 / 0.1 from becoming 3.
      bins_(static_cast<int>(std::ceil(matrix.res_h / config.bin_height - 1e-6))) {}

int FineGround::binInCell(float height_in_cell) const {
  return static_cast<int>(
      std::clamp(height_in_cell / bin_height_, 0.0F, static_cast<float>(bins_ - 1)));
}

int FineGround::binOf(float z, float bottom, int ground_bit) const {
  const int bit = encoding_.bitIndex(z, bottom);
  if (bit < 0 || bit < ground_bit) return -1;
  if (bit > ground_bit) return bins_;
  return binInCell(z - (bottom + static_cast<float>(bit * res_h_)));
}

bool FineGround::isDynamic(float z, float bottom, Bits dynamic, int static_bins,
                           int ground_bit) const {
  const int bit = dynamic == 0 ? -1 : encoding_.bitIndex(z, bottom);
  if (bit < 0) return false;
  if ((dynamic >> bit & 1) != 0) return true;
  return bit == ground_bit && static_bins > 0 && binOf(z, bottom, ground_bit) >= static_bins;
}

int groundBins(const std::uint32_t* counts, int bins, double ground_ratio) {
  const double all = std::accumulate(counts, counts + bins, 0.0);
  double from_below = 0.0;
  for (int bin = 0; bin < bins; ++bin) {
    from_below += counts[bin];
    // Counts are whole numbers; the small amount keeps 0.55 * 100 from being more than 55.
    if (from_below >= ground_ratio * all - 1e-6) return bin + 1;
  }
  return bins;
}

void segmentFineGround(Tile& tile, const FineGroundConfig& config, int ground_bit) {
  const int bins = tile.fineBins();
  for (std::size_t i = 0; i < tile.occupied.size(); ++i) {
    const Bits ground_cell = ground_bit < 0 ? lowestBit(tile.occupied[i]) : Bits{1} << ground_bit;
    const Bits above_ground_cell = ground_cell << 1;
    tile.static_bins[i] = 0;
    if ((tile.dynamic[i] & above_ground_cell) == 0) continue;
    const std::uint32_t* counts = tile.fineCounts(i);
    tile.static_bins[i] = static_cast<std::uint16_t>(groundBins(counts, bins, config.ground_ratio));
  }
}

}  // namespace beautymap
