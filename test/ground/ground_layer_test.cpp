// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/ground/ground_layer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "test_scenes.h"

namespace beautymap {
namespace {

using test::Random;

constexpr double kBottom = -0.1;  // of the lowest bin, above the coarse ground [m]
constexpr double kCell = 0.2;     // height of a bit [m]

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

/// The heights are whole numbers of bins, so that nothing has to be rounded.
struct WholeBins {
  explicit WholeBins(Random& random) {
    config.bin_height = random.pick<double>({0.02, 0.05, 0.1});
    below = static_cast<int>(std::lround(-kBottom / config.bin_height));
    search = random.integer(1, 15);
    thickness = random.integer(1, 9);
    config.search_height = search * config.bin_height;
    config.max_thickness = thickness * config.bin_height;
    config.tail_share = random.pick<double>({0.0, 0.1, 0.25, 0.5, 1.0});
    config.min_low_peak = random.pick<double>({0.0, 0.25, 0.5, 1.0});
  }

  int bins() const { return below + search + thickness; }

  int groundBins(const std::uint32_t* counts, bool object_above) const {
    int peak = 0, low_peak = 0;
    for (int i = 1; i < below + search; ++i) {
      if (counts[i] > counts[peak]) peak = i;
      const bool in_cell = i < static_cast<int>(std::lround((kCell - kBottom) / config.bin_height));
      if (in_cell && counts[i] > counts[low_peak]) low_peak = i;
    }
    if (object_above && counts[low_peak] >= config.min_low_peak * counts[peak]) peak = low_peak;
    if (counts[peak] == 0) return 0;
    int ground = 0;
    for (int i = 0; i < bins(); ++i) {
      if (i > peak && counts[i] < config.tail_share * counts[peak]) break;
      if (i > peak + thickness) break;
      ground = i + 1;
    }
    return ground;
  }

  GroundLayerConfig config;
  int below = 0;
  int search = 0;
  int thickness = 0;
};

std::uint32_t randomCount(Random& random) {
  if (random.chance(0.3)) return 0;
  return static_cast<std::uint32_t>(random.integer(0, random.pick<int>({3, 20, 1000000})));
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

TEST(GroundLayer, EachColumnOfAMapGetsItsOwn) {
  Random random(7);
  const WholeBins whole(random);
  const GroundLayer layer(whole.config, kCell);
  TileMap map(layer.bins());
  for (const ColumnIndex tile : {ColumnIndex{0, 0}, ColumnIndex{-3, 5}}) {
    for (std::uint32_t& count : map.tileAt(tile).fine_counts) count = randomCount(random);
  }
  constexpr int kGroundBit = 8;
  map.forEachTile([&](ColumnIndex, Tile& tile) {
    for (std::size_t i = 0; i < tile.dynamic.size(); ++i) {
      tile.dynamic[i] = Bits{1} << (kGroundBit + random.integer(1, 2));
      tile.evidence.touch(i).observe(Bits{1} << kGroundBit, 0);
      for (int free = random.integer(0, 3); free > 0; --free) {
        tile.evidence.touch(i).observe(0, Bits{1} << kGroundBit);
      }
    }
    findGroundLayers(tile, layer, kGroundBit, EvidenceConfig());
  });
  int tiles = 0, objects = 0;
  map.forEachTile([&](ColumnIndex, const Tile& tile) {
    ++tiles;
    for (std::size_t i = 0; i < tile.static_bins.size(); ++i) {
      const std::size_t first = i * static_cast<std::size_t>(layer.bins());
      const std::uint32_t* counts = tile.fine_counts.data() + first;
      const bool object_above = tile.dynamic[i] == Bits{1} << (kGroundBit + 1);
      const bool object =
          object_above && tile.evidence[i].freeAfter(kGroundBit) > 1 && !layer.standsOut(counts);
      ASSERT_EQ(tile.static_bins[i], object ? 0 : whole.groundBins(counts, object_above));
      objects += object ? 1 : 0;
    }
  });
  EXPECT_EQ(tiles, 2);
  EXPECT_GT(objects, 50);
}

/// A column whose cells were hit in so many scans, from the ground cell up.
ColumnEvidence hitColumn(int ground_bit, const std::vector<int>& hits) {
  ColumnEvidence evidence;
  for (int scan = 0; scan < *std::max_element(hits.begin(), hits.end()); ++scan) {
    Bits hit = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
      if (scan < hits[i]) hit |= Bits{1} << (static_cast<std::size_t>(ground_bit) + i);
    }
    evidence.observe(hit, 0);
  }
  return evidence;
}

TEST(GroundLayer, TheLowestCellOfATallObjectMayBeTheObjectsWhereItWasHitAsSeldom) {
  constexpr int kGroundBit = 8;
  const EvidenceConfig config;
  const Bits tall = Bits{0x3E} << kGroundBit;  // five cells above the ground cell
  const auto may_be_object = [&](const std::vector<int>& hits, Bits dynamic) {
    return mayBeObject(hitColumn(kGroundBit, hits), dynamic, 4.0, kGroundBit, config);
  };
  EXPECT_TRUE(may_be_object({3, 3, 3, 3, 3, 2}, tall));
  EXPECT_FALSE(may_be_object({12, 3, 3, 3, 3, 2}, tall))
      << "the ground was hit four times as often";
  EXPECT_FALSE(may_be_object({3, 3, 12, 3, 3, 2}, tall)) << "noise of the poses lifts it";
  EXPECT_FALSE(may_be_object({3, 3, 3}, Bits{0x6} << kGroundBit)) << "only noise is so low";
  EXPECT_FALSE(may_be_object({13, 9, 9, 9, 9, 9}, tall)) << "it is well known";
}

TEST(GroundLayer, StrongEvidenceIsEnoughForTheLowestCellToBeOfAnObject) {
  ColumnEvidence evidence;
  evidence.observe(1, 0);
  for (int scan = 0; scan < 2; ++scan) evidence.observe(0, 1);
  EXPECT_TRUE(mayBeObject(evidence, 2, 4.0, 0, EvidenceConfig()));
}

}  // namespace
}  // namespace beautymap
