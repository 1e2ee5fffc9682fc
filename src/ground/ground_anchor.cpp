// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/ground/ground_anchor.h"

#include <algorithm>
#include <cmath>

namespace beautymap {

Bits shiftedUpToTop(Bits cells, int bits, int n_bit) {
  const Bits above = bits > 0 ? cells & ~lowBits(n_bit - bits) : 0;
  return (shifted(cells, bits) & lowBits(n_bit)) | (above != 0 ? Bits{1} << (n_bit - 1) : 0);
}

int moveBottom(Tile& tile, std::size_t column, float bottom, const MatrixConfig& config) {
  const double wanted = static_cast<double>(tile.ground[column]) - bottom;
  const int bits = static_cast<int>(std::lround(wanted / config.res_h));
  // By whole bits, so that no cell ever comes to lie beside its points.
  tile.ground[column] -= static_cast<float>(bits * config.res_h);
  tile.occupied[column] = shiftedUpToTop(tile.occupied[column], bits, config.n_bit);
  tile.dynamic[column] = shifted(tile.dynamic[column], bits) & lowBits(config.n_bit);
  return bits;
}

int anchorColumn(Tile& tile, std::size_t column, float bottom, double max_drift, bool cells_known,
                 const MatrixConfig& config) {
  const float old = tile.ground[column];
  if (old == bottom) return 0;
  if (old == Tile::kNoHeight || !cells_known) {
    tile.ground[column] = bottom;
    return 0;
  }
  return std::abs(old - bottom) > max_drift ? moveBottom(tile, column, bottom, config) : 0;
}

void shiftCounts(Tile& tile, std::size_t column, long shift) {
  const int bins = tile.fineBins();
  std::uint32_t* counts = tile.fineCounts(column);
  if (std::abs(shift) >= bins) {
    std::fill(counts, counts + bins, 0U);
  } else if (shift > 0) {
    std::move_backward(counts, counts + bins - shift, counts + bins);
    std::fill(counts, counts + shift, 0U);
  } else if (shift < 0) {
    std::move(counts - shift, counts + bins, counts);
    std::fill(counts + bins + shift, counts + bins, 0U);
  }
}

std::array<float, Tile::kColumns> groundOfOtherColumns(
    const Tile& tile, const std::bitset<Tile::kColumns>& has_ground) {
  constexpr int kFar = 4 * Tile::kSide;
  std::array<float, Tile::kColumns> height;
  std::array<int, Tile::kColumns> distance;
  for (std::size_t i = 0; i < height.size(); ++i) {
    height[i] = has_ground[i] ? tile.ground[i] : Tile::kNoHeight;
    distance[i] = has_ground[i] ? 0 : kFar;
  }
  // Two sweeps, each from the columns that it has passed: a distance transform.
  const auto look = [&](int x, int y, int from_x, int from_y) {
    if (from_x < 0 || from_y < 0 || from_x >= Tile::kSide || from_y >= Tile::kSide) return;
    const auto to = static_cast<std::size_t>(x << Tile::kShift | y);
    const auto from = static_cast<std::size_t>(from_x << Tile::kShift | from_y);
    if (distance[from] + 1 >= distance[to]) return;
    distance[to] = distance[from] + 1;
    height[to] = height[from];
  };
  for (int x = 0; x < Tile::kSide; ++x) {
    for (int y = 0; y < Tile::kSide; ++y) {
      look(x, y, x - 1, y);
      look(x, y, x, y - 1);
    }
    for (int y = Tile::kSide - 1; y >= 0; --y) look(x, y, x, y + 1);
  }
  for (int x = Tile::kSide - 1; x >= 0; --x) {
    for (int y = Tile::kSide - 1; y >= 0; --y) {
      look(x, y, x + 1, y);
      look(x, y, x, y + 1);
    }
    for (int y = 0; y < Tile::kSide; ++y) look(x, y, x, y - 1);
  }
  for (std::size_t i = 0; i < height.size(); ++i) {
    if (has_ground[i]) height[i] = Tile::kNoHeight;
  }
  return height;
}

}  // namespace beautymap
