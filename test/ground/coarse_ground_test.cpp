// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/ground/coarse_ground.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "test_scenes.h"

namespace beautymap {
namespace {

using test::Random;

using Heights = std::map<std::pair<int, int>, double>;

double medianBySorting(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n % 2 == 1 ? values[n / 2] : (values[n / 2 - 1] + values[n / 2]) / 2.0;
}

struct Ground {
  double height;
  bool below_ground;
};

/// MAD(L) = median(|l - median(L)|), [l_min, l_max] = median(L) -/+ factor MAD(L), g = min(max(l,
/// l_min), l_max).
Ground groundBySorting(double lowest, const std::vector<double>& neighbours, int possible,
                       const CoarseGroundConfig& config) {
  if (neighbours.empty()) return {lowest, false};
  if (static_cast<double>(neighbours.size()) / possible < config.min_share) return {lowest, false};
  const double median = medianBySorting(neighbours);
  std::vector<double> deviations;
  for (const double l : neighbours) deviations.push_back(std::abs(l - median));
  const double mad = medianBySorting(deviations);
  const double l_min = median - config.mad_factor * mad;
  const double l_max = median + config.mad_factor * mad;
  return {std::min(std::max(lowest, l_min), l_max), lowest < l_min};
}

/// Where too few neighbours hold points: no higher than a quantile of the lowest heights around.
Ground groundOfWider(double lowest, std::vector<double> around, const CoarseGroundConfig& config) {
  if (around.empty()) return {lowest, false};
  std::sort(around.begin(), around.end());
  const double last = static_cast<double>(around.size() - 1);
  return {std::min(lowest, around[static_cast<std::size_t>(config.wide_quantile * last)]), false};
}

std::vector<double> heightsAround(const Heights& lowest, std::pair<int, int> column, int radius,
                                  int step = 1) {
  std::vector<double> heights;
  for (int dx = -radius; dx <= radius; dx += step) {
    for (int dy = -radius; dy <= radius; dy += step) {
      const auto found = lowest.find({column.first + dx, column.second + dy});
      if ((dx != 0 || dy != 0) && found != lowest.end()) heights.push_back(found->second);
    }
  }
  return heights;
}

CoarseGroundConfig randomConfig(Random& random) {
  CoarseGroundConfig config;
  config.radius = random.integer(1, 4);
  // Exact in float and double, like the heights: nothing has to be tolerated.
  config.min_share = random.pick<double>({0.0, 0.25, 0.5, 0.625, 1.0});
  config.mad_factor = random.pick<double>({0.0, 0.5, 1.0, 3.0, 20.0});
  config.wide_radius = random.pick<int>({0, 1, 6});
  config.wide_quantile = random.pick<double>({0.0, 0.25, 0.5, 1.0});
  return config;
}

TileMap mapOf(const Heights& lowest) {
  TileMap map(1);
  for (const auto& column : lowest) {
    const ColumnIndex index{column.first.first, column.first.second};
    map.tileAt(TileMap::tileOf(index))
        .lowest[static_cast<std::size_t>(TileMap::indexInTile(index))] =
        static_cast<float>(column.second);
  }
  return map;
}

GroundEstimate groundAt(const TileMap& map, int x, int y) {
  const Tile* tile = map.findTile(TileMap::tileOf({x, y}));
  if (!tile) return {};
  const auto column = static_cast<std::size_t>(TileMap::indexInTile({x, y}));
  return {tile->ground[column], tile->below_ground[column] != 0};
}

Heights randomHeights(Random& random, int extent, double share) {
  Heights lowest;
  for (int x = -extent; x <= extent; ++x) {
    for (int y = -extent; y <= extent; ++y) {
      if (!random.chance(share)) continue;
      const double slope = 0.0625 * x;
      const double outlier = random.chance(0.1) ? random.uniform(-5.0, 5.0) : 0.0;
      lowest[{x, y}] = test::dyadic(slope + outlier + random.uniform(-0.1, 0.1));
    }
  }
  return lowest;
}

TEST(CoarseGround, OneColumnAgreesWithSorting) {
  for (std::uint32_t seed = 0; seed < 2000; ++seed) {
    Random random(seed);
    const CoarseGroundConfig config = randomConfig(random);
    const int possible = (2 * config.radius + 1) * (2 * config.radius + 1) - 1;
    std::vector<double> heights;
    std::vector<float> neighbours;
    for (int i = random.integer(0, possible); i > 0; --i) {
      heights.push_back(test::dyadic(random.uniform(-4.0, 4.0)));
      neighbours.push_back(static_cast<float>(heights.back()));
    }
    const double lowest = test::dyadic(random.uniform(-8.0, 8.0));
    const Ground expected = groundBySorting(lowest, heights, possible, config);
    const GroundEstimate ground =
        coarseGroundOf(static_cast<float>(lowest), neighbours, possible, config);
    ASSERT_EQ(ground.height, static_cast<float>(expected.height)) << "seed " << seed;
    ASSERT_EQ(ground.below_ground, expected.below_ground) << "seed " << seed;
  }
}

TEST(CoarseGround, EveryColumnOfAMapAgreesWithSortingItsNeighbours) {
  int wider = 0;
  for (std::uint32_t seed = 0; seed < 12; ++seed) {
    Random random(seed);
    const CoarseGroundConfig config = randomConfig(random);
    const int extent = 40;  // four tiles, negative columns, and borders
    const Heights lowest = randomHeights(random, extent, random.uniform(0.2, 1.0));
    TileMap map = mapOf(lowest);
    estimateCoarseGround(map, config);
    const int r = config.radius;
    const int possible = (2 * r + 1) * (2 * r + 1) - 1;
    for (const auto& column : lowest) {
      const std::vector<double> neighbours = heightsAround(lowest, column.first, r);
      const bool enough = !neighbours.empty() &&
                          static_cast<double>(neighbours.size()) >= config.min_share * possible;
      const Ground expected =
          enough || config.wide_radius == 0
              ? groundBySorting(column.second, neighbours, possible, config)
              : groundOfWider(column.second,
                              heightsAround(lowest, column.first, config.wide_radius, 2), config);
      wider += !enough && config.wide_radius > 0;
      const GroundEstimate ground = groundAt(map, column.first.first, column.first.second);
      ASSERT_EQ(ground.height, static_cast<float>(expected.height)) << "seed " << seed;
      ASSERT_EQ(ground.below_ground, expected.below_ground) << "seed " << seed;
    }
  }
  EXPECT_GT(wider, 2000);
}

TEST(CoarseGround, ColumnsWithoutPointsHaveNoGround) {
  Random random(1);
  const Heights lowest = randomHeights(random, 20, 0.5);
  for (const bool enabled : {true, false}) {
    CoarseGroundConfig config;
    config.enabled = enabled;
    TileMap map = mapOf(lowest);
    estimateCoarseGround(map, config);
    for (int x = -32; x < 32; ++x) {
      for (int y = -32; y < 32; ++y) {
        EXPECT_EQ(groundAt(map, x, y).height == Tile::kNoHeight, lowest.count({x, y}) == 0);
      }
    }
  }
}

TEST(CoarseGround, AMirroredMapHasAMirroredGround) {
  Random random(5);
  const Heights lowest = randomHeights(random, 36, 0.7);
  Heights mirrored, turned;
  for (const auto& column : lowest) {
    mirrored[{-column.first.first, column.first.second}] = column.second;
    turned[{column.first.second, column.first.first}] = column.second;
  }
  const CoarseGroundConfig config;
  TileMap map = mapOf(lowest), mirrored_map = mapOf(mirrored), turned_map = mapOf(turned);
  estimateCoarseGround(map, config);
  estimateCoarseGround(mirrored_map, config);
  estimateCoarseGround(turned_map, config);
  for (const auto& column : lowest) {
    const int x = column.first.first, y = column.first.second;
    EXPECT_EQ(groundAt(map, x, y).height, groundAt(mirrored_map, -x, y).height);
    EXPECT_EQ(groundAt(map, x, y).height, groundAt(turned_map, y, x).height);
  }
}

/// Heights that alternate between 0 and 0.125: median 0 or 0.125, MAD at most 0.125.
Heights roughGround() {
  Heights lowest;
  for (int x = -5; x <= 5; ++x) {
    for (int y = -5; y <= 5; ++y) lowest[{x, y}] = (x + y) % 2 == 0 ? 0.0 : 0.125;
  }
  return lowest;
}

TEST(CoarseGround, AMultiPathReturnDoesNotPullTheGroundDown) {
  Heights lowest = roughGround();
  lowest[{0, 0}] = -3.0;
  TileMap map = mapOf(lowest);
  estimateCoarseGround(map, CoarseGroundConfig());
  EXPECT_GE(groundAt(map, 0, 0).height, -3.0F * 0.125F);
  EXPECT_TRUE(groundAt(map, 0, 0).below_ground);
  EXPECT_FALSE(groundAt(map, 1, 0).below_ground);
}

TEST(CoarseGround, ACarRoofDoesNotLiftTheGround) {
  Heights lowest = roughGround();
  lowest[{0, 0}] = 1.5;  // the ground below was never seen
  TileMap map = mapOf(lowest);
  estimateCoarseGround(map, CoarseGroundConfig());
  EXPECT_LE(groundAt(map, 0, 0).height, 0.125F + 3.0F * 0.125F);
  EXPECT_FALSE(groundAt(map, 0, 0).below_ground);
}

TEST(CoarseGround, ALonelyColumnKeepsItsOwnLowestPoint) {
  TileMap map = mapOf({{{-7, 3}, 2.5}, {{-5, 3}, -1.0}, {{20, 3}, 4.0}});
  CoarseGroundConfig as_published;
  as_published.wide_radius = 0;
  estimateCoarseGround(map, as_published);
  EXPECT_EQ(groundAt(map, -7, 3).height, 2.5F);
  EXPECT_EQ(groundAt(map, -5, 3).height, -1.0F);
  EXPECT_FALSE(groundAt(map, -5, 3).below_ground);
  estimateCoarseGround(map, CoarseGroundConfig());
  EXPECT_EQ(groundAt(map, -7, 3).height, -1.0F);
  EXPECT_EQ(groundAt(map, -5, 3).height, -1.0F);
  EXPECT_EQ(groundAt(map, 20, 3).height, 4.0F);
}

TEST(CoarseGround, WhereTheGroundIsSeldomHitAnObjectIsNotItsOwnGround) {
  // Far from the sensor: a ring of a scan on a slope, and beside it the window of a car.
  Heights lowest;
  for (int y = -12; y <= 12; ++y) {
    lowest[{0, y}] = 0.0625 * y;
    lowest[{5, y}] = 0.0625 * y + 0.25;
  }
  lowest[{3, 0}] = 1.5;
  TileMap map = mapOf(lowest);
  estimateCoarseGround(map, CoarseGroundConfig());
  EXPECT_LT(groundAt(map, 3, 0).height, 0.25F);
  EXPECT_GT(groundAt(map, 3, 0).height, -0.625F);
  // The points of the ground itself stay in the cells at the ground: it is not lowered by more than
  // a slope makes of the radius.
  for (const auto& column : lowest) {
    const GroundEstimate ground = groundAt(map, column.first.first, column.first.second);
    EXPECT_LE(ground.height, static_cast<float>(column.second));
    if (column.second < 1.0) {
      EXPECT_GE(ground.height, static_cast<float>(column.second) - 0.625F);
    }
  }
}

TEST(CoarseGround, SwitchedOffEveryColumnStartsAtTheLowestPointOfTheMap) {
  Random random(9);
  const Heights lowest = randomHeights(random, 40, 0.5);
  double minimum = 1e9;
  for (const auto& column : lowest) minimum = std::min(minimum, column.second);
  CoarseGroundConfig config;
  config.enabled = false;
  TileMap map = mapOf(lowest);
  estimateCoarseGround(map, config);
  for (const auto& column : lowest) {
    const GroundEstimate ground = groundAt(map, column.first.first, column.first.second);
    EXPECT_EQ(ground.height, static_cast<float>(minimum));
    EXPECT_FALSE(ground.below_ground);
  }
}

TEST(CoarseGround, AnEmptyMapStaysEmpty) {
  for (const bool enabled : {true, false}) {
    CoarseGroundConfig config;
    config.enabled = enabled;
    TileMap map(1);
    estimateCoarseGround(map, config);
    EXPECT_EQ(map.tileCount(), 0U);
  }
}

}  // namespace
}  // namespace beautymap
