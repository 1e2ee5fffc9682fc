// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/published/sight_mask.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace beautymap {
namespace {

// A quantile needs no more.
constexpr std::size_t kSlopeSamples = 1 << 14;

/// The point that stands for the n-th stretch of points. Scattered, because a regular step would
/// meet the same beams again and again in the sensor's firing order.
std::size_t sampleOf(std::size_t n, std::size_t stretch) {
  const std::uint64_t scattered = (n + 1) * 0x9E3779B97F4A7C15ULL;
  return n * stretch + static_cast<std::size_t>(scattered >> 33) % stretch;
}

}  // namespace

float steepestSlope(const PlacedScan& scan, double share) {
  const std::size_t stretch = share < 1.0 ? 1 + scan.size() / kSlopeSamples : 1;
  std::vector<float> slopes;
  slopes.reserve(scan.size() / stretch + 1);
  for (std::size_t n = 0; n * stretch < scan.size(); ++n) {
    const std::size_t sample = std::min(sampleOf(n, stretch), scan.size() - 1);
    const Eigen::Vector3f ray = scan.point(sample) - scan.sensor;
    const float distance = ray.head<2>().norm();
    if (distance > 0.0F) slopes.push_back(ray.z() / distance);
  }
  if (slopes.empty()) return -std::numeric_limits<float>::infinity();
  const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(slopes.size() - 1));
  // From the top, where only few are sorted.
  const auto above = static_cast<std::ptrdiff_t>(slopes.size()) - rank;
  std::partial_sort(slopes.begin(), slopes.begin() + above, slopes.end(), std::greater<>());
  return slopes[static_cast<std::size_t>(above) - 1];
}

BitGrid cellsInSight(const PlacedScan& scan, const BitGrid& scan_bits, const MapWindow& map,
                     const MatrixConfig& matrix, const RestorationConfig& config) {
  const float slope = scan.steepest_slope;
  const Bits ground_bit = Bits{1} << matrix.bits_below;
  const Bits above = ~lowBits(matrix.bits_below + 1);
  BitGrid in_sight(scan_bits.window(), 0);
  if (!std::isfinite(slope)) return in_sight;
  const float res_g = static_cast<float>(matrix.res_g);
  const float res_h = static_cast<float>(matrix.res_h);
  const ColumnWindow& window = scan_bits.window();
  for (int x = 0; x < window.size; ++x) {
    const float dx =
        (static_cast<float>(window.corner.x - scan.anchor.x + x) + 0.5F) * res_g - scan.sensor.x();
    for (int y = 0; y < window.size; ++y) {
      const Bits occupied = map.occupied.at(x, y);
      if (occupied == 0) continue;
      const float dy = (static_cast<float>(window.corner.y - scan.anchor.y + y) + 0.5F) * res_g -
                       scan.sensor.y();
      const float distance = std::hypot(dx, dy);
      if (distance < static_cast<float>(config.blind_radius)) continue;
      const Bits hits = scan_bits.at(x, y);
      if ((hits & ground_bit) == 0 && distance > static_cast<float>(config.sight_range)) continue;
      const Bits above_ground = hits & above;
      if (above_ground != 0 && map.below_ground.at(x, y) == 0) {
        in_sight.at(x, y) = lowBits(highestBitIndex(above_ground));
        continue;
      }
      const float top = scan.sensor.z() + slope * distance - map.ground.at(x, y);
      in_sight.at(x, y) = lowBits(
          static_cast<int>(std::ceil(std::clamp(top / res_h, 0.0F, static_cast<float>(kMaxBits)))));
    }
  }
  return in_sight;
}

}  // namespace beautymap
