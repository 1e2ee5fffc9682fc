// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/published/reverse_ray_casting.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <optional>

#include "beautymap/matrix/tile_map.h"
#include "published/ray_oracle.h"
#include "test_scenes.h"

namespace beautymap {
namespace {

using test::Random;

/// A window of columns with a scan in it. Positions are [m] from the corner of the anchor column.
struct Case {
  Case(ColumnWindow window, ColumnIndex anchor, const Eigen::Vector3d& sensor)
      : candidates(window, 0),
        scan_bits(window, 0),
        ground(window, 0.0F),
        scan(test::placedScan(anchor, sensor, {})) {}

  explicit Case(std::uint32_t seed);

  BitGrid hidden() const { return cellsHidden(candidates, scan_bits, ground, scan, matrix); }

  Eigen::Vector3d centreOf(int x, int y, int k) const {
    const ColumnIndex corner = candidates.window().corner;
    return {(corner.x - scan.anchor.x + x + 0.5) * matrix.res_g,
            (corner.y - scan.anchor.y + y + 0.5) * matrix.res_g,
            static_cast<double>(ground.at(x, y)) + (k + 0.5) * matrix.res_h};
  }

  test::RayOracle oracle() const {
    const int dx = scan.anchor.x - candidates.window().corner.x;
    const int dy = scan.anchor.y - candidates.window().corner.y;
    const auto column_at = [this, dx, dy](int x, int y) {
      if (!scan_bits.inside(x + dx, y + dy)) return test::HitColumn();
      return test::HitColumn{scan_bits.at(x + dx, y + dy), ground.at(x + dx, y + dy)};
    };
    return test::RayOracle(column_at, matrix.res_g, matrix.res_h, matrix.n_bit);
  }

  MatrixConfig matrix;
  BitGrid candidates, scan_bits;
  HeightGrid ground;
  PlacedScan scan;
};

Case::Case(std::uint32_t seed) : Case({{0, 0}, 1}, {0, 0}, Eigen::Vector3d::Zero()) {
  Random random(seed);
  matrix.res_g = random.uniform(0.2, 2.0);
  matrix.res_h = random.uniform(0.1, 1.0);
  matrix.n_bit = random.integer(2, kMaxBits);
  const ColumnIndex anchor{random.integer(-100000, 100000), random.integer(-100000, 100000)};
  const int size = random.integer(2, 25);
  const ColumnWindow window{
      {anchor.x - random.integer(0, size - 1), anchor.y - random.integer(0, size - 1)}, size};
  const double height = matrix.res_h * matrix.n_bit;
  scan = test::placedScan(anchor,
                          {random.uniform(0.0, matrix.res_g), random.uniform(0.0, matrix.res_g),
                           random.uniform(-0.2, 1.2) * std::min(height, 5.0)},
                          {});
  candidates = scan_bits = BitGrid(window, 0);
  ground = HeightGrid(window, Tile::kNoHeight);
  const double share = random.uniform(0.02, 0.5);
  for (int x = 0; x < size; ++x) {
    for (int y = 0; y < size; ++y) {
      if (random.chance(0.1)) continue;  // a column without points in the map
      ground.at(x, y) = static_cast<float>(random.uniform(-1.0, 1.0));
      if (random.chance(share)) {
        scan_bits.at(x, y) = random.bits() & random.bits() & lowBits(matrix.n_bit);
      }
      if (random.chance(20.0 / (size * size))) {
        candidates.at(x, y) = random.bits() & random.bits() & lowBits(matrix.n_bit);
      }
    }
  }
}

TEST(ReverseRayCasting, AgreesWithWalkingAlongTheRayInSmallSteps) {
  std::uint64_t hidden_cells = 0, open_cells = 0, undecided = 0;
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    const Case c(seed);
    const test::RayOracle oracle = c.oracle();
    const BitGrid hidden = c.hidden();
    for (int x = 0; x < hidden.size(); ++x) {
      for (int y = 0; y < hidden.size(); ++y) {
        for (int k = 0; k < kMaxBits; ++k) {
          if ((c.candidates.at(x, y) >> k & 1) == 0) continue;
          const std::optional<bool> expected =
              oracle.hidden(c.centreOf(x, y, k), c.scan.sensor.cast<double>());
          if (!expected) {
            ++undecided;
            continue;
          }
          ++(*expected ? hidden_cells : open_cells);
          ASSERT_EQ((hidden.at(x, y) >> k & 1) != 0, *expected)
              << "seed " << seed << " column " << x << ' ' << y << " bit " << k;
        }
      }
    }
  }
  EXPECT_GT(hidden_cells, 500U);
  EXPECT_GT(open_cells, 500U);
  EXPECT_LT(undecided, (hidden_cells + open_cells) / 100);
}

TEST(ReverseRayCasting, HidesOnlyCandidates) {
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    const Case c(seed);
    const BitGrid hidden = c.hidden();
    for (int x = 0; x < hidden.size(); ++x) {
      for (int y = 0; y < hidden.size(); ++y) {
        EXPECT_EQ(hidden.at(x, y) & ~c.candidates.at(x, y), 0U);
      }
    }
  }
}

