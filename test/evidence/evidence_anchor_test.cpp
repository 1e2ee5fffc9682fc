// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "beautymap/evidence/evidence_judgement.h"
#include "test_scenes.h"

namespace beautymap {
namespace {

constexpr std::size_t kColumn = 37;

Config dyadicConfig() {
  Config config;
  config.matrix.res_h = 0.25;
  config.ground_layer.bin_height = 0.0625;
  config.online.ground_drift = 0.0;
  return config;
}

/// A tile with random cells, evidence and counts in one column, anchored at 0.
Tile randomColumn(test::Random& random, const Config& config) {
  Tile tile = EvidenceJudgement(config).newMap().newTile();
  tile.ground[kColumn] = 0.0F;
  tile.occupied[kColumn] = random.bits() & lowBits(config.matrix.n_bit);
  for (int i = 0; i < 20; ++i) {
    const Bits mask = lowBits(config.matrix.n_bit);
    evidenceTile(tile).evidence.touch(kColumn).observe(random.bits() & random.bits() & mask,
                                                       random.bits() & mask);
  }
  for (std::uint32_t& count : tile.fine_counts) count = static_cast<std::uint32_t>(random.bits());
  return tile;
}

TEST(EvidenceAnchor, EverythingOfAColumnMovesByTheSameHeight) {
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    test::Random random(seed);
    Config config = dyadicConfig();
    config.matrix.n_bit = random.pick<int>({24, 40, 64});
    Tile before = randomColumn(random, config);
    evidenceTile(before).floors.touch(kColumn).bit = 20;
    Tile after = before;
    const int bits = random.integer(-12, 12);
    EXPECT_EQ(EvidenceJudgement(config).anchor(after, kColumn,
                                               static_cast<float>(-bits * config.matrix.res_h)),
              bits != 0);
    for (int bit = 0; bit < config.matrix.n_bit - 1; ++bit) {
      const int from = bit - bits;
      const bool inside = from >= 0 && from < config.matrix.n_bit;
      const auto& old = evidenceTile(std::as_const(before)).evidence[kColumn];
      const auto& moved = evidenceTile(std::as_const(after)).evidence[kColumn];
      EXPECT_EQ(after.occupied[kColumn] >> bit & 1,
                inside ? before.occupied[kColumn] >> from & 1 : 0U);
      EXPECT_EQ(moved.hits(bit), inside ? old.hits(from) : 0);
      EXPECT_EQ(moved.freeBefore(bit), inside ? old.freeBefore(from) : 0);
      EXPECT_EQ(moved.freeBetween(bit), inside ? old.freeBetween(from) : 0);
      EXPECT_EQ(moved.freeAfter(bit), inside ? old.freeAfter(from) : 0);
    }
    EXPECT_EQ(evidenceTile(std::as_const(after)).floors[kColumn].bit, 20 + bits);
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

TEST(EvidenceAnchor, WhatIsAboveFreeSpaceIsNoGround) {
  const Config config;
  const EvidenceJudgement judgement(config);
  Tile tile = judgement.newMap().newTile();
  const auto hangs = [&](float lowest) {
    tile.lowest[7] = lowest;
    return judgement.hangsOverFreeSpace(tile, 7);
  };
  tile.ground[7] = 10.0F;
  EXPECT_FALSE(hangs(13.1F)) << "nothing was seen";
  tile.occupied[7] = Bits{1} << 15;
  for (int scan = 0; scan < 5; ++scan) {
    EXPECT_FALSE(hangs(13.1F)) << "seen free too seldom";
    evidenceTile(tile).evidence.touch(7).observe(tile.occupied[7], Bits{1} << 12);
  }
  EXPECT_TRUE(hangs(13.1F));
  EXPECT_FALSE(hangs(12.7F)) << "beams that graze it end there";
  tile.lowest[8] = 13.1F;
  EXPECT_FALSE(judgement.hangsOverFreeSpace(tile, 8)) << "another column";
}

}  // namespace
}  // namespace beautymap
