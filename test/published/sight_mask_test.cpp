// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/published/sight_mask.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "beautymap/matrix/tile_map.h"
#include "test_scenes.h"

namespace beautymap {
namespace {

using test::Random;

constexpr double kDegree = 3.14159265358979323846 / 180.0;

std::vector<double> sortedSlopes(const PlacedScan& scan) {
  std::vector<double> slopes;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Eigen::Vector3d ray = (scan.point(i) - scan.sensor).cast<double>();
    slopes.push_back(ray.z() / std::hypot(ray.x(), ray.y()));
  }
  std::sort(slopes.begin(), slopes.end());
  return slopes;
}

std::vector<Eigen::Vector3d> randomPoints(Random& random, int count) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < count; ++i) {
    points.emplace_back(random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(-3, 6));
  }
  return points;
}

/// A window around the anchor column, and everything that the sight mask looks at, at random.
struct Case {
  explicit Case(std::uint32_t seed) {
    Random random(seed);
    matrix.res_g = random.pick<double>({0.25, 0.5, 1.0, 1.5});
    matrix.res_h = random.uniform(0.1, 1.0);
    matrix.n_bit = random.integer(2, kMaxBits);
    config.blind_radius = random.uniform(0.0, 5.0);
    config.sight_range = random.uniform(0.0, 20.0);
    config.steepest_share = random.pick<double>({0.5, 0.9, 0.999, 1.0});
    const ColumnIndex anchor{random.integer(-5000, 5000), random.integer(-5000, 5000)};
    const ColumnWindow window{{anchor.x - 12, anchor.y - random.integer(0, 24)}, 25};
    const Eigen::Vector3d sensor(random.uniform(0.0, matrix.res_g),
                                 random.uniform(0.0, matrix.res_g), random.uniform(-1.0, 3.0));
    scan = test::placedScan(anchor, sensor, randomPoints(random, random.integer(1, 500)));
    scan_bits = BitGrid(window, 0);
    map = {BitGrid(window, 0), HeightGrid(window, Tile::kNoHeight),
           ColumnGrid<std::uint8_t>(window, 0)};
    for (int x = 0; x < window.size; ++x) {
      for (int y = 0; y < window.size; ++y) {
        if (random.chance(0.2)) continue;
        map.ground.at(x, y) = static_cast<float>(random.uniform(-3.0, 1.0));
        map.below_ground.at(x, y) = random.chance(0.2);
        map.occupied.at(x, y) = random.bits() & lowBits(matrix.n_bit);
        if (random.chance(0.6)) scan_bits.at(x, y) = map.occupied.at(x, y) & random.bits();
      }
    }
  }

  double distanceTo(int x, int y) const {
    const ColumnIndex corner = scan_bits.window().corner;
    return std::hypot((corner.x - scan.anchor.x + x + 0.5) * matrix.res_g - scan.sensor.x(),
                      (corner.y - scan.anchor.y + y + 0.5) * matrix.res_g - scan.sensor.y());
  }

  static MatrixConfig published() {
    MatrixConfig config;
    config.bits_below = 0;
    return config;
  }
  MatrixConfig matrix = published();
  RestorationConfig config;
  PlacedScan scan;
  BitGrid scan_bits;
  MapWindow map;
};

BitGrid cellsInSightOf(const Case& c) {
  PlacedScan scan = c.scan;
  scan.steepest_slope = steepestSlope(scan, c.config.steepest_share);
  return cellsInSight(scan, c.scan_bits, c.map, c.matrix, c.config);
}

/// Whether the scan could have seen bit k of a column; nothing where float may round to the other
/// side: radii and heights of up to 100 m, rounded a few times, differ by less than 1e-3 of a bit
/// and of a metre.
std::optional<bool> inSight(const Case& c, double slope, int x, int y, int k) {
  constexpr double kRounding = 1e-3;
  const double distance = c.distanceTo(x, y);
  if (std::abs(distance - c.config.blind_radius) < kRounding) return std::nullopt;
  if (std::abs(distance - c.config.sight_range) < kRounding) return std::nullopt;
  if (distance < c.config.blind_radius) return false;
  const Bits hits = c.scan_bits.at(x, y);
  const bool ground_seen = (hits & 1) != 0;
  if (!ground_seen && distance > c.config.sight_range) return false;
  // Where the ground bit alone was hit, the beam came down through all that is above it. And in a
  // column with multi-path returns below ground the highest hit proves nothing.
  int highest_hit = -1;
  for (int bit = 1; bit < kMaxBits; ++bit) {
    if ((hits >> bit & 1) != 0) highest_hit = bit;
  }
  if (highest_hit > 0 && c.map.below_ground.at(x, y) == 0) return k < highest_hit;
  const double bits_in_view =
      (c.scan.sensor.z() + slope * distance - c.map.ground.at(x, y)) / c.matrix.res_h;
  if (std::abs(bits_in_view - std::round(bits_in_view)) < kRounding) return std::nullopt;
  return k < std::ceil(bits_in_view);
}

