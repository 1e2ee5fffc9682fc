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

/// How far bit 0 of a column lies below its coarse ground [m].
float depthBelowGround(const MatrixConfig& config);

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
