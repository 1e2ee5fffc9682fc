// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/agreement.h"

#include <gtest/gtest.h>

#include "core/test_scenes.h"

namespace beautymap {
namespace {

using test::Random;

constexpr int kGround = 8;

bool isSet(const BitGrid& grid, int x, int y, int bit) {
  return bit >= 0 && bit < kMaxBits && (grid.at(x, y) >> bit & 1) != 0;
}

DynamicWindow emptyWindow(int size) {
  const BitGrid none(ColumnWindow{{-7, 11}, size}, 0);
  return {none, none, none};
}

/// Cells from `low` to `high`, both included.
struct Cells {
  int x_low, x_high, y_low, y_high, bit_low, bit_high;
};

void set(BitGrid& grid, const Cells& cells) {
  const Bits bits = lowBits(cells.bit_high + 1) & ~lowBits(cells.bit_low);
  for (int x = cells.x_low; x <= cells.x_high; ++x) {
    for (int y = cells.y_low; y <= cells.y_high; ++y) grid.at(x, y) |= bits;
  }
}
void setDynamic(DynamicWindow& window, const Cells& cells) {
  set(window.occupied, cells);
  set(window.dynamic, cells);
}

int countOf(const BitGrid& grid) {
  int count = 0;
  for (int x = 0; x < grid.size(); ++x) {
    for (int y = 0; y < grid.size(); ++y) count += __builtin_popcountll(grid.at(x, y));
  }
  return count;
}

TEST(Agreement, AnIsolatedDynamicCellInAWallIsUnsupported) {
  DynamicWindow window = emptyWindow(9);
  set(window.occupied, {4, 4, 0, 8, kGround, 30});
  setDynamic(window, {4, 4, 4, 4, 20, 20});
  AgreementConfig config;
  const BitGrid unsupported = unsupportedCells(window, kGround, config);
  EXPECT_EQ(unsupported.at(4, 4), Bits{1} << 20);
  EXPECT_EQ(countOf(unsupported), 1);
  // Neither is its height the only reason, nor does strong evidence help it.
  config.min_run = 1;
  EXPECT_EQ(unsupportedCells(window, kGround, config).at(4, 4), Bits{1} << 20);
  window.strong = window.dynamic;
  EXPECT_EQ(unsupportedCells(window, kGround, config).at(4, 4), Bits{1} << 20);
}

TEST(Agreement, ABlockInFreeSpaceIsSupported) {
  DynamicWindow window = emptyWindow(9);
  setDynamic(window, {3, 5, 3, 5, kGround + 2, kGround + 6});
  EXPECT_EQ(countOf(window.dynamic), 45);
  EXPECT_EQ(countOf(unsupportedCells(window, kGround, {})), 0);
}

TEST(Agreement, ABlockOnTheGroundIsSupportedBecauseTheGroundDoesNotCount) {
  DynamicWindow window = emptyWindow(9);
  set(window.occupied, {0, 8, 0, 8, kGround, kGround});
  setDynamic(window, {3, 5, 3, 5, kGround + 1, kGround + 5});
  EXPECT_EQ(countOf(unsupportedCells(window, kGround, {})), 0);
  // Were the ground below, its cells would count as neighbours that stay.
  EXPECT_GT(countOf(unsupportedCells(window, kGround - 1, {})), 0);
}

TEST(Agreement, AFlatLayerAboveTheGroundIsUnsupported) {
  const AgreementConfig config;
  for (int height = 1; height <= config.min_run + 1; ++height) {
    DynamicWindow window = emptyWindow(12);
    setDynamic(window, {0, 11, 0, 11, kGround + 1, kGround + height});
    const int expected = height < config.min_run ? 10 * 10 * height : 0;
    EXPECT_EQ(countOf(unsupportedCells(window, kGround, config)), expected) << height;
  }
}

TEST(Agreement, ARunMayLeanOverNeighbouringColumns) {
  DynamicWindow window = emptyWindow(9);
  setDynamic(window, {3, 3, 4, 4, 20, 20});
  setDynamic(window, {4, 4, 4, 4, 21, 21});
  setDynamic(window, {5, 5, 5, 5, 22, 22});
  const BitGrid unsupported = unsupportedCells(window, kGround, {});
  // The middle one sees all three, the outer ones two each.
  EXPECT_EQ(unsupported.at(4, 4), Bits{0});
  EXPECT_EQ(unsupported.at(3, 4), Bits{1} << 20);
  EXPECT_EQ(unsupported.at(5, 5), Bits{1} << 22);
}

TEST(Agreement, StrongEvidenceNeedsFewerNeighbours) {
  // Something thin that went by along a wall.
  DynamicWindow window = emptyWindow(9);
  set(window.occupied, {3, 3, 0, 8, 10, 30});
  setDynamic(window, {4, 4, 0, 8, 10, 30});
  EXPECT_EQ(unsupportedCells(window, kGround, {}).at(4, 4), lowBits(31) & ~lowBits(10));
  window.strong = window.dynamic;
  EXPECT_EQ(countOf(unsupportedCells(window, kGround, {})), 0);
}

TEST(Agreement, TheHighestAndLowestBitsAreNoNeighbours) {
  DynamicWindow window = emptyWindow(5);
  set(window.occupied, {1, 3, 1, 3, 0, 0});
  setDynamic(window, {2, 2, 2, 2, 61, 63});
  EXPECT_EQ(countOf(unsupportedCells(window, -1, {})), 0);
}

/// The rule, one cell after the other.
bool isSupported(const DynamicWindow& window, int x, int y, int bit, int ground_bit,
                 const AgreementConfig& config) {
  const auto any_dynamic = [&](int at) {
    for (int nx = x - 1; nx <= x + 1; ++nx) {
      for (int ny = y - 1; ny <= y + 1; ++ny) {
        if (isSet(window.dynamic, nx, ny, at)) return true;
      }
    }
    return false;
  };
  int run = 1;
  for (int at = bit + 1; any_dynamic(at); ++at) ++run;
  for (int at = bit - 1; any_dynamic(at); --at) ++run;
  if (run < config.min_run) return false;

  int occupied = 0, dynamic = 0;
  for (int nx = x - 1; nx <= x + 1; ++nx) {
    for (int ny = y - 1; ny <= y + 1; ++ny) {
      for (int at = bit - 1; at <= bit + 1; ++at) {
        if ((nx == x && ny == y && at == bit) || at <= ground_bit) continue;
        occupied += isSet(window.occupied, nx, ny, at);
        dynamic += isSet(window.dynamic, nx, ny, at);
      }
    }
  }
  const bool strong = isSet(window.strong, x, y, bit);
  return dynamic >= (strong ? config.min_share_strong : config.min_share) * occupied;
}

/// Noise, full columns and blocks.
DynamicWindow randomWindow(Random& random) {
  DynamicWindow window = emptyWindow(random.integer(1, 9));
  const int size = window.dynamic.size();
  const double density = random.pick<double>({0.1, 0.5, 0.9});
  const auto sparse = [&] { return random.chance(density) ? random.bits() : Bits{0}; };
  for (int x = 0; x < size; ++x) {
    for (int y = 0; y < size; ++y) {
      window.occupied.at(x, y) = random.bits() | sparse();
      window.dynamic.at(x, y) = sparse() & sparse();
    }
  }
  for (int block = random.integer(0, 4); block > 0; --block) {
    const int x = random.integer(0, size - 1), y = random.integer(0, size - 1);
    const int bit = random.integer(0, kMaxBits - 1);
    set(window.dynamic, {x, random.integer(x, size - 1), y, random.integer(y, size - 1), bit,
                         random.integer(bit, kMaxBits - 1)});
  }
  for (int x = 0; x < size; ++x) {
    for (int y = 0; y < size; ++y) {
      window.dynamic.at(x, y) &= window.occupied.at(x, y);
      window.strong.at(x, y) = window.dynamic.at(x, y) & random.bits();
    }
  }
  return window;
}

TEST(Agreement, AgreesWithLoopsOverTheNeighbours) {
  int supported = 0, unsupported = 0;
  for (std::uint32_t seed = 0; seed < 300; ++seed) {
    Random random(seed);
    const DynamicWindow window = randomWindow(random);
    const int ground_bit = random.integer(-1, 40);
    AgreementConfig config;
    config.min_run = random.pick<int>({1, 2, 3, 5, 16});
    config.min_share = random.pick<double>({0.0, 0.25, 0.5, 0.6, 1.0});
    config.min_share_strong = random.pick<double>({0.0, 0.2, 0.5});
    const BitGrid result = unsupportedCells(window, ground_bit, config);
    const int size = window.dynamic.size();
    ASSERT_EQ(result.size(), size);
    ASSERT_EQ(result.window().corner, window.dynamic.window().corner);
    for (int x = 0; x < size; ++x) {
      for (int y = 0; y < size; ++y) {
        const bool border = x == 0 || y == 0 || x == size - 1 || y == size - 1;
        ASSERT_EQ(result.at(x, y) & ~window.dynamic.at(x, y), Bits{0}) << "seed " << seed;
        if (border) {
          ASSERT_EQ(result.at(x, y), Bits{0}) << "seed " << seed;
          continue;
        }
        for (int bit = 0; bit < kMaxBits; ++bit) {
          if (!isSet(window.dynamic, x, y, bit)) continue;
          const bool expected = isSupported(window, x, y, bit, ground_bit, config);
          ASSERT_EQ(!isSet(result, x, y, bit), expected)
              << "seed " << seed << " column " << x << ", " << y << " bit " << bit;
          ++(expected ? supported : unsupported);
        }
      }
    }
  }
  EXPECT_GT(supported, 10000);
  EXPECT_GT(unsupported, 10000);
}

TEST(Agreement, WindowsWithoutAnInsideHaveNoCells) {
  for (const int size : {0, 1, 2}) {
    DynamicWindow window = emptyWindow(size);
    if (size > 0) setDynamic(window, {0, size - 1, 0, size - 1, 0, 63});
    EXPECT_EQ(countOf(unsupportedCells(window, kGround, {})), 0);
  }
}

}  // namespace
}  // namespace beautymap