TEST(ReverseRayCasting, EachCandidateIsJudgedOnItsOwn) {
  const Case all(17);
  const BitGrid hidden = all.hidden();
  int candidates = 0;
  for (int x = 0; x < hidden.size(); ++x) {
    for (int y = 0; y < hidden.size(); ++y) {
      for (Bits rest = all.candidates.at(x, y); rest != 0; rest &= rest - 1) {
        Case one = all;
        one.candidates = BitGrid(all.candidates.window(), 0);
        one.candidates.at(x, y) = lowestBit(rest);
        ASSERT_EQ(one.hidden().at(x, y), hidden.at(x, y) & lowestBit(rest));
        ++candidates;
      }
    }
  }
  EXPECT_GT(candidates, 10);
}

TEST(ReverseRayCasting, MoreHitsHideAtLeastAsMuch) {
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    Case c(seed);
    const BitGrid before = c.hidden();
    Random random(seed + 1000);
    for (int x = 0; x < before.size(); ++x) {
      for (int y = 0; y < before.size(); ++y) {
        if (c.ground.at(x, y) != Tile::kNoHeight) {
          c.scan_bits.at(x, y) |= random.bits() & random.bits() & lowBits(c.matrix.n_bit);
        }
      }
    }
    const BitGrid after = c.hidden();
    for (int x = 0; x < before.size(); ++x) {
      for (int y = 0; y < before.size(); ++y) EXPECT_EQ(before.at(x, y) & ~after.at(x, y), 0U);
    }
  }
}

/// 1 x 0.5 m cells on flat ground, the sensor at a height of 1.25 m in the middle of column (0, 0),
/// a candidate at the same height in column (8, 0): the ray runs level through bit 2 of each column
/// between.
Case levelRay() {
  Case c({{-10, -10}, 21}, {0, 0}, {0.5, 0.5, 1.25});
  c.matrix.res_g = 1.0;
  c.matrix.res_h = 0.5;
  c.matrix.n_bit = 32;
  c.candidates.at(18, 10) = Bits{1} << 2;
  return c;
}

bool candidateHidden(const Case& c) { return c.hidden().at(18, 10) != 0; }

TEST(ReverseRayCasting, KeepsCellsBehindAWall) {
  Case c = levelRay();
  EXPECT_FALSE(candidateHidden(c));
  for (int y = 0; y < 21; ++y) c.scan_bits.at(14, y) = lowBits(6);
  EXPECT_TRUE(candidateHidden(c));
}

TEST(ReverseRayCasting, AWallBehindTheCellHidesNothing) {
  Case c = levelRay();
  for (int y = 0; y < 21; ++y) c.scan_bits.at(19, y) = lowBits(6);
  EXPECT_FALSE(candidateHidden(c));
}

TEST(ReverseRayCasting, HitsBesideAboveAndBelowTheRayHideNothing) {
  Case c = levelRay();
  for (int x = 10; x < 18; ++x) {
    c.scan_bits.at(x, 10) = ~(Bits{1} << 2);
    c.scan_bits.at(x, 9) = c.scan_bits.at(x, 11) = ~Bits{0};
  }
  EXPECT_FALSE(candidateHidden(c));
}

TEST(ReverseRayCasting, EveryColumnFromTheCellsNeighbourToTheSensorsOwnCanHide) {
  for (int x = 10; x < 18; ++x) {
    Case c = levelRay();
    c.scan_bits.at(x, 10) = Bits{1} << 2;
    EXPECT_TRUE(candidateHidden(c)) << x;
  }
}

TEST(ReverseRayCasting, HitsInTheCellsOwnColumnHideNothing) {
  Case c = levelRay();
  c.scan_bits.at(18, 10) = ~Bits{0};
  EXPECT_FALSE(candidateHidden(c));
}

TEST(ReverseRayCasting, TheHeightOfEachColumnsGroundCounts) {
  Case c = levelRay();
  c.ground.at(14, 10) = -1.0F;
  c.scan_bits.at(14, 10) = Bits{1} << 4;
  EXPECT_TRUE(candidateHidden(c));
  c.scan_bits.at(14, 10) = Bits{1} << 2;
  EXPECT_FALSE(candidateHidden(c));
}

TEST(ReverseRayCasting, ACellInTheSensorsColumnIsNeverHidden) {
  Case c = levelRay();
  c.candidates.at(10, 10) = ~Bits{0};
  c.scan_bits = BitGrid(c.scan_bits.window(), ~Bits{0});
  EXPECT_EQ(c.hidden().at(10, 10), 0U);
}

TEST(ReverseRayCasting, TheTopBitStandsForAllThatIsHigher) {
  Case c = levelRay();
  c.matrix.n_bit = 2;  // the level ray at 1.25 m runs above the top bit's lower border of 0.5 m
  c.candidates.at(18, 10) = 2;
  c.scan_bits.at(14, 10) = 2;
  EXPECT_TRUE(candidateHidden(c));
  c.scan_bits.at(14, 10) = 1;
  EXPECT_FALSE(candidateHidden(c));
}

TEST(ReverseRayCasting, ASensorOutsideTheWindowIsWalkedToUpToTheBorder) {
  for (const double sensor_x : {-500.0, 500.5}) {
    Case c({{-10, -10}, 21}, {0, 0}, {sensor_x, 0.5, 1.25});
    c.matrix = levelRay().matrix;
    c.candidates.at(10, 10) = Bits{1} << 2;
    EXPECT_EQ(c.hidden().at(10, 10), 0U);
    c.scan_bits.at(sensor_x < 0 ? 0 : 20, 10) = Bits{1} << 2;
    EXPECT_EQ(c.hidden().at(10, 10), Bits{1} << 2);
  }
}

}  // namespace
}  // namespace beautymap
