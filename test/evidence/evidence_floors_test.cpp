// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "beautymap/evidence/evidence_judgement.h"
#include "test_scenes.h"

namespace beautymap {
namespace {

using test::Random;

constexpr int kGround = 8;
constexpr std::size_t kColumn = 77;

/// A deck 4 m above the ground, 0.05 m above the bottom of its cell, and something that moved on
/// it.
struct Deck {
  static constexpr int kBit = kGround + 20;
  EvidenceJudgement judgement{Config()};
  TileMap map = judgement.newMap();
  Tile& tile = map.tileAt({0, 0});

  Deck() {
    tile.ground[kColumn] = -depthBelowGround(MatrixConfig());
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

TEST(EvidenceFloors, TheObjectsPointsInTheDecksCellGoWithTheObject) {
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

TEST(EvidenceFloors, SwitchedOffTheDecksCellStaysWhole) {
  Config config;
  config.ground_layer.floors = false;
  const EvidenceJudgement judgement(config);
  Deck deck;
  EXPECT_FALSE(judgement.segmentGround(deck.map, {{0, 0}}));
  judgement.countFloorPoints(deck.map, deck.scan({0.05, 0.05, 0.15}));
  EXPECT_TRUE(evidenceTile(std::as_const(deck.tile)).floors.empty());
  EXPECT_FALSE(judgement.isDynamic(deck.tile, kColumn, deck.height(0.15)));
}

TEST(EvidenceFloors, AnotherFloorOfTheColumnCountsAnew) {
  Deck deck;
  deck.segment();
  deck.judgement.countFloorPoints(deck.map, deck.scan({0.05, 0.05, 0.05}));
  EXPECT_EQ(evidenceTile(std::as_const(deck.tile)).floors[kColumn].counts[2], 3U);
  deck.tile.occupied[kColumn] |= Bits{3} << 15;
  deck.tile.dynamic[kColumn] |= Bits{1} << 16;
  EXPECT_TRUE(deck.segment());
  EXPECT_EQ(evidenceTile(std::as_const(deck.tile)).floors[kColumn].bit, 15);
  EXPECT_EQ(evidenceTile(std::as_const(deck.tile)).floors[kColumn].counts, FloorCell::Counts{});
}

TEST(EvidenceFloors, CountsOfRunsAreThoseOfPoints) {
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
    EXPECT_EQ(evidenceTile(std::as_const(deck.tile)).floors[kColumn].counts, expected)
        << "seed " << seed;
  }
}

}  // namespace
}  // namespace beautymap
