// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/evidence/ground_under_objects.h"

#include <algorithm>

#include "beautymap/evidence/evidence_tile.h"

namespace beautymap {

bool mayBeObject(const ColumnEvidence& evidence, Bits dynamic, double min_contrast, int ground_bit,
                 const EvidenceConfig& config) {
  if (evidence.isStrong(ground_bit, config)) return true;
  if (evidence.hits(ground_bit) > config.unknown_hits) return false;
  // Noise of the poses spreads a ground over up to so many cells; what is dynamic above them is the
  // object.
  constexpr int kSpread = 3;
  int low = 0, high = 0;
  for (int bit = ground_bit; bit < kMaxBits; ++bit) {
    if (bit < ground_bit + kSpread) {
      low = std::max(low, evidence.hits(bit));
    } else if ((dynamic >> bit & 1) != 0) {
      high = std::max(high, evidence.hits(bit));
    }
  }
  return low < min_contrast * high;
}

int groundBinsOf(const Tile& tile, std::size_t column, Bits dynamic, const GroundLayer& layer,
                 int ground_bit, const EvidenceConfig& config) {
  const std::uint32_t* counts = tile.fineCounts(column);
  const bool object_above = (dynamic >> (ground_bit + 1) & 1) != 0;
  const bool is_ground = !object_above || layer.standsOut(counts) ||
                         !mayBeObject(evidenceTile(tile).evidence[column], dynamic,
                                      layer.minContrast(), ground_bit, config);
  return is_ground ? layer.groundBins(counts, object_above) : 0;
}

void findGroundLayers(Tile& tile, const GroundLayer& layer, int ground_bit,
                      const EvidenceConfig& evidence) {
  for (std::size_t i = 0; i < tile.static_bins.size(); ++i) {
    if (tile.dynamic[i] == 0) continue;
    tile.static_bins[i] = static_cast<std::uint16_t>(
        groundBinsOf(tile, i, tile.dynamic[i], layer, ground_bit, evidence));
  }
}

}  // namespace beautymap
