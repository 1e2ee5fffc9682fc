// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/ground/floor_layer.h"

#include <gtest/gtest.h>

#include <vector>

#include "beautymap/evidence/map_judgement.h"
#include "test_scenes.h"

namespace beautymap {
namespace {

using test::Random;

constexpr int kGround = 8;
constexpr std::size_t kColumn = 77;

FloorLayer defaultLayer() { return {GroundLayerConfig(), MatrixConfig()}; }

TEST(FloorLayer, ASurfaceStaysAndWhatIsAboveItDoesNot) {
  const FloorLayer layer = defaultLayer();
  EXPECT_EQ(layer.staticBins({0, 900, 400, 0, 3, 3, 4, 2}), 3);
  // An object as dense as the surface of a deck that was seen less often.
  EXPECT_EQ(layer.staticBins({0, 90, 4, 8, 8, 8, 8, 8}), 2);
  // Noise is part of the surface as far as the counts fall off, but not for ever.
  EXPECT_EQ(layer.staticBins({900, 800, 700, 500, 200, 90, 0, 1}), 6);
  EXPECT_EQ(layer.staticBins({9000, 1000, 1000, 1000, 1000, 1000, 1000, 900}), 7);
}

TEST(FloorLayer, WithoutASurfaceTheWholeCellStays) {
  const FloorLayer layer = defaultLayer();
  EXPECT_EQ(layer.staticBins({}), FloorCell::kBins) << "nothing counted yet";
  EXPECT_EQ(layer.staticBins({50, 3, 50, 50, 50, 50, 50, 50}), FloorCell::kBins) << "a wall";
  EXPECT_EQ(layer.staticBins({0, 0, 0, 0, 0, 0, 0, 50}), FloorCell::kBins) << "at the upper end";
}

TEST(FloorLayer, AFloorIsTheLowestStayingCellBelowADynamicOneAboveTheGround) {
  const auto bit = [](int at) { return Bits{1} << at; };
  const Bits occupied = bit(8) | bit(9) | bit(20) | bit(21) | bit(30) | bit(31);
  EXPECT_EQ(floorBit(occupied, bit(21) | bit(31), kGround), 20);
  EXPECT_EQ(floorBit(occupied, bit(20) | bit(21), kGround), -1);
  EXPECT_EQ(floorBit(occupied, bit(9), kGround), -1) << "the ground has a layer of its own";
  EXPECT_EQ(floorBit(occupied, 0, kGround), -1);
  EXPECT_EQ(floorBit(bit(63), 0, kGround), -1) << "nothing is above the highest bit";
  EXPECT_EQ(floorBit(bit(62) | bit(63), bit(63), kGround), 62);
}

TEST(FloorLayer, BinsDivideTheCellsOfTheEncoding) {
  for (const double res_h : {0.05, 0.2, 0.37}) {
    MatrixConfig matrix;
    matrix.res_h = res_h;
    matrix.n_bit = 40;
    const FloorLayer layer({}, matrix);
    const BinaryEncoding encoding(matrix);
    Random random(1);
    for (int i = 0; i < 20000; ++i) {
      const auto ground = static_cast<float>(random.uniform(-50.0, 50.0));
      const auto z = static_cast<float>(ground + random.uniform(-1.0, 60.0 * res_h));
      const int bin = layer.binOf(z, ground);
      const int bit = encoding.bitIndex(z, ground);
      if (bit == matrix.n_bit - 1) continue;  // it also holds all that is higher
      ASSERT_EQ(bin < 0 ? -1 : bin / FloorCell::kBins, bit) << z << " over " << ground;
    }
    EXPECT_EQ(layer.binOf(test::kNan, 0.0F), -1);
    EXPECT_EQ(layer.binOf(0.0F, Tile::kNoHeight), -1);
    EXPECT_EQ(layer.binOf(test::kInfinity, 0.0F), 40 * FloorCell::kBins);
  }
}

/// A deck 4 m above the ground, 0.05 m above the bottom of its cell, and something that moved on
/// it.
struct Deck {
  static constexpr int kBit = kGround + 20;
  MapJudgement judgement{Config()};
  TileMap map{judgement.fineBins()};
  Tile& tile = map.tileAt({0, 0});

