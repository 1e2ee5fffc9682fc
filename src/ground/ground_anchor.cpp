// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/ground/ground_anchor.h"

#include <algorithm>
#include <cmath>

namespace beautymap {
namespace {

void shiftCounts(std::uint32_t* counts, int bins, long shift) {
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

}  // namespace

void moveBottom(Tile& tile, std::size_t column, float bottom, const Config& config) {
  const double wanted = static_cast<double>(tile.ground[column]) - bottom;
  const int bits = static_cast<int>(std::lround(wanted / config.matrix.res_h));
  // By whole bits, so that no cell ever comes to lie beside its points.
  const double up = bits * config.matrix.res_h;
  tile.ground[column] -= static_cast<float>(up);
  const Bits mask = lowBits(config.matrix.n_bit);
  const auto move = [&](Bits& cells) { cells = shifted(cells, bits) & mask; };
  const Bits above = bits > 0 ? tile.occupied[column] & ~lowBits(config.matrix.n_bit - bits) : 0;
  move(tile.occupied[column]);
  if (above != 0) tile.occupied[column] |= Bits{1} << (config.matrix.n_bit - 1);
  move(tile.suspected[column]);
  move(tile.strong[column]);
  move(tile.leaning[column]);
  move(tile.unknown[column]);
  move(tile.flickering[column]);
  move(tile.dynamic[column]);
  if (tile.evidence.has(column)) tile.evidence.touch(column).shift(bits, mask);
  if (tile.floors.has(column)) tile.floors.touch(column).bit += bits;
  const bool layer = config.ground_layer.enabled;
  // Without a ground layer the bins divide one cell: they belong to another one now.
  const long bins = layer       ? std::lround(up / config.ground_layer.bin_height)
                    : bits == 0 ? 0
                                : tile.fineBins();
  shiftCounts(tile.fine_counts.data() + column * static_cast<std::size_t>(tile.fineBins()),
              tile.fineBins(), bins);
}

bool anchorColumn(Tile& tile, std::size_t column, float bottom, double max_drift,
                  const Config& config) {
  const float old = tile.ground[column];
  if (old == bottom) return false;
  const bool holds_nothing =
      old == Tile::kNoHeight || (tile.occupied[column] == 0 && !tile.evidence.has(column));
  if (holds_nothing) tile.ground[column] = bottom;
  if (holds_nothing || std::abs(old - bottom) <= max_drift) return false;
  moveBottom(tile, column, bottom, config);
  return tile.ground[column] != old;
}

bool hangsOverFreeSpace(const Tile& tile, std::size_t column, float height, const Config& config) {
  if (tile.evidence.empty() || tile.ground[column] == Tile::kNoHeight) return false;
  // One cell below a surface is still in the footprint of beams that graze it.
  const int below = BinaryEncoding(config.matrix).bitIndex(height, tile.ground[column]) - 1;
  if (below <= 0) return false;
  const ColumnEvidence& evidence = tile.evidence[column];
  Bits rest = evidence.everFree() & ~tile.occupied[column] & lowBits(below);
  for (; rest != 0; rest &= rest - 1) {
    if (evidence.freeBefore(lowestBitIndex(rest)) >= config.evidence.min_free_in_order) return true;
  }
  return false;
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
