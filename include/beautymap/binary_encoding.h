// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "beautymap/column_grid.h"
#include "beautymap/config.h"
#include "beautymap/scan.h"

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

 private:
  float bits_per_metre_;
  float top_bit_;
};

/// Calls f(x, y, z) for each point of a scan: its column relative to the scan's anchor, its height
/// [m].
template <typename F>
void forEachColumnPoint(const PlacedScan& scan, double res_g, F f) {
  const float columns_per_metre = static_cast<float>(1.0 / res_g);
  for (const Eigen::Vector3f& p : scan.points) {
    f(floorToInt(p.x() * columns_per_metre), floorToInt(p.y() * columns_per_metre), p.z());
  }
}

/// The scan's matrix M_scan in a window of the map, against the map's ground heights.
BitGrid encodeScan(const PlacedScan& scan, const HeightGrid& map_ground,
                   const MatrixConfig& config);

}  // namespace beautymap