TEST(SightMask, AgreesWithALoopOverTheBits) {
  std::uint64_t compared = 0, undecided = 0;
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    const Case c(seed);
    const BitGrid in_sight = cellsInSightOf(c);
    const double slope = static_cast<double>(steepestSlope(c.scan, c.config.steepest_share));
    for (int x = 0; x < in_sight.size(); ++x) {
      for (int y = 0; y < in_sight.size(); ++y) {
        for (int k = 0; k < kMaxBits; ++k) {
          if ((c.map.occupied.at(x, y) >> k & 1) == 0) continue;
          const std::optional<bool> expected = inSight(c, slope, x, y, k);
          if (!expected) {
            ++undecided;
            continue;
          }
          ++compared;
          ASSERT_EQ((in_sight.at(x, y) >> k & 1) != 0, *expected)
              << "seed " << seed << " column " << x << ' ' << y << " bit " << k;
        }
      }
    }
  }
  EXPECT_LT(undecided, compared / 100);
}

TEST(SteepestSlope, IsTheQuantileOfTheSortedSlopes) {
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    Random random(seed);
    const PlacedScan scan =
        test::placedScan({0, 0}, {0.3, 0.2, 1.0}, randomPoints(random, random.integer(1, 3000)));
    const double share = random.pick<double>({0.5, 0.75, 0.99, 0.999, 1.0});
    const std::vector<double> slopes = sortedSlopes(scan);
    const double expected =
        slopes[static_cast<std::size_t>(share * static_cast<double>(slopes.size() - 1))];
    // Slopes are computed in float, from coordinates of up to 20 m.
    EXPECT_NEAR(steepestSlope(scan, share), expected, 1e-5 * (1.0 + std::abs(expected))) << seed;
  }
}

TEST(SteepestSlope, OfAManyPointedScanLiesAtItsRank) {
  Random random(11);
  const PlacedScan scan = test::placedScan({0, 0}, {0.3, 0.2, 1.0}, randomPoints(random, 100000));
  const std::vector<double> slopes = sortedSlopes(scan);
  for (const double share : {0.5, 0.9, 0.999}) {
    const auto rank = static_cast<double>(
        std::lower_bound(slopes.begin(), slopes.end(), steepestSlope(scan, share) - 1e-5) -
        slopes.begin());
    // A sample of n >= 10000 points estimates a quantile q with a deviation of sqrt(q (1 - q) / n);
    // five of them.
    const double deviation = std::sqrt(share * (1.0 - share) / 10000.0);
    EXPECT_NEAR(rank / static_cast<double>(slopes.size()), share, 5.0 * deviation) << share;
  }
}

TEST(SteepestSlope, OneSteepOutlierDoesNotOpenTheSky) {
  Random random(2);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 5000; ++i) points.emplace_back(10.0, random.uniform(-5, 5), 2.0);
  points.emplace_back(0.01, 0.0, 30.0);
  const PlacedScan scan = test::placedScan({0, 0}, Eigen::Vector3d::Zero(), points);
  EXPECT_LT(steepestSlope(scan, 0.999), 0.201);
  EXPECT_GT(steepestSlope(scan, 1.0), 2900.0);
}

/// Beams in the order in which a spinning sensor fires them, azimuth by azimuth.
PlacedScan firingOrderScan(const std::vector<double>& elevations_deg, int azimuths) {
  std::vector<Eigen::Vector3d> points;
  for (int a = 0; a < azimuths; ++a) {
    const double azimuth = 360.0 * kDegree * a / azimuths;
    for (const double elevation : elevations_deg) {
      points.emplace_back(10.0 * std::cos(azimuth), 10.0 * std::sin(azimuth),
                          10.0 * std::tan(elevation * kDegree));
    }
  }
  return test::placedScan({0, 0}, Eigen::Vector3d::Zero(), points);
}

