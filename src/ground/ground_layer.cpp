// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/ground/ground_layer.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace beautymap {
namespace {

// The coarse ground is a lowest height; with noise some points lie below it.
constexpr double kBelow = 0.1;  // [m]

int binsIn(double height, double bin_height) {
  return std::max(1, static_cast<int>(std::lround(height / bin_height)));
}

}  // namespace

GroundLayer::GroundLayer(const GroundLayerConfig& config, double cell_height)
    : bins_(binsIn(kBelow + config.search_height + config.max_thickness, config.bin_height)),
      search_bins_(binsIn(kBelow + config.search_height, config.bin_height)),
      max_bins_above_peak_(binsIn(config.max_thickness, config.bin_height)),
      bottom_(static_cast<float>(-kBelow)),
      bins_per_metre_(static_cast<float>(1.0 / config.bin_height)),
      tail_share_(config.tail_share),
      min_low_peak_(config.min_low_peak),
      min_contrast_(config.min_contrast),
      cell_begin_(std::min(binsIn(kBelow, config.bin_height), bins_)),
      cell_end_(std::min(binsIn(kBelow + cell_height, config.bin_height), bins_)),
      above_end_(std::min(binsIn(kBelow + 2.0 * cell_height, config.bin_height), bins_)) {}

int GroundLayer::groundBins(const std::uint32_t* counts, bool object_above) const {
  const auto* peak = std::max_element(counts, counts + search_bins_);
  if (object_above) {
    const auto* low_peak = std::max_element(counts, counts + std::min(cell_end_, search_bins_));
    if (*low_peak >= min_low_peak_ * *peak) peak = low_peak;
  }
  if (*peak == 0) return 0;
  const auto* last = std::min(counts + bins_ - 1, peak + max_bins_above_peak_);
  return static_cast<int>(topOfLayer(peak, last, tail_share_) - counts) + 1;
}

bool GroundLayer::standsOut(const std::uint32_t* counts) const {
  const auto mean = [&](int begin, int end) {
    return std::accumulate(counts + begin, counts + end, 0.0) / std::max(1, end - begin);
  };
  return mean(cell_begin_, cell_end_) >= min_contrast_ * mean(cell_end_, above_end_);
}

const std::uint32_t* topOfLayer(const std::uint32_t* peak, const std::uint32_t* last,
                                double tail_share) {
  const double tail = tail_share * *peak;
  const auto* top = peak;
  while (top < last && top[1] >= tail) ++top;
  return top;
}

}  // namespace beautymap
