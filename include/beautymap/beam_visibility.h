// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "beautymap/column_grid.h"
#include "beautymap/config.h"
#include "beautymap/scan.h"

namespace beautymap {

/// The beams of one scan by direction: how many returned from each pixel of azimuth and slope
/// (height over horizontal distance), and the nearest return. Made from the points alone;
/// directions without a return are unknown.
class BeamImage {
 public:
  explicit BeamImage(const VisibilityConfig& config);

  /// Replaces the contents by the beams of a scan.
  void fill(const PlacedScan& scan);

  /// Azimuth of a direction in pixels. Not an angle but a monotonic function of it without
  /// trigonometry.
  float azimuthPixel(float x, float y) const;
  float slopePixel(float slope) const { return (slope - kMinSlope) * slope_scale_; }
  int azimuthPixels() const { return azimuth_pixels_; }
  int slopePixels() const { return slope_pixels_; }

  /// The pixels of one azimuth: counts of beams, and the nearest horizontal distance at which one
  /// ended [m].
  const std::uint16_t* counts(int azimuth) const { return counts_.data() + rowOf(azimuth); }
  const float* nearest(int azimuth) const { return nearest_.data() + rowOf(azimuth); }

 private:
  std::ptrdiff_t rowOf(int azimuth) const {
    return static_cast<std::ptrdiff_t>(azimuth) * slope_pixels_;
  }

  static constexpr float kMinSlope = -1.5F;
  static constexpr float kMaxSlope = 1.5F;

  int azimuth_pixels_;
  int slope_pixels_;
  float slope_scale_;
  std::vector<std::uint16_t> counts_;
  std::vector<float> nearest_;
  std::vector<std::uint32_t> used_;  ///< pixels with beams: only these are cleared
};

/// The candidates that the scan saw free: beams went through the cell's angular footprint, and
/// nearly all of those in it ended behind the cell.
BitGrid cellsSeenFree(const BeamImage& beams, const BitGrid& candidates, const HeightGrid& ground,
                      const PlacedScan& scan, const MatrixConfig& matrix,
                      const VisibilityConfig& config);

}  // namespace beautymap
