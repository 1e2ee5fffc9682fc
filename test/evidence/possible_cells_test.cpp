// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/evidence/possible_cells.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "beautymap/matrix/binary_encoding.h"
#include "test_scenes.h"

namespace beautymap {
namespace {

TEST(HeightBins, PossibleCellsContainEveryCellThatAPointIsIn) {
  int possible = 0, occupied = 0;
  for (std::uint32_t seed = 0; seed < 2000; ++seed) {
    test::Random random(seed);
    MatrixConfig config;
    config.res_h = random.pick<double>({0.1, 0.2, 0.5});
    config.n_bit = random.pick<int>({2, 32, 64});
    const BinaryEncoding encoding(config);
    const HeightBins bins(config);
    const auto ground = static_cast<float>(random.uniform(-50.0, 50.0));
    Bits heights = 0, cells = 0;
    for (int i = random.integer(1, 20); i > 0; --i) {
      const auto z = static_cast<float>(ground + random.uniform(-3.0, 40.0));
      const double cell = (static_cast<double>(z) - static_cast<double>(ground)) / config.res_h;
      if (std::abs(cell - std::round(cell)) < 1e-3) continue;  // rounding decides
      heights |= bins.bin(z);
      cells |= encoding.bit(z, ground);
    }
    const Bits found = bins.possibleCells(heights, ground);
    ASSERT_EQ(cells & ~found, Bits{0}) << "seed " << seed;
    ASSERT_EQ(found & ~lowBits(config.n_bit), Bits{0}) << "seed " << seed;
    occupied += __builtin_popcountll(cells);
    possible += __builtin_popcountll(found);
  }
  EXPECT_LT(possible, 4 * occupied);
  EXPECT_EQ(HeightBins(MatrixConfig()).possibleCells(0, 1.0F), Bits{0});
}

TEST(HeightBins, ARunHasTheBinsOfEachOfItsPoints) {
  for (std::uint32_t seed = 0; seed < 500; ++seed) {
    test::Random random(seed);
    const double extent = random.pick<double>({0.0, 0.02, 3.0});
    const double z = random.uniform(-50.0, 50.0);
    std::vector<Eigen::Vector3d> points;
    for (int i = random.integer(1, 9); i > 0; --i) {
      points.emplace_back(0.25, 0.25, z + random.uniform(0.0, extent));
    }
    const PlacedScan scan = test::placedScan({0, 0}, {0.0, 0.0, 0.0}, points);
    ASSERT_EQ(scan.runs.size(), 1U);
    const HeightBins height_bins((MatrixConfig()));
    Bits bins = 0;
    for (const float height : scan.z) bins |= height_bins.bin(height);
    EXPECT_EQ(height_bins.bins(scan, scan.runs[0]), bins) << "seed " << seed;
  }
}

}  // namespace
}  // namespace beautymap
