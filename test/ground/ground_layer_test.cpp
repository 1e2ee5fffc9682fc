// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/ground/ground_layer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "ground/whole_bins.h"
#include "test_scenes.h"

namespace beautymap {
namespace {

using test::kBottom;
using test::kCell;
using test::Random;
using test::randomCount;
using test::WholeBins;

/// The sum of twelve uniform values is as good as normally distributed.
double noise(Random& random, double sigma) {
  double sum = -6.0;
  for (int i = 0; i < 12; ++i) sum += random.uniform(0.0, 1.0);
  return sigma * sum;
}

/// The points of one column, as counts per bin.
class Histogram {
 public:
  explicit Histogram(const GroundLayerConfig& config)
      : config_(config),
        layer_(config, kCell),
        counts_(static_cast<std::size_t>(layer_.bins()), 0) {}

  void add(double above_ground) {
    const int bin = layer_.binOf(static_cast<float>(above_ground));
    if (bin >= 0 && bin < layer_.bins()) ++counts_[static_cast<std::size_t>(bin)];
  }
  void addGround(Random& random, int points, double height, double sigma) {
    for (int i = 0; i < points; ++i) add(height + noise(random, sigma));
  }
  void addObject(Random& random, int points, double low, double high) {
    for (int i = 0; i < points; ++i) add(random.uniform(low, high));
  }

  int groundBins(bool object_above = false) const {
    return layer_.groundBins(counts_.data(), object_above);
  }
  bool standsOut() const { return layer_.standsOut(counts_.data()); }
  /// Where the layer ends above the coarse ground [m].
  double end() const { return kBottom + groundBins() * config_.bin_height; }

 private:
  GroundLayerConfig config_;
  GroundLayer layer_;
  std::vector<std::uint32_t> counts_;
};

TEST(GroundLayer, WithoutPointsThereIsNone) {
  EXPECT_EQ(Histogram(GroundLayerConfig()).groundBins(), 0);
}

TEST(GroundLayer, PointsAboveTheSearchedHeightAloneAreNoGround) {
  const GroundLayerConfig config;
  Histogram histogram(config);
  for (int i = 0; i < 100; ++i) histogram.add(config.search_height + config.bin_height);
  EXPECT_EQ(histogram.groundBins(), 0);
}

TEST(GroundLayer, FlatGroundEndsWithinTwoBinsOfItsNoise) {
  const GroundLayerConfig config;
  constexpr double kSigma = 0.02;
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    // The coarse ground is near the lowest point.
    const double height = random.uniform(0.0, 3.0 * kSigma);
    Histogram histogram(config);
    histogram.addGround(random, random.integer(50, 2000), height, kSigma);
    EXPECT_GT(histogram.end(), height + kSigma) << "seed " << seed;
    EXPECT_LT(histogram.end(), height + 3.0 * kSigma + 2.0 * config.bin_height) << "seed " << seed;
  }
}

TEST(GroundLayer, ThickNoisyGroundIsKeptAlmostWhole) {
  GroundLayerConfig config;
  constexpr double kSigma = 0.08;
  // Finer bins end the layer a little lower.
  for (const auto& [bin_height, kept] : {std::pair(0.05, 1.5), std::pair(0.025, 1.4)}) {
    config.bin_height = bin_height;
    for (std::uint32_t seed = 0; seed < 200; ++seed) {
      Random random(seed);
      const double height = random.uniform(kSigma, 3.0 * kSigma);
      Histogram histogram(config);
      histogram.addGround(random, random.integer(1000, 5000), height, kSigma);
      EXPECT_GT(histogram.end(), height + kept * kSigma) << "seed " << seed;
      EXPECT_LT(histogram.end(), height + 3.0 * kSigma + 2.0 * bin_height) << "seed " << seed;
    }
  }
}

TEST(GroundLayer, ManyPointsOfAnObjectAboveTheGroundDoNotMoveTheLayer) {
  for (const double sigma : {0.005, 0.02, 0.03}) {
    for (std::uint32_t seed = 0; seed < 100; ++seed) {
      Random random(seed);
      const double height = random.uniform(0.0, 2.0 * sigma);
      const int points = random.integer(300, 2000);
      Histogram histogram((GroundLayerConfig()));
      histogram.addGround(random, points, height, sigma);
      const int without = histogram.groundBins();
      histogram.addObject(random, 3 * points, height + 0.25, height + 1.8);
      EXPECT_EQ(histogram.groundBins(), without) << "sigma " << sigma << " seed " << seed;
    }
  }
}

TEST(GroundLayer, AnObjectAtOneHeightAboveTheSearchedOnesDoesNotMoveTheLayer) {
  const GroundLayerConfig config;
  Random random(1);
  Histogram histogram(config);
  histogram.addGround(random, 500, 0.03, 0.02);
  const int without = histogram.groundBins();
  const double low = config.search_height + 0.1 * config.bin_height;
  histogram.addObject(random, 5000, low, low + 0.5 * config.bin_height);
  EXPECT_EQ(histogram.groundBins(), without);
}

TEST(GroundLayer, AnObjectThatStandsOnTheGroundLiftsTheLayerByItsThicknessAtMost) {
  const GroundLayerConfig config;
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    Random random(seed);
    const double height = random.uniform(0.0, 0.04);
    const int points = random.integer(300, 2000);
    Histogram histogram(config);
    histogram.addGround(random, points, height, 0.02);
    histogram.addObject(random, 3 * points, height, height + 1.8);
    EXPECT_LE(histogram.end(), height + config.max_thickness + 2.0 * config.bin_height);
    EXPECT_GT(histogram.end(), height) << "seed " << seed;
  }
}

