// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>

#include "beautymap/config/config.h"
#include "beautymap/matrix/tile_map.h"

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

/// Whether the ground cell below an object may hold the object's lower end and no ground: its own
/// evidence for that is strong; or it is hardly known, and the lowest cells were hit in less than
/// min_contrast times the scans that hit the object above them. So a flight of stairs is seen from
/// below, where no beam meets the steps: people's feet are the lowest points then.
bool mayBeObject(const ColumnEvidence& evidence, Bits dynamic, double min_contrast, int ground_bit,
                 const EvidenceConfig& config);

/// How many bins of a column with these dynamic cells are ground. None where all speaks against
/// ground: the cell above is dynamic, the ground cell may be of an object, and no surface stands
/// out in it.
int groundBinsOf(const Tile& tile, std::size_t column, Bits dynamic, const GroundLayer& layer,
                 int ground_bit, const EvidenceConfig& evidence);

/// Sets how many bins are ground in the columns of a tile that have dynamic cells; in the others
/// nothing depends on it.
void findGroundLayers(Tile& tile, const GroundLayer& layer, int ground_bit,
                      const EvidenceConfig& evidence);

}  // namespace beautymap
