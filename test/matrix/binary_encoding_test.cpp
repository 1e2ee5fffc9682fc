// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/matrix/binary_encoding.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <utility>

#include "beautymap/matrix/tile_map.h"
#include "test_scenes.h"

namespace beautymap {
namespace {

using test::Random;

MatrixConfig matrixConfig(double res_g, double res_h, int n_bit) {
  MatrixConfig config;
  config.bits_below = 0;
  config.res_g = res_g;
  config.res_h = res_h;
  config.n_bit = n_bit;
  return config;
}

/// k = floor((z - g) / res_h), as Algorithm 1 has it; -1: skipped.
int bitByFormula(double z, double ground, const MatrixConfig& config) {
  const double k = std::floor((z - ground) / config.res_h);
  if (k < 0) return -1;
  return k >= config.n_bit ? config.n_bit - 1 : static_cast<int>(k);
}

/// How far a value may be from an integer, so that float may round it to the other side: z, ground
/// and 1 / res_h are each rounded once, and so are the difference and the product.
double roundingOf(double z, double ground, double res_h) {
  return 4.0 * std::numeric_limits<float>::epsilon() * (std::abs(z) + std::abs(ground)) / res_h;
}

TEST(BinaryEncoding, BitAgreesWithTheFormulaInDouble) {
  int compared = 0;
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    const MatrixConfig config =
        matrixConfig(1.0, random.uniform(0.02, 5.0), random.integer(2, kMaxBits));
    const BinaryEncoding encoding(config);
    for (int i = 0; i < 200; ++i) {
      const auto ground = static_cast<float>(random.uniform(-30.0, 30.0));
      const auto z =
          static_cast<float>(ground + random.uniform(-2.0, 1.2 * config.n_bit) * config.res_h);
      const double k = (static_cast<double>(z) - ground) / config.res_h;
      if (std::abs(k - std::round(k)) < roundingOf(z, ground, config.res_h)) continue;
      ++compared;
      ASSERT_EQ(encoding.bitIndex(z, ground), bitByFormula(z, ground, config))
          << "seed " << seed << " z " << z << " ground " << ground;
    }
  }
  EXPECT_GT(compared, 38000) << "of 40000: hardly a value lies beside the border of a bit";
}

TEST(BinaryEncoding, ABitBeginsExactlyAtItsLowerBorder) {
  for (int n_bit = 2; n_bit <= kMaxBits; ++n_bit) {
    const BinaryEncoding encoding(matrixConfig(1.0, 0.25, n_bit));
    for (int k = 0; k < n_bit; ++k) {
      const float ground = -3.5F;
      EXPECT_EQ(encoding.bitIndex(ground + 0.25F * static_cast<float>(k), ground), k);
      EXPECT_EQ(encoding.bit(ground + 0.25F * static_cast<float>(k), ground), Bits{1} << k);
    }
  }
}

TEST(BinaryEncoding, PointsBelowTheGroundHaveNoBit) {
  const BinaryEncoding encoding(matrixConfig(1.0, 0.5, 32));
  for (const float depth : {1e-3F, 0.4F, 0.6F, 20.0F, 1e9F}) {
    EXPECT_EQ(encoding.bitIndex(-depth, 0.0F), -1) << depth;
    EXPECT_EQ(encoding.bit(-depth, 0.0F), 0U) << depth;
  }
}

TEST(BinaryEncoding, WithoutGroundThereIsNoBit) {
  const BinaryEncoding encoding(matrixConfig(1.0, 0.5, 32));
  EXPECT_EQ(encoding.bit(2.0F, Tile::kNoHeight), 0U);
}

TEST(BinaryEncoding, WhateverIsAboveTheTopIsTheHighestBit) {
  for (int n_bit = 2; n_bit <= kMaxBits; ++n_bit) {
    const BinaryEncoding encoding(matrixConfig(1.0, 0.5, n_bit));
    const float top = 0.5F * static_cast<float>(n_bit);
    for (const float above : {0.0F, 0.1F, 7.0F, 1e6F, 1e30F, test::kInfinity}) {
      EXPECT_EQ(encoding.bit(top + above, 0.0F), Bits{1} << (n_bit - 1));
    }
  }
}

TEST(BinaryEncoding, AScanSetsExactlyTheBitsOfItsPoints) {
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    Random random(seed);
    const MatrixConfig config =
        matrixConfig(random.pick<double>({0.25, 0.5, 1.0, 2.0}),
                     random.pick<double>({0.125, 0.25, 0.5}), random.integer(2, kMaxBits));
    const ColumnIndex anchor{random.integer(-2000, 2000), random.integer(-2000, 2000)};
    const ColumnWindow window{{anchor.x - random.integer(0, 12), anchor.y - random.integer(0, 12)},
                              random.integer(1, 20)};
    HeightGrid ground(window, Tile::kNoHeight);
    for (int x = 0; x < window.size; ++x) {
      for (int y = 0; y < window.size; ++y) {
        if (random.chance(0.8)) {
          ground.at(x, y) = static_cast<float>(test::dyadic(random.uniform(-2.0, 2.0)));
        }
      }
    }
    // Multiples of 1/1024 make columns and bits exact, and half of the points shall lie outside the
    // window.
    std::vector<Eigen::Vector3d> points;
    std::map<std::pair<int, int>, Bits> expected;
    for (int i = 0; i < 400; ++i) {
      const double extent = 24.0 * config.res_g;
      points.emplace_back(test::dyadic(random.uniform(-extent, extent)),
                          test::dyadic(random.uniform(-extent, extent)),
                          test::dyadic(random.uniform(-3.0, 20.0)));
      const int x = anchor.x + static_cast<int>(std::floor(points.back().x() / config.res_g));
      const int y = anchor.y + static_cast<int>(std::floor(points.back().y() / config.res_g));
      if (!window.contains({x, y})) continue;
      const float g = ground.at(x - window.corner.x, y - window.corner.y);
      const int k = std::isfinite(g) ? bitByFormula(points.back().z(), g, config) : -1;
      if (k >= 0) expected[{x, y}] |= Bits{1} << k;
    }
    const Eigen::Vector3d sensor(0.1, 0.1, 0.0);
    const BitGrid grid =
        encodeScan(test::placedScan(anchor, sensor, points, config.res_g), ground, config);
    ASSERT_EQ(grid.size(), window.size);
    for (int x = 0; x < window.size; ++x) {
      for (int y = 0; y < window.size; ++y) {
        const auto found = expected.find({window.corner.x + x, window.corner.y + y});
        ASSERT_EQ(grid.at(x, y), found == expected.end() ? 0 : found->second)
            << "seed " << seed << " column " << x << ' ' << y;
      }
    }
  }
}

