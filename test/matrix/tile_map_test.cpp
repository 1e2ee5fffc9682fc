// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/matrix/tile_map.h"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <utility>

#include "test_scenes.h"

namespace beautymap {
namespace {

using test::Random;

using Column = std::pair<int, int>;

/// Division that rounds down, one step at a time.
int floorDivide(int value, int divisor) {
  int quotient = value / divisor;
  while (quotient * divisor > value) --quotient;
  return quotient;
}

Bits& occupiedAt(TileMap& map, ColumnIndex column) {
  return map.tileAt(TileMap::tileOf(column))
      .occupied[static_cast<std::size_t>(TileMap::indexInTile(column))];
}

/// Columns around the corner of four tiles, on the positive, negative and far sides of the world.
std::vector<ColumnIndex> cornersOfTheWorld() {
  return {{0, 0}, {-1, -1}, {-64, 31}, {1000000, -23200000}, {-999999968, 999999968}};
}

TEST(TileMap, AColumnLiesInTheTileOfItsFlooredIndex) {
  Random random(1);
  for (int i = 0; i < 5000; ++i) {
    const ColumnIndex column{random.integer(-1000, 1000), random.integer(-1000000000, 1000000000)};
    const ColumnIndex tile = TileMap::tileOf(column);
    ASSERT_EQ(tile.x, floorDivide(column.x, Tile::kSide));
    ASSERT_EQ(tile.y, floorDivide(column.y, Tile::kSide));
    const int in_x = column.x - tile.x * Tile::kSide;
    const int in_y = column.y - tile.y * Tile::kSide;
    ASSERT_EQ(TileMap::indexInTile(column), in_x * Tile::kSide + in_y);
  }
}

TEST(TileMap, TilesComeIntoBeingWhereTheyAreAskedForOnly) {
  TileMap map(3);
  EXPECT_EQ(map.findTile({0, 0}), nullptr);
  EXPECT_EQ(map.tileCount(), 0U);
  Tile& tile = map.tileAt({-4, 7});
  EXPECT_EQ(map.tileCount(), 1U);
  EXPECT_EQ(map.findTile({-4, 7}), &tile);
  EXPECT_EQ(&map.tileAt({-4, 7}), &tile);
  EXPECT_EQ(map.findTile({7, -4}), nullptr);
  EXPECT_EQ(map.findTile({-4, 6}), nullptr);
  EXPECT_EQ(map.tileCount(), 1U);
}

TEST(TileMap, ANewTileIsEmpty) {
  TileMap map(2);
  const Tile& tile = map.tileAt({0, -1});
  for (std::size_t i = 0; i < Tile::kColumns; ++i) {
    EXPECT_EQ(tile.lowest[i], Tile::kNoHeight);
    EXPECT_EQ(tile.ground[i], Tile::kNoHeight);
    EXPECT_EQ(tile.occupied[i], 0U);
    EXPECT_EQ(tile.dynamic[i], 0U);
    EXPECT_EQ(tile.below_ground[i], 0U);
    EXPECT_EQ(tile.static_bins[i], 0U);
  }
}

TEST(TileMap, EachTileIsVisitedOnceWithItsIndex) {
  TileMap map(1);
  std::set<Column> expected;
  for (const ColumnIndex& column : cornersOfTheWorld()) {
    const ColumnIndex tile = TileMap::tileOf(column);
    map.tileAt(tile).lowest[0] = static_cast<float>(tile.x);
    expected.insert({tile.x, tile.y});
  }
  std::set<Column> visited;
  map.forEachTile([&](ColumnIndex index, const Tile& tile) {
    EXPECT_TRUE(visited.insert({index.x, index.y}).second);
    EXPECT_EQ(tile.lowest[0], static_cast<float>(index.x));
  });
  EXPECT_EQ(visited, expected);
}

TEST(TileMap, AWindowShowsEachColumnAtItsPlace) {
  for (const ColumnIndex& corner : cornersOfTheWorld()) {
    for (std::uint32_t seed = 0; seed < 20; ++seed) {
      Random random(seed);
      const int extent = 50;
      TileMap map(1);
      std::map<Column, Bits> truth;
      for (int i = 0; i < 300; ++i) {
        const ColumnIndex column{corner.x + random.integer(-extent, extent),
                                 corner.y + random.integer(-extent, extent)};
        occupiedAt(map, column) = truth[{column.x, column.y}] = random.bits();
      }
      const std::size_t tiles = map.tileCount();
      const ColumnWindow window{
          {corner.x + random.integer(-60, 40), corner.y + random.integer(-60, 40)},
          random.integer(1, 80)};
      const Bits absent = 0;
      const BitGrid grid = map.extract(window, &Tile::occupied, absent);
      for (int x = 0; x < window.size; ++x) {
        for (int y = 0; y < window.size; ++y) {
          const auto found = truth.find({window.corner.x + x, window.corner.y + y});
          ASSERT_EQ(grid.at(x, y), found == truth.end() ? absent : found->second)
              << "corner " << corner.x << ' ' << corner.y << " seed " << seed;
        }
      }
      EXPECT_EQ(map.tileCount(), tiles) << "looking must not make tiles";
    }
  }
}

TEST(TileMap, WhereNoTileIsAWindowShowsTheAbsentValue) {
  TileMap map(1);
  map.tileAt({0, 0}).lowest.fill(1.0F);
  const HeightGrid grid = map.extract({{-2, -2}, 4}, &Tile::lowest, -7.0F);
  for (int x = 0; x < 4; ++x) {
    for (int y = 0; y < 4; ++y) EXPECT_EQ(grid.at(x, y), x >= 2 && y >= 2 ? 1.0F : -7.0F);
  }
}

TEST(TileMap, AWindowVisitsTheColumnsWhereTilesAreAndNoOthers) {
  for (std::uint32_t seed = 0; seed < 30; ++seed) {
    Random random(seed);
    TileMap map(1);
    std::map<Column, Bits> truth;
    for (int i = 0; i < 4; ++i) {
      const ColumnIndex tile{random.integer(-2, 1), random.integer(-2, 1)};
      for (int c = 0; c < 50; ++c) {
        const ColumnIndex column{tile.x * Tile::kSide + random.integer(0, Tile::kSide - 1),
                                 tile.y * Tile::kSide + random.integer(0, Tile::kSide - 1)};
        truth[{column.x, column.y}] |= occupiedAt(map, column) |= random.bits();
      }
    }
    const std::size_t tiles = map.tileCount();
    BitGrid grid({{random.integer(-70, 0), random.integer(-70, 0)}, random.integer(1, 70)}, 0);
    for (int x = 0; x < grid.size(); ++x) {
      for (int y = 0; y < grid.size(); ++y) {
        grid.at(x, y) = random.bits() & random.bits() & random.bits();
      }
    }
    forEachColumn(map, grid.window(), [&](int x, int y, Tile& tile, std::size_t column) {
      tile.occupied[column] |= grid.at(x, y);
    });
    EXPECT_EQ(map.tileCount(), tiles);
    const ColumnWindow all{{-80, -80}, 160};
    const BitGrid merged = map.extract(all, &Tile::occupied, Bits{0});
    for (int x = 0; x < all.size; ++x) {
      for (int y = 0; y < all.size; ++y) {
        const ColumnIndex column{all.corner.x + x, all.corner.y + y};
        const auto before = truth.find({column.x, column.y});
        Bits expected = before == truth.end() ? 0 : before->second;
        if (map.findTile(TileMap::tileOf(column)) && grid.window().contains(column)) {
          expected |= grid.at(column.x - grid.window().corner.x, column.y - grid.window().corner.y);
        }
        ASSERT_EQ(merged.at(x, y), expected) << "seed " << seed;
      }
    }
  }
}

TEST(TileCursor, GivesTheTileOfEachColumnInAnyOrder) {
  Random random(4);
  TileMap map(1);
  TileCursor<TileMap> cursor(map);
  for (int i = 0; i < 500; ++i) {
    const ColumnIndex column{random.integer(-100, 100), random.integer(-100, 100)};
    ASSERT_EQ(cursor(column), &map.tileAt(TileMap::tileOf(column)));
  }
}

TEST(TileCursor, OverAConstMapMakesNoTiles) {
  TileMap map(1);
  Tile& tile = map.tileAt({0, 0});
  TileCursor<const TileMap> cursor(map);
  EXPECT_EQ(cursor({-1, 0}), nullptr);
  EXPECT_EQ(cursor({5, 31}), &tile);
  EXPECT_EQ(cursor({5, 32}), nullptr);
  EXPECT_EQ(map.tileCount(), 1U);
}

TEST(TileMap, MemoryGrowsWithTilesAndNotWithPoints) {
  TileMap map(4);
  map.tileAt({0, 0});
  const std::size_t one = map.memoryBytes();
  EXPECT_GE(one, sizeof(Tile));
  for (int i = 0; i < 1000; ++i) occupiedAt(map, {i % 32, i % 7}) |= Bits{1} << (i % 64);
  EXPECT_EQ(map.memoryBytes(), one);
  map.tileAt({-1, 0});
  EXPECT_EQ(map.memoryBytes(), 2 * one);
}

TEST(TileMap, NeighboursAreTheExistingTilesAroundEachOnce) {
  TileMap map(1);
  for (int x = 0; x < 4; ++x) map.tileAt({x, 0});
  EXPECT_EQ(withNeighbours(map, {{0, 0}, {1, 0}}, 21).size(), 3U);
  EXPECT_EQ(withNeighbours(map, {{3, 0}}, 21).size(), 2U);
  EXPECT_TRUE(withNeighbours(map, {}, 21).empty());
  EXPECT_EQ(tilesOf(map).size(), 4U);
}

}  // namespace
}  // namespace beautymap
