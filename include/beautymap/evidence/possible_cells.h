// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "beautymap/config/matrix_config.h"
#include "beautymap/matrix/column_grid.h"
#include "beautymap/matrix/scan.h"

namespace beautymap {

/// Which cells of a column can hold points, noted before its ground is known: heights in bins of
/// res_h above the map's z origin, modulo 64.
class HeightBins {
 public:
  explicit HeightBins(const MatrixConfig& config)
      : bits_per_metre_(static_cast<float>(1.0 / config.res_h)), n_bit_(config.n_bit) {}

  Bits bin(float z) const { return Bits{1} << (indexOf(z) & (kMaxBits - 1)); }
  /// The bins of all points of a run.
  Bits bins(const PlacedScan& scan, const ColumnRun& run) const {
    Bits column = bin(run.lowest);
    if (indexOf(run.lowest) == indexOf(run.highest)) return column;
    for (std::uint32_t i = run.begin; i < run.end; ++i) column |= bin(scan.z[i]);
    return column;
  }

  /// A superset of a column's occupied bits: a cell overlaps two bins, heights beyond the column
  /// wrap around into it, and the top bit stands for everything above. (Only a point within
  /// float's rounding of a cell's border may be missing.)
  Bits possibleCells(Bits bins, float ground) const {
    if (bins == 0) return 0;
    const Bits first = rotatedRight(bins, indexOf(ground));
    return (first | rotatedRight(first, 1) | Bits{1} << (n_bit_ - 1)) & lowBits(n_bit_);
  }

 private:
  int indexOf(float z) const {
    constexpr float kLimit = 1e9F;  // casting more to int is undefined
    return floorToInt(std::clamp(z * bits_per_metre_, -kLimit, kLimit));
  }
  static Bits rotatedRight(Bits bits, int by) {
    const int shift = by & (kMaxBits - 1);
    return shift == 0 ? bits : bits >> shift | bits << (kMaxBits - shift);
  }

  float bits_per_metre_;
  int n_bit_;
};

}  // namespace beautymap
