// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/ground/ground_anchor.h"

#include <gtest/gtest.h>

#include <cmath>

#include "beautymap/ground/ground_layer.h"
#include "test_scenes.h"

namespace beautymap {
namespace {

constexpr std::size_t kColumn = 37;

Config dyadicConfig() {
  Config config;
  config.matrix.res_h = 0.25;
  config.ground_layer.bin_height = 0.0625;
  return config;
}

/// A tile with random cells, evidence and counts in one column, anchored at 0.
Tile randomColumn(test::Random& random, const Config& config) {
  Tile tile(GroundLayer(config.ground_layer, config.matrix.res_h).bins());
  tile.ground[kColumn] = 0.0F;
  tile.occupied[kColumn] = random.bits() & lowBits(config.matrix.n_bit);
  for (int i = 0; i < 20; ++i) {
    const Bits mask = lowBits(config.matrix.n_bit);
    tile.evidence.touch(kColumn).observe(random.bits() & random.bits() & mask,
                                         random.bits() & mask);
  }
  for (std::uint32_t& count : tile.fine_counts) count = static_cast<std::uint32_t>(random.bits());
  return tile;
}

TEST(GroundAnchor, EverythingOfAColumnMovesByTheSameHeight) {
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    test::Random random(seed);
    Config config = dyadicConfig();
    config.matrix.n_bit = random.pick<int>({24, 40, 64});
    Tile before = randomColumn(random, config);
    before.floors.touch(kColumn).bit = 20;
    Tile after = before;
    const int bits = random.integer(-12, 12);
    moveBottom(after, kColumn, static_cast<float>(-bits * config.matrix.res_h), config);
    for (int bit = 0; bit < config.matrix.n_bit - 1; ++bit) {
      const int from = bit - bits;
      const bool inside = from >= 0 && from < config.matrix.n_bit;
      const auto& old = before.evidence[kColumn];
      const auto& moved = after.evidence[kColumn];
      EXPECT_EQ(after.occupied[kColumn] >> bit & 1,
                inside ? before.occupied[kColumn] >> from & 1 : 0U);
      EXPECT_EQ(moved.hits(bit), inside ? old.hits(from) : 0);
      EXPECT_EQ(moved.freeBefore(bit), inside ? old.freeBefore(from) : 0);
      EXPECT_EQ(moved.freeBetween(bit), inside ? old.freeBetween(from) : 0);
      EXPECT_EQ(moved.freeAfter(bit), inside ? old.freeAfter(from) : 0);
    }
    EXPECT_EQ(after.floors[kColumn].bit, 20 + bits);
    const int bins = before.fineBins();
    for (int bin = 0; bin < bins; ++bin) {
      const int from = bin - 4 * bits;
      const auto at = [&](const Tile& tile, int i) {
        return tile
            .fine_counts[kColumn * static_cast<std::size_t>(bins) + static_cast<std::size_t>(i)];
      };
      EXPECT_EQ(at(after, bin), from >= 0 && from < bins ? at(before, from) : 0U) << bits;
    }
  }
}

TEST(GroundAnchor, WhatRisesAboveTheHighestBitCountsAsThatBit) {
  const Config config = dyadicConfig();
  Tile tile(1);
  tile.ground[kColumn] = 0.0F;
  tile.occupied[kColumn] = Bits{1} << 60;
  moveBottom(tile, kColumn, -2.5F, config);
  EXPECT_EQ(tile.occupied[kColumn], Bits{1} << 63);
}

TEST(GroundAnchor, SmallMovesLeaveTheCellsWhereTheyAre) {
  const Config config = dyadicConfig();
  Tile tile(14);
  EXPECT_FALSE(anchorColumn(tile, kColumn, 1.0F, 0.1, config));
  EXPECT_EQ(tile.ground[kColumn], 1.0F);
  tile.occupied[kColumn] = 0b1000;
  EXPECT_FALSE(anchorColumn(tile, kColumn, 1.0625F, 0.1, config));
  EXPECT_EQ(tile.ground[kColumn], 1.0F) << "the cells are anchored there";
  EXPECT_TRUE(anchorColumn(tile, kColumn, 0.75F, 0.1, config));
  EXPECT_EQ(tile.ground[kColumn], 0.75F);
  EXPECT_EQ(tile.occupied[kColumn], Bits{0b10000});
}

TEST(GroundAnchor, AnEmptyColumnIsAnchoredAtTheLatestEstimate) {
  Tile tile(14);
  anchorColumn(tile, kColumn, 1.0F, 0.1, dyadicConfig());
  EXPECT_FALSE(anchorColumn(tile, kColumn, 1.0625F, 0.1, dyadicConfig()));
  EXPECT_EQ(tile.ground[kColumn], 1.0625F);
}

TEST(GroundAnchor, OtherColumnsTakeTheGroundOfTheNearestOne) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    test::Random random(seed);
    Tile tile(1);
    std::vector<std::size_t> known;
    std::bitset<Tile::kColumns> has_ground;
    for (int i = random.integer(1, 12); i > 0; --i) {
      known.push_back(static_cast<std::size_t>(random.integer(0, Tile::kColumns - 1)));
      has_ground.set(known.back());
      tile.ground[known.back()] = static_cast<float>(known.back());
    }
    const auto height = groundOfOtherColumns(tile, has_ground);
    const auto distance = [](std::size_t a, std::size_t b) {
      const int ax = static_cast<int>(a >> Tile::kShift), bx = static_cast<int>(b >> Tile::kShift);
      const int ay = static_cast<int>(a % Tile::kSide), by = static_cast<int>(b % Tile::kSide);
      return std::abs(ax - bx) + std::abs(ay - by);
    };
    for (std::size_t column = 0; column < Tile::kColumns; ++column) {
      if (has_ground[column]) {
        EXPECT_EQ(height[column], Tile::kNoHeight);
        continue;
      }
      int nearest = 1000;
      for (const std::size_t k : known) nearest = std::min(nearest, distance(k, column));
      EXPECT_EQ(distance(static_cast<std::size_t>(height[column]), column), nearest);
    }
  }
  EXPECT_EQ(groundOfOtherColumns(Tile(1), {})[0], Tile::kNoHeight);
}

TEST(GroundAnchor, WhatIsAboveFreeSpaceIsNoGround) {
  const Config config;
  Tile tile(1);
  tile.ground[7] = 10.0F;
  EXPECT_FALSE(hangsOverFreeSpace(tile, 7, 13.1F, config)) << "nothing was seen";
  tile.occupied[7] = Bits{1} << 15;
  for (int scan = 0; scan < config.evidence.min_free_in_order; ++scan) {
    EXPECT_FALSE(hangsOverFreeSpace(tile, 7, 13.1F, config)) << "seen free too seldom";
    tile.evidence.touch(7).observe(tile.occupied[7], Bits{1} << 12);
  }
  EXPECT_TRUE(hangsOverFreeSpace(tile, 7, 13.1F, config));
  EXPECT_FALSE(hangsOverFreeSpace(tile, 7, 12.7F, config)) << "beams that graze it end there";
  EXPECT_FALSE(hangsOverFreeSpace(tile, 8, 13.1F, config)) << "another column";
}

}  // namespace
}  // namespace beautymap
