// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "beautymap/config.h"
#include "beautymap/tile_map.h"

namespace beautymap {

/// The ground surface of a column, with its thickness (noise, slope, pose error), from the heights
/// of all points near its coarse ground. Other than a share of the points, a peak is not moved by
/// how many points an object left above it.
class GroundLayer {
 public:
  explicit GroundLayer(const GroundLayerConfig& config);

  int bins() const { return bins_; }
  /// The bin of a height above the column's coarse ground [m]; -1 below, bins() above all of them.
  int binOf(float above_ground) const;

  /// How many bins, from below, are ground: up to where the counts around the peak have fallen off.
  /// 0 without points.
  /// @param counts  points per bin
  int groundBins(const std::uint32_t* counts) const;

 private:
  int bins_;
  int search_bins_;
  int max_bins_above_peak_;
  float bottom_;
  float bins_per_metre_;
  double tail_share_;
};

/// Sets how many bins of each column of a tile are ground.
void findGroundLayers(Tile& tile, const GroundLayer& layer);

}  // namespace beautymap
