// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "beautymap/config/config.h"
#include "beautymap/matrix/column_grid.h"
#include "beautymap/matrix/scan.h"

namespace beautymap {

/// Algorithm 1 of the paper: which bit of a column a height belongs to.
class BinaryEncoding {
 public:
  explicit BinaryEncoding(const MatrixConfig& config)
      : bits_per_metre_(static_cast<float>(1.0 / config.res_h)),
        top_bit_(static_cast<float>(config.n_bit - 1)) {}

  /// k = floor((z - ground) / res_h), at most the highest bit; -1 below ground or where no ground
  /// is known.
  int bitIndex(float z, float ground) const {
    const float k = (z - ground) * bits_per_metre_;
    return k >= 0.0F ? static_cast<int>(std::min(k, top_bit_)) : -1;
  }
  Bits bit(float z, float ground) const {
    const int k = bitIndex(z, ground);
    return k < 0 ? Bits{0} : Bits{1} << k;
  }
  /// The bits of all points of a run.
  Bits bits(const PlacedScan& scan, const ColumnRun& run, float ground) const {
    Bits column = bit(run.lowest, ground);
    if (bitIndex(run.lowest, ground) == bitIndex(run.highest, ground)) return column;
    for (std::uint32_t i = run.begin; i < run.end; ++i) column |= bit(scan.z[i], ground);
    return column;
  }

 private:
  float bits_per_metre_;
  float top_bit_;
};

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

/// The region of interest of a scan: the columns around its sensor in which it is compared with the
/// map.
ColumnWindow regionOfInterest(const PlacedScan& scan, const MatrixConfig& config);

/// The part of it that the scan's points reach: beyond, nothing was hit or seen free.
ColumnWindow seenRegion(const PlacedScan& scan, const MatrixConfig& config);

/// The scan's matrix M_scan in a window of the map, against the map's ground heights.
/// @param recycled  an earlier result whose memory is used again
BitGrid encodeScan(const PlacedScan& scan, const HeightGrid& map_ground, const MatrixConfig& config,
                   BitGrid recycled = {});

}  // namespace beautymap