/// Points of one column, mostly within one cell.
PlacedScan randomRun(Random& random) {
  std::vector<Eigen::Vector3d> points;
  const double z = random.uniform(-2.0, 30.0);
  const double extent = random.pick<double>({0.0, 0.05, 0.5, 20.0});
  for (int i = random.integer(1, 20); i > 0; --i) {
    points.emplace_back(0.25, 0.25, z + random.uniform(0.0, extent));
  }
  return test::placedScan({0, 0}, {0.0, 0.0, 0.0}, points);
}

TEST(BinaryEncoding, ARunHasTheBitsOfEachOfItsPoints) {
  for (std::uint32_t seed = 0; seed < 500; ++seed) {
    Random random(seed);
    const PlacedScan scan = randomRun(random);
    ASSERT_EQ(scan.runs.size(), 1U);
    const MatrixConfig config = matrixConfig(0.5, 0.2, random.integer(2, kMaxBits));
    const BinaryEncoding encoding(config);
    const float ground = random.chance(0.1) ? Tile::kNoHeight : scan.z[0] - 1.0F;
    Bits bits = 0;
    for (const float z : scan.z) bits |= encoding.bit(z, ground);
    EXPECT_EQ(encoding.bits(scan, scan.runs[0], ground), bits) << "seed " << seed;
  }
}

TEST(ColumnGrid, FloorToIntIsFloor) {
  Random random(7);
  for (int i = 0; i < 10000; ++i) {
    const auto value = static_cast<float>(random.uniform(-1e6, 1e6));
    ASSERT_EQ(floorToInt(value), static_cast<int>(std::floor(value)));
  }
  for (int i = -100; i <= 100; ++i) {
    const auto value = static_cast<float>(i);
    EXPECT_EQ(floorToInt(value), i);
    EXPECT_EQ(floorToInt(std::nextafter(value, -1e9F)), i == 0 ? -1 : i - 1);
    EXPECT_EQ(floorToInt(std::nextafter(value, 1e9F)), i);
  }
}

TEST(ColumnGrid, BitHelpersAgreeWithLoopsOverTheBits) {
  for (int count = -2; count <= 70; ++count) {
    Bits expected = 0;
    for (int k = 0; k < std::min(count, kMaxBits); ++k) expected |= Bits{1} << k;
    EXPECT_EQ(lowBits(count), expected) << count;
  }
  EXPECT_EQ(lowestBit(0), 0U);
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const Bits column = random.bits() << random.integer(0, 63) >> random.integer(0, 63);
    if (column == 0) continue;
    int low = 0, high = kMaxBits - 1;
    while ((column >> low & 1) == 0) ++low;
    while ((column >> high & 1) == 0) --high;
    ASSERT_EQ(lowestBitIndex(column), low);
    ASSERT_EQ(highestBitIndex(column), high);
    ASSERT_EQ(lowestBit(column), Bits{1} << low);
  }
}

}  // namespace
}  // namespace beautymap
