// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/ground/fine_ground.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "test_scenes.h"

namespace beautymap {
namespace {

using test::Random;

FineGroundConfig fineConfig(double bin_height, double ground_ratio) {
  FineGroundConfig config;
  config.bin_height = bin_height;
  config.ground_ratio = ground_ratio;
  return config;
}

MatrixConfig cellsOf(double res_h) {
  MatrixConfig config;
  config.bits_below = 0;
  config.res_h = res_h;
  return config;
}

/// Which points of a ground cell stay. Heights above the bottom of the cell [m].
std::vector<bool> groundPoints(const std::vector<double>& heights, double res_h,
                               const FineGroundConfig& config) {
  for (int bin = 0; bin * config.bin_height < res_h; ++bin) {
    std::vector<bool> ground;
    double points = 0;
    for (const double height : heights) {
      ground.push_back(height < (bin + 1) * config.bin_height);
      points += ground.back() ? 1 : 0;
    }
    if (points / static_cast<double>(heights.size()) >= config.ground_ratio) return ground;
  }
  return std::vector<bool>(heights.size(), true);
}

/// A column with one cell of points, at `bit`, and the state that segmentation needs of it.
void fill(Tile& tile, std::size_t column, int bit, const std::vector<double>& heights, int bins,
          const FineGroundConfig& config) {
  tile.occupied[column] = Bits{0b11} << bit;
  for (const double height : heights) {
    const int bin =
        FineGround(cellsOf(bins * config.bin_height), config).binInCell(static_cast<float>(height));
    ++tile.fine_counts[column * static_cast<std::size_t>(bins) + static_cast<std::size_t>(bin)];
  }
}

TEST(FineGround, BinsCoverTheCellAndNotMore) {
  EXPECT_EQ(FineGround(cellsOf(0.5), fineConfig(0.1, 0.85)).bins(), 5);
  EXPECT_EQ(FineGround(cellsOf(0.2), fineConfig(0.1, 0.85)).bins(), 2);
  EXPECT_EQ(FineGround(cellsOf(0.25), fineConfig(0.1, 0.85)).bins(), 3);
  EXPECT_EQ(FineGround(cellsOf(0.1), fineConfig(0.1, 0.85)).bins(), 1);
  for (int bins = 1; bins <= 60; ++bins) {
    for (const double height : {0.01, 0.03, 0.07, 0.1}) {
      EXPECT_EQ(FineGround(cellsOf(bins * height), fineConfig(height, 0.85)).bins(), bins);
    }
  }
}

TEST(FineGround, APointLiesInTheBinOfItsHeight) {
  const FineGroundConfig config = fineConfig(0.125, 0.85);
  for (int bin = 0; bin < 4; ++bin) {
    for (const float within : {0.0F, 0.06F, 0.12F}) {
      EXPECT_EQ(FineGround(cellsOf(4 * config.bin_height), config)
                    .binInCell(0.125F * static_cast<float>(bin) + within),
                bin);
    }
  }
  EXPECT_EQ(FineGround(cellsOf(4 * config.bin_height), config).binInCell(-1e-6F), 0)
      << "rounding below the cell";
  EXPECT_EQ(FineGround(cellsOf(4 * config.bin_height), config).binInCell(0.5F), 3)
      << "rounding above the cell, and the top bit";
}

TEST(FineGround, HeightsFarAboveTheTopBitAreInTheLastBin) {
  for (const float height : {1e3F, 1e8F, 1e12F, 1e30F}) {
    EXPECT_EQ(FineGround(cellsOf(0.05), fineConfig(0.01, 0.85)).binInCell(height), 4) << height;
  }
}

TEST(FineGround, GroundBinsReachTheRatio) {
  const std::vector<std::uint32_t> counts{80, 5, 10, 5};
  EXPECT_EQ(groundBins(counts.data(), 4, 0.5), 1);
  EXPECT_EQ(groundBins(counts.data(), 4, 0.80), 1);
  EXPECT_EQ(groundBins(counts.data(), 4, 0.801), 2);
  EXPECT_EQ(groundBins(counts.data(), 4, 0.85), 2);
  EXPECT_EQ(groundBins(counts.data(), 4, 0.9), 3);
  EXPECT_EQ(groundBins(counts.data(), 4, 1.0), 4);
}

TEST(FineGround, SplitsAColumnLikeItsListOfPoints) {
  for (std::uint32_t seed = 0; seed < 30; ++seed) {
    Random random(seed);
    // Exact binary fractions, so that no point lies beside a border by rounding.
    const FineGroundConfig config =
        fineConfig(random.pick<double>({0.03125, 0.0625, 0.125}), random.uniform(0.01, 0.99));
    const double res_h = random.pick<double>({0.25, 0.5, 1.0});
    const int bins = FineGround(cellsOf(res_h), config).bins();
    TileMap map(bins);
    Tile& tile = map.tileAt({-1, 0});
    std::vector<std::vector<double>> columns(Tile::kColumns);
    for (std::size_t column = 0; column < columns.size(); ++column) {
      const double ground_top = random.uniform(0.02, res_h);
      for (int i = random.integer(1, 60); i > 0; --i) {
        const double top = random.chance(0.8) ? ground_top : res_h;
        columns[column].push_back(std::min(test::dyadic(random.uniform(0.0, top)), res_h - 0.001));
      }
      const int bit = random.integer(0, 40);
      fill(tile, column, bit, columns[column], bins, config);
      tile.dynamic[column] = Bits{1} << (bit + 1);
    }
    segmentFineGround(tile, config);
    for (std::size_t column = 0; column < columns.size(); ++column) {
      const std::vector<bool> expected = groundPoints(columns[column], res_h, config);
      for (std::size_t i = 0; i < columns[column].size(); ++i) {
        const int bin = FineGround(cellsOf(bins * config.bin_height), config)
                            .binInCell(static_cast<float>(columns[column][i]));
        ASSERT_EQ(bin < tile.static_bins[column], expected[i])
            << "seed " << seed << " column " << column << " height " << columns[column][i];
      }
    }
  }
}

TEST(FineGround, WithoutADynamicUpperNeighbourAllGroundStays) {
  const FineGroundConfig config = fineConfig(0.125, 0.5);
  TileMap map(4);
  Tile& tile = map.tileAt({0, 0});
  const std::vector<double> heights{0.0, 0.0, 0.0, 0.4};
  for (std::size_t column = 0; column < 4; ++column) fill(tile, column, 3, heights, 4, config);
  tile.dynamic[1] = Bits{1} << 4;
  tile.dynamic[2] = Bits{1} << 5;
  tile.dynamic[3] = Bits{1} << 2;
  segmentFineGround(tile, config);
  EXPECT_EQ(tile.static_bins[0], 0) << "nothing dynamic";
  EXPECT_EQ(tile.static_bins[1], 1) << "the upper neighbour is dynamic";
  EXPECT_EQ(tile.static_bins[2], 0) << "a cell further up is dynamic";
  EXPECT_EQ(tile.static_bins[3], 0) << "a cell below is dynamic";
}

TEST(FineGround, AGroundCellInTheTopBitHasNoUpperNeighbour) {
  const FineGroundConfig config = fineConfig(0.125, 0.5);
  TileMap map(4);
  Tile& tile = map.tileAt({0, 0});
  tile.occupied[0] = Bits{1} << 63;
  tile.dynamic[0] = ~Bits{0} >> 1;
  segmentFineGround(tile, config);
  EXPECT_EQ(tile.static_bins[0], 0);
}

TEST(FineGround, ManyBinsDoNotWrapAround) {
  // The finest bins in the highest cell that the parameters' ranges allow.
  const FineGroundConfig config = fineConfig(0.01, 1.0);
  const int bins = FineGround(cellsOf(5.0), config).bins();
  ASSERT_EQ(bins, 500);
  TileMap map(bins);
  Tile& tile = map.tileAt({0, 0});
  for (std::size_t column = 0; column < 500; ++column) {
    fill(tile, column, 0, {0.0, 0.01 * (static_cast<double>(column) + 0.5)}, bins, config);
    tile.dynamic[column] = 0b10;
  }
  segmentFineGround(tile, config);
  for (std::size_t column = 0; column < 500; ++column) {
    ASSERT_EQ(static_cast<int>(tile.static_bins[column]), static_cast<int>(column) + 1);
  }
}

}  // namespace
}  // namespace beautymap
