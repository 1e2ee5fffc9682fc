// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/coarse_ground.h"

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

void estimateTile(const HeightGrid& lowest, Tile& tile, const CoarseGroundConfig& config) {
  const int r = config.radius;
  std::vector<float> neighbours;
  for (int x = 0; x < Tile::kSide; ++x) {
    for (int y = 0; y < Tile::kSide; ++y) {
      const std::size_t column = static_cast<std::size_t>(x << Tile::kShift | y);
      if (tile.lowest[column] == Tile::kNoHeight) continue;
      const GroundEstimate estimate = coarseGroundAt(lowest, x + r, y + r, neighbours, config);
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
  const auto present = static_cast<double>(neighbours.size());
  if (neighbours.empty() || present < config.min_share * possible) return {lowest, false};
  const float median = medianOf(neighbours);
  for (float& height : neighbours) height = std::abs(height - median);
  const float margin = static_cast<float>(config.mad_factor) * medianOf(neighbours);
  return {std::clamp(lowest, median - margin, median + margin), lowest < median - margin};
}

GroundEstimate coarseGroundAt(const HeightGrid& lowest, int x, int y,
                              std::vector<float>& neighbours, const CoarseGroundConfig& config) {
  const int r = config.radius;
  neighbours.clear();
  for (int dx = -r; dx <= r; ++dx) {
    for (int dy = -r; dy <= r; ++dy) {
      const float height = lowest.at(x + dx, y + dy);
      if (height != Tile::kNoHeight && (dx != 0 || dy != 0)) neighbours.push_back(height);
    }
  }
  return coarseGroundOf(lowest.at(x, y), neighbours, (2 * r + 1) * (2 * r + 1) - 1, config);
}

void estimateCoarseGround(TileMap& map, const CoarseGroundConfig& config) {
  if (!config.enabled) {
    setFlatGround(map);
    return;
  }
  map.forEachTile([&](ColumnIndex index, Tile& tile) {
    const ColumnIndex corner{index.x * Tile::kSide - config.radius,
                             index.y * Tile::kSide - config.radius};
    const ColumnWindow window{corner, Tile::kSide + 2 * config.radius};
    estimateTile(map.extract(window, &Tile::lowest, Tile::kNoHeight), tile, config);
  });
}

}  // namespace beautymap
