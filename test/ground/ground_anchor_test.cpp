// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/ground/ground_anchor.h"

#include <gtest/gtest.h>

#include <cmath>

#include "test_scenes.h"

namespace beautymap {
namespace {

constexpr std::size_t kColumn = 37;

MatrixConfig dyadicConfig() {
  MatrixConfig config;
  config.res_h = 0.25;
  return config;
}

TEST(GroundAnchor, WhatRisesAboveTheHighestBitCountsAsThatBit) {
  const MatrixConfig config = dyadicConfig();
  Tile tile(1);
  tile.ground[kColumn] = 0.0F;
  tile.occupied[kColumn] = Bits{1} << 60;
  EXPECT_EQ(moveBottom(tile, kColumn, -2.5F, config), 10);
  EXPECT_EQ(tile.occupied[kColumn], Bits{1} << 63);
}

TEST(GroundAnchor, SmallMovesLeaveTheCellsWhereTheyAre) {
  const MatrixConfig config = dyadicConfig();
  Tile tile(14);
  EXPECT_EQ(anchorColumn(tile, kColumn, 1.0F, 0.1, false, config), 0);
  EXPECT_EQ(tile.ground[kColumn], 1.0F);
  tile.occupied[kColumn] = 0b1000;
  EXPECT_EQ(anchorColumn(tile, kColumn, 1.0625F, 0.1, true, config), 0);
  EXPECT_EQ(tile.ground[kColumn], 1.0F) << "the cells are anchored there";
  EXPECT_EQ(anchorColumn(tile, kColumn, 0.75F, 0.1, true, config), 1);
  EXPECT_EQ(tile.ground[kColumn], 0.75F);
  EXPECT_EQ(tile.occupied[kColumn], Bits{0b10000});
}

TEST(GroundAnchor, AnEmptyColumnIsAnchoredAtTheLatestEstimate) {
  Tile tile(14);
  anchorColumn(tile, kColumn, 1.0F, 0.1, false, dyadicConfig());
  EXPECT_EQ(anchorColumn(tile, kColumn, 1.0625F, 0.1, false, dyadicConfig()), 0);
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

}  // namespace
}  // namespace beautymap
