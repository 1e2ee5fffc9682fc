// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>

#include "beautymap/config/config.h"

namespace beautymap {

/// The ground surface of a column, with its thickness (noise, slope, pose error), from the heights
/// of all points near its coarse ground. Other than a share of the points, a peak is not moved by
/// how many points an object left above it.
class GroundLayer {
 public:
  /// @param cell_height  [m] of the ground cell and the one above it
  GroundLayer(const GroundLayerConfig& config, double cell_height);

  int bins() const { return bins_; }
  /// The bin of a height above the column's coarse ground [m]; -1 below, bins() above all of them.
  int binOf(float above_ground) const {
    const float bin = (above_ground - bottom_) * bins_per_metre_;
    // Written so that NaN is below.
    return bin >= 0.0F ? static_cast<int>(std::min(bin, static_cast<float>(bins_))) : -1;
  }

  /// How many bins, from below, are ground: up to where the counts around the peak have fallen off.
  /// 0 without points. Where an object was above the ground cell its points can outnumber those of
  /// the ground: then a lower peak in the ground cell will do.
  /// @param counts  points per bin
  int groundBins(const std::uint32_t* counts, bool object_above) const;

  /// Whether the ground cell holds so many more points than the one above that a surface is in it,
  /// and not just the lower end of an object in a column whose ground no beam ever met.
  bool standsOut(const std::uint32_t* counts) const;
  double minContrast() const { return min_contrast_; }

 private:
  int bins_;
  int search_bins_;
  int max_bins_above_peak_;
  float bottom_;
  float bins_per_metre_;
  double tail_share_;
  double min_low_peak_;
  double min_contrast_;
  // The ground cell's bins, and those of the cell above it.
  int cell_begin_;
  int cell_end_;
  int above_end_;
};

/// The highest bin of a surface's layer: from the peak of the counts up to where they have fallen
/// below a share of it, at most to the last bin.
const std::uint32_t* topOfLayer(const std::uint32_t* peak, const std::uint32_t* last,
                                double tail_share);

}  // namespace beautymap
