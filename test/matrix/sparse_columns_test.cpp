// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/matrix/sparse_columns.h"

#include <gtest/gtest.h>

#include <array>
#include <map>

#include "test_scenes.h"

namespace beautymap {
namespace {

using test::Random;
using Columns = SparseColumns<int, 100>;

TEST(SparseColumns, HoldWhatAMapHolds) {
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    Random random(seed);
    Columns columns;
    std::map<std::size_t, int> expected;
    for (int i = random.integer(0, 300); i > 0; --i) {
      const auto column = static_cast<std::size_t>(random.integer(0, 99));
      columns.touch(column) += i;
      expected[column] += i;
    }
    EXPECT_EQ(columns.empty(), expected.empty());
    for (std::size_t column = 0; column < 100; ++column) {
      EXPECT_EQ(columns.has(column), expected.count(column) == 1);
      EXPECT_EQ(columns[column], expected.count(column) == 1 ? expected[column] : 0);
    }
    EXPECT_EQ(columns.values().size(), expected.size());
  }
}

TEST(SparseColumns, TakeLittleMemoryWhereFewColumnsHaveAValue) {
  SparseColumns<std::array<char, 1000>, 1000> columns;
  EXPECT_EQ(columns.memoryBytes(), 0U);
  for (std::size_t i = 0; i < 100; ++i) columns.touch(10 * i);
  EXPECT_LT(columns.memoryBytes(), 150000U);
}

TEST(SparseColumns, AreTheSameAfterTheyWereWritten) {
  Columns columns, read;
  for (const std::size_t column : {7U, 3U, 99U}) columns.touch(column) = static_cast<int>(column);
  ASSERT_TRUE(read.assign(columns.places(), columns.values()));
  for (std::size_t column = 0; column < 100; ++column) {
    EXPECT_EQ(read.has(column), columns.has(column));
    EXPECT_EQ(read[column], columns[column]);
  }
  ASSERT_TRUE(read.assign({}, {}));
  EXPECT_TRUE(read.empty());
  EXPECT_FALSE(read.has(7));
}

TEST(SparseColumns, DamagedPlacesAreRefused) {
  Columns columns;
  columns.touch(5) = 4;
  auto places = columns.places();
  EXPECT_FALSE(columns.assign({}, {1}));
  EXPECT_FALSE(columns.assign(places, {}));
  places.pop_back();
  EXPECT_FALSE(columns.assign(places, {1}));
  places.push_back(1);  // there is only place 0
  EXPECT_FALSE(columns.assign(places, {1}));
  EXPECT_EQ(columns[5], 4);
}

}  // namespace
}  // namespace beautymap