  Deck() {
    tile.ground[kColumn] = -judgement.belowGround();
    tile.occupied[kColumn] = Bits{1} << kGround | Bits{7} << kBit;
    tile.dynamic[kColumn] = Bits{3} << (kBit + 1);
  }
  float height(double in_cell) const {
    return tile.ground[kColumn] + static_cast<float>(kBit * 0.2 + in_cell);
  }
  PlacedScan scan(const std::vector<double>& heights_in_cell) const {
    std::vector<Eigen::Vector3d> points;
    const double res_g = MatrixConfig().res_g;
    const double x = (kColumn / Tile::kSide + 0.5) * res_g,
                 y = (kColumn % Tile::kSide + 0.5) * res_g;
    for (const double in_cell : heights_in_cell) points.push_back({x, y, height(in_cell)});
    return test::placedScan({0, 0}, {0, 0, 0}, points, res_g);
  }
  bool segment() { return judgement.segmentGround(map, {{0, 0}}); }
  bool isDynamic(double in_cell) const {
    return judgement.isDynamic(tile, kColumn, height(in_cell));
  }
};

TEST(FloorLayer, TheObjectsPointsInTheDecksCellGoWithTheObject) {
  Deck deck;
  EXPECT_TRUE(deck.segment()) << "a floor was found";
  EXPECT_FALSE(deck.isDynamic(0.15)) << "before anything was counted all of the cell stays";
  for (int i = 0; i < 40; ++i) {
    deck.judgement.countFloorPoints(deck.map, deck.scan({0.045, 0.05, 0.055, -0.1, 0.25}));
  }
  deck.judgement.countFloorPoints(deck.map, deck.scan({0.12, 0.15, 0.19, 0.25, 0.45}));
  EXPECT_TRUE(deck.segment());
  EXPECT_FALSE(deck.segment()) << "nothing is divided otherwise";
  EXPECT_FALSE(deck.isDynamic(-0.1)) << "below the deck";
  EXPECT_FALSE(deck.isDynamic(0.05));
  EXPECT_TRUE(deck.isDynamic(0.12));
  EXPECT_TRUE(deck.isDynamic(0.19));
  EXPECT_TRUE(deck.isDynamic(0.25));
  std::vector<PointClass> classes;
  deck.judgement.classify(deck.map, deck.scan({-0.1, 0.05, 0.12, 0.19, 0.3}), classes);
  const PointClass kept = PointClass::kStatic, removed = PointClass::kDynamic;
  EXPECT_EQ(classes, (std::vector<PointClass>{kept, kept, removed, removed, removed}));

  // When the object turns out to be none, the deck stays as it was.
  deck.tile.dynamic[kColumn] = 0;
  EXPECT_FALSE(deck.isDynamic(0.19));
}

TEST(FloorLayer, SwitchedOffTheDecksCellStaysWhole) {
  Config config;
  config.ground_layer.floors = false;
  const MapJudgement judgement(config);
  Deck deck;
  EXPECT_FALSE(judgement.segmentGround(deck.map, {{0, 0}}));
  judgement.countFloorPoints(deck.map, deck.scan({0.05, 0.05, 0.15}));
  EXPECT_TRUE(deck.tile.floors.empty());
  EXPECT_FALSE(judgement.isDynamic(deck.tile, kColumn, deck.height(0.15)));
}

TEST(FloorLayer, AnotherFloorOfTheColumnCountsAnew) {
  Deck deck;
  deck.segment();
  deck.judgement.countFloorPoints(deck.map, deck.scan({0.05, 0.05, 0.05}));
  EXPECT_EQ(deck.tile.floors[kColumn].counts[2], 3U);
  deck.tile.occupied[kColumn] |= Bits{3} << 15;
  deck.tile.dynamic[kColumn] |= Bits{1} << 16;
  EXPECT_TRUE(deck.segment());
  EXPECT_EQ(deck.tile.floors[kColumn].bit, 15);
  EXPECT_EQ(deck.tile.floors[kColumn].counts, FloorCell::Counts{});
}

TEST(FloorLayer, CountsOfRunsAreThoseOfPoints) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    Random random(seed);
    Deck deck;
    deck.segment();
    // In the middle of bins, as float decides on their borders.
    std::vector<double> heights;
    FloorCell::Counts expected{};
    for (int i = random.integer(0, 60); i > 0; --i) {
      const int bin = random.integer(-20, 28);
      heights.push_back((bin + 0.5) * 0.2 / FloorCell::kBins);
      if (bin >= 0 && bin < FloorCell::kBins) ++expected[static_cast<std::size_t>(bin)];
    }
    deck.judgement.countFloorPoints(deck.map, deck.scan(heights));
    EXPECT_EQ(deck.tile.floors[kColumn].counts, expected) << "seed " << seed;
  }
}

}  // namespace
}  // namespace beautymap
