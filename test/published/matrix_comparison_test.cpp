// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/published/matrix_comparison.h"

#include <gtest/gtest.h>

#include <functional>

#include "test_scenes.h"

namespace beautymap {
namespace {

using test::Random;

BitGrid randomGrid(Random& random, ColumnWindow window) {
  BitGrid grid(window, 0);
  for (int x = 0; x < window.size; ++x) {
    for (int y = 0; y < window.size; ++y) {
      if (random.chance(0.8)) grid.at(x, y) = random.bits() & random.bits();
    }
  }
  return grid;
}

bool has(Bits column, int k) { return (column >> k & 1) != 0; }

/// Compares each bit of each column with what a rule says about the bits of two inputs.
void expectEachBit(const BitGrid& result, const BitGrid& a, const BitGrid& b,
                   const std::function<bool(Bits a, Bits b, int k)>& rule) {
  ASSERT_EQ(result.size(), a.size());
  EXPECT_EQ(result.window().corner, a.window().corner);
  for (int x = 0; x < a.size(); ++x) {
    for (int y = 0; y < a.size(); ++y) {
      for (int k = 0; k < kMaxBits; ++k) {
        ASSERT_EQ(has(result.at(x, y), k), rule(a.at(x, y), b.at(x, y), k))
            << "column " << x << ' ' << y << " bit " << k;
      }
    }
  }
}

class MatrixComparison : public ::testing::TestWithParam<std::uint32_t> {
 protected:
  MatrixComparison()
      : random_(GetParam()),
        window_{{random_.integer(-99, 99), random_.integer(-99, 99)}, random_.integer(1, 12)},
        first_(randomGrid(random_, window_)),
        second_(randomGrid(random_, window_)) {}

  Random random_;
  ColumnWindow window_;
  const BitGrid first_, second_;
};

TEST_P(MatrixComparison, ACandidateIsInTheMapAndNotInTheScan) {
  expectEachBit(compareMatrices(first_, second_), first_, second_,
                [](Bits map, Bits scan, int k) { return has(map, k) && !has(scan, k); });
}

TEST_P(MatrixComparison, TheLowestOccupiedCellIsNoCandidate) {
  BitGrid candidates = first_;
  excludeLowestBits(candidates, second_);
  expectEachBit(candidates, first_, second_, [](Bits candidate, Bits map, int k) {
    int lowest = 0;
    while (lowest < kMaxBits && !has(map, lowest)) ++lowest;
    return has(candidate, k) && k != lowest;
  });
}

TEST_P(MatrixComparison, AMaskKeepsWhatItHolds) {
  BitGrid candidates = first_;
  keepOnly(candidates, second_);
  expectEachBit(candidates, first_, second_,
                [](Bits candidate, Bits mask, int k) { return has(candidate, k) && has(mask, k); });
}

TEST_P(MatrixComparison, WhatIsRestoredIsNoCandidate) {
  BitGrid candidates = first_;
  restore(candidates, second_);
  expectEachBit(candidates, first_, second_, [](Bits candidate, Bits restored, int k) {
    return has(candidate, k) && !has(restored, k);
  });
}

TEST_P(MatrixComparison, NoStepAddsCandidates) {
  BitGrid excluded = first_, kept = first_, restored = first_;
  excludeLowestBits(excluded, second_);
  keepOnly(kept, second_);
  restore(restored, second_);
  for (int x = 0; x < window_.size; ++x) {
    for (int y = 0; y < window_.size; ++y) {
      EXPECT_EQ(excluded.at(x, y) & ~first_.at(x, y), 0U);
      EXPECT_EQ(kept.at(x, y) & ~first_.at(x, y), 0U);
      EXPECT_EQ(restored.at(x, y) & ~first_.at(x, y), 0U);
    }
  }
}

TEST_P(MatrixComparison, AMapThatEqualsTheScanHasNoCandidates) {
  const BitGrid candidates = compareMatrices(first_, first_);
  for (int x = 0; x < window_.size; ++x) {
    for (int y = 0; y < window_.size; ++y) EXPECT_EQ(candidates.at(x, y), 0U);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, MatrixComparison, ::testing::Range<std::uint32_t>(0, 20));

}  // namespace
}  // namespace beautymap