TEST(SteepestSlope, SeesTheSteepestBeamWhateverTheFiringOrder) {
  // A VLP-16 fires -15, 1, -13, 3, ..., -1, 15 degrees: every second point lies below the horizon.
  std::vector<double> vlp16, rising;
  for (int i = 0; i < 8; ++i) {
    vlp16.push_back(-15.0 + 2.0 * i);
    vlp16.push_back(1.0 + 2.0 * i);
  }
  for (int i = 0; i < 64; ++i) rising.push_back(-24.0 + 0.5 * i);
  for (const int azimuths : {900, 1100, 1800, 2048, 4000, 8000}) {
    EXPECT_NEAR(steepestSlope(firingOrderScan(vlp16, azimuths), 0.99), std::tan(15.0 * kDegree),
                1e-4)
        << azimuths << " azimuths";
  }
  for (const int azimuths : {512, 1024, 2048, 4096}) {
    EXPECT_NEAR(steepestSlope(firingOrderScan(rising, azimuths), 0.99), std::tan(7.5 * kDegree),
                1e-4)
        << azimuths << " azimuths";
  }
}

/// Flat ground at 0, each column occupied from bottom to top, a sensor at 2 m in the middle of the
/// window's middle column, and one beam that looks up at 45 degrees.
Case openSquare() {
  Case c(0);
  c.matrix.res_g = 1.0;
  c.matrix.res_h = 0.5;
  c.matrix.n_bit = 32;
  c.config = RestorationConfig();
  c.config.steepest_share = 1.0;
  c.scan = test::placedScan({0, 0}, {0.5, 0.5, 2.0}, {{10.5, 0.5, 12.0}});
  const ColumnWindow window{{-20, -20}, 41};
  c.scan_bits = BitGrid(window, 0);
  c.map = {BitGrid(window, lowBits(32)), HeightGrid(window, 0.0F),
           ColumnGrid<std::uint8_t>(window, 0)};
  return c;
}

Bits sightAt(const Case& c, int x, int y) { return cellsInSightOf(c).at(x + 20, y + 20); }

TEST(SightMask, TheBlindRadiusIsNeverJudged) {
  Case c = openSquare();
  c.config.blind_radius = 3.5;
  EXPECT_EQ(sightAt(c, 0, 0), 0U);
  EXPECT_EQ(sightAt(c, 3, 0), 0U);
  EXPECT_EQ(sightAt(c, -2, 2), 0U);
  EXPECT_NE(sightAt(c, 4, 0), 0U);
  EXPECT_NE(sightAt(c, -3, 3), 0U);
}

TEST(SightMask, NothingAboveTheSteepestViewIsInSight) {
  const Case c = openSquare();
  // At 5 m the view ends at 2 + 5 m above ground: 14 bits of 0.5 m, and the float slope may open
  // the next.
  const Bits in_sight = sightAt(c, 5, 0);
  EXPECT_EQ(in_sight & lowBits(14), lowBits(14));
  EXPECT_EQ(in_sight & ~lowBits(15), 0U);
}

TEST(SightMask, BeyondTheSightRangeOnlyColumnsWithSeenGroundAreJudged) {
  Case c = openSquare();
  c.config.sight_range = 10.0;
  EXPECT_NE(sightAt(c, 10, 0), 0U);
  EXPECT_EQ(sightAt(c, 11, 0), 0U);
  c.scan_bits.at(20 + 11, 20) = 1;
  EXPECT_NE(sightAt(c, 11, 0), 0U);
  c.scan_bits.at(20 + 11, 20) = 2;  // a hit, but not of the ground
  EXPECT_EQ(sightAt(c, 11, 0), 0U);
}

TEST(SightMask, WhatIsAtOrAboveTheHighestHitIsProtected) {
  Case c = openSquare();
  c.scan_bits.at(20 + 5, 20) = 0b100101;
  EXPECT_EQ(sightAt(c, 5, 0), lowBits(5));
}

TEST(SightMask, AnEmptyScanSeesNothing) {
  Case c = openSquare();
  c.config.blind_radius = 0.0;  // also where the distance is zero
  c.scan = test::placedScan(c.scan.anchor, c.scan.sensor.cast<double>(), {});
  const BitGrid in_sight = cellsInSightOf(c);
  for (int x = 0; x < in_sight.size(); ++x) {
    for (int y = 0; y < in_sight.size(); ++y) EXPECT_EQ(in_sight.at(x, y), 0U);
  }
}

TEST(SightMask, APointStraightAboveTheSensorHasNoSlope) {
  const PlacedScan above = test::placedScan({0, 0}, {0.5, 0.5, 1.0}, {{0.5, 0.5, 9.0}});
  EXPECT_EQ(steepestSlope(above, 1.0), -test::kInfinity);
}

}  // namespace
}  // namespace beautymap