TEST(GroundLayer, BelowAnObjectASmallPeakInTheGroundCellIsTheGround) {
  // A car stood there: three times the points of the ground, from 0.2 m on.
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    Random random(seed);
    Histogram histogram((GroundLayerConfig()));
    histogram.addGround(random, 300, 0.03, 0.01);
    const int ground = histogram.groundBins();
    histogram.addObject(random, 3000, 0.25, 0.6);
    EXPECT_EQ(histogram.groundBins(true), ground) << "seed " << seed;
    EXPECT_GT(histogram.groundBins(false), ground) << "seed " << seed;
  }
}

TEST(GroundLayer, ASurfaceStandsOutAndTheLowerEndOfAnObjectDoesNot) {
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    Random random(seed);
    Histogram object((GroundLayerConfig())), both((GroundLayerConfig()));
    object.addObject(random, random.integer(100, 2000), 0.0, 1.7);
    EXPECT_FALSE(object.standsOut()) << "seed " << seed;
    both.addObject(random, 500, 0.0, 1.7);
    both.addGround(random, 400, 0.05, 0.01);
    EXPECT_TRUE(both.standsOut()) << "seed " << seed;
  }
}

TEST(GroundLayer, BinsAreCountedFromBelowTheCoarseGround) {
  int decided = 0;
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    Random random(seed);
    GroundLayerConfig config;
    config.bin_height = random.uniform(0.01, 0.5);
    config.search_height = random.uniform(0.05, 2.0);
    config.max_thickness = random.uniform(0.01, 1.0);
    const GroundLayer layer(config, kCell);
    ASSERT_GE(layer.bins(), 1);
    for (int i = 0; i < 500; ++i) {
      const auto height = static_cast<float>(random.uniform(-0.5, 4.0));
      const double bins = (static_cast<double>(height) - kBottom) / config.bin_height;
      // At a bin's border rounding decides.
      if (std::abs(bins - std::round(bins)) < 1e-3) continue;
      const int bin = bins < 0.0 ? -1 : std::min(static_cast<int>(bins), layer.bins());
      ASSERT_EQ(layer.binOf(height), bin) << "height " << height << " of " << config.bin_height;
      ++decided;
    }
  }
  EXPECT_GT(decided, 40000);
}

TEST(GroundLayer, NoHeightIsOutsideTheRangeOfBins) {
  const GroundLayer layer(GroundLayerConfig(), kCell);
  constexpr float kHuge = std::numeric_limits<float>::max();
  EXPECT_EQ(layer.binOf(-0.11F), -1);
  EXPECT_EQ(layer.binOf(-1e9F), -1);
  EXPECT_EQ(layer.binOf(-kHuge), -1);
  EXPECT_EQ(layer.binOf(-test::kInfinity), -1);
  EXPECT_EQ(layer.binOf(0.61F), layer.bins());
  EXPECT_EQ(layer.binOf(1e9F), layer.bins());
  EXPECT_EQ(layer.binOf(kHuge), layer.bins());
  EXPECT_EQ(layer.binOf(test::kInfinity), layer.bins());
  EXPECT_EQ(layer.binOf(test::kNan), -1);
}

TEST(GroundLayer, AgreesWithPlainLoopsOnRandomCounts) {
  for (std::uint32_t seed = 0; seed < 3000; ++seed) {
    Random random(seed);
    const WholeBins whole(random);
    const GroundLayer layer(whole.config, kCell);
    ASSERT_EQ(layer.bins(), whole.bins());
    // Exactly as many as there are bins: reading beyond them is an error that sanitizers see.
    std::vector<std::uint32_t> counts(static_cast<std::size_t>(layer.bins()));
    for (std::uint32_t& count : counts) count = randomCount(random);
    for (const bool object_above : {false, true}) {
      ASSERT_EQ(layer.groundBins(counts.data(), object_above),
                whole.groundBins(counts.data(), object_above))
          << "seed " << seed;
    }
  }
}

}  // namespace
}  // namespace beautymap
