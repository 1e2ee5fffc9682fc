// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>

#include "beautymap/config/ground_config.h"
#include "test_scenes.h"

namespace beautymap::test {

constexpr double kCell = 0.2;     ///< height of a cell [m]
constexpr double kBottom = -0.1;  ///< of the bins, above the coarse ground [m]

/// The heights are whole numbers of bins, so that nothing has to be rounded.
struct WholeBins {
  explicit WholeBins(Random& random) {
    config.bin_height = random.pick<double>({0.02, 0.05, 0.1});
    below = static_cast<int>(std::lround(-kBottom / config.bin_height));
    search = random.integer(1, 15);
    thickness = random.integer(1, 9);
    config.search_height = search * config.bin_height;
    config.max_thickness = thickness * config.bin_height;
    config.tail_share = random.pick<double>({0.0, 0.1, 0.25, 0.5, 1.0});
    config.min_low_peak = random.pick<double>({0.0, 0.25, 0.5, 1.0});
  }

  int bins() const { return below + search + thickness; }

  int groundBins(const std::uint32_t* counts, bool object_above) const {
    int peak = 0, low_peak = 0;
    for (int i = 1; i < below + search; ++i) {
      if (counts[i] > counts[peak]) peak = i;
      const bool in_cell = i < static_cast<int>(std::lround((kCell - kBottom) / config.bin_height));
      if (in_cell && counts[i] > counts[low_peak]) low_peak = i;
    }
    if (object_above && counts[low_peak] >= config.min_low_peak * counts[peak]) peak = low_peak;
    if (counts[peak] == 0) return 0;
    int ground = 0;
    for (int i = 0; i < bins(); ++i) {
      if (i > peak && counts[i] < config.tail_share * counts[peak]) break;
      if (i > peak + thickness) break;
      ground = i + 1;
    }
    return ground;
  }

  GroundLayerConfig config;
  int below = 0;
  int search = 0;
  int thickness = 0;
};

inline std::uint32_t randomCount(Random& random) {
  if (random.chance(0.3)) return 0;
  return static_cast<std::uint32_t>(random.integer(0, random.pick<int>({3, 20, 1000000})));
}

}  // namespace beautymap::test
