// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/ground/coarse_ground.h"

#include <algorithm>
#include <cmath>

namespace beautymap {
namespace {

/// The median as NumPy defines it: the mean of the two middle values when their number is even.
float medianOf(std::vector<float>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5F * (*middle + *std::max_element(values.begin(), middle));
}

/// Of a wide square every second column of every second row is enough for a quantile.
constexpr int kWideStep = 2;

/// Puts the heights of the columns around one into a vector.
void gather(const HeightGrid& lowest, int x, int y, int radius, int step,
            std::vector<float>& heights) {
  heights.clear();
  for (int dx = -radius; dx <= radius; dx += step) {
    for (int dy = -radius; dy <= radius; dy += step) {
      const float height = lowest.at(x + dx, y + dy);
      if (height != Tile::kNoHeight && (dx != 0 || dy != 0)) heights.push_back(height);
    }
  }
}

bool enoughNeighbours(const std::vector<float>& neighbours, int possible,
                      const CoarseGroundConfig& config) {
  return !neighbours.empty() &&
         static_cast<double>(neighbours.size()) >= config.min_share * possible;
}

void estimateTile(const HeightGrid& lowest, Tile& tile, const CoarseGroundConfig& config) {
  const int margin = coarseGroundMargin(config);
  std::vector<float> neighbours;
  for (int x = 0; x < Tile::kSide; ++x) {
    for (int y = 0; y < Tile::kSide; ++y) {
      const std::size_t column = static_cast<std::size_t>(x << Tile::kShift | y);
      if (tile.lowest[column] == Tile::kNoHeight) continue;
      const GroundEstimate estimate =
          coarseGroundAt(lowest, x + margin, y + margin, neighbours, config);
      tile.ground[column] = estimate.height;
      tile.below_ground[column] = estimate.below_ground;
    }
  }
}

void setFlatGround(TileMap& map) {
  float lowest = Tile::kNoHeight;
  map.forEachTile([&](ColumnIndex, const Tile& tile) {
    lowest = std::min(lowest, *std::min_element(tile.lowest.begin(), tile.lowest.end()));
  });
  map.forEachTile([&](ColumnIndex, Tile& tile) {
    for (std::size_t i = 0; i < tile.ground.size(); ++i) {
      if (tile.lowest[i] != Tile::kNoHeight) tile.ground[i] = lowest;
    }
  });
}

}  // namespace

GroundEstimate coarseGroundOf(float lowest, std::vector<float>& neighbours, int possible,
                              const CoarseGroundConfig& config) {
  if (!enoughNeighbours(neighbours, possible, config)) return {lowest, false};
  const float median = medianOf(neighbours);
  for (float& height : neighbours) height = std::abs(height - median);
  const float margin = static_cast<float>(config.mad_factor) * medianOf(neighbours);
  return {std::clamp(lowest, median - margin, median + margin), lowest < median - margin};
}

int coarseGroundMargin(const CoarseGroundConfig& config) {
  return std::max(config.radius, config.wide_radius);
}

GroundEstimate coarseGroundAt(const HeightGrid& lowest, int x, int y,
                              std::vector<float>& neighbours, const CoarseGroundConfig& config) {
  const int side = 2 * config.radius + 1;
  const int possible = side * side - 1;
  gather(lowest, x, y, config.radius, 1, neighbours);
  const float own = lowest.at(x, y);
  if (config.wide_radius == 0 || enoughNeighbours(neighbours, possible, config)) {
    return coarseGroundOf(own, neighbours, possible, config);
  }
  gather(lowest, x, y, config.wide_radius, kWideStep, neighbours);
  if (neighbours.empty()) return {own, false};
  const auto last = static_cast<double>(neighbours.size() - 1);
  const auto low = neighbours.begin() + static_cast<std::ptrdiff_t>(config.wide_quantile * last);
  std::nth_element(neighbours.begin(), low, neighbours.end());
  return {std::min(own, *low), false};
}

void estimateCoarseGround(TileMap& map, const CoarseGroundConfig& config) {
  if (!config.enabled) {
    setFlatGround(map);
    return;
  }
  map.forEachTile([&](ColumnIndex index, Tile& tile) {
    const ColumnWindow window = TileMap::windowOf(index, 1, coarseGroundMargin(config));
    estimateTile(map.extract(window, &Tile::lowest, Tile::kNoHeight), tile, config);
  });
}

}  // namespace beautymap
