// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/evidence/evidence_judgement.h"

#include <gtest/gtest.h>

#include <vector>

#include "beautymap/evidence/agreement.h"
#include "test_scenes.h"

namespace beautymap {
namespace {

/// Random cells with random evidence in some columns, mostly of one height so that they support
/// each other.
void changeTile(Tile& tile, test::Random& random) {
  for (std::size_t column = 0; column < Tile::kColumns; ++column) {
    if (random.chance(0.3)) continue;
    const Bits cells = Bits{0x1f} << random.integer(8, 10);
    tile.occupied[column] |= cells;
    for (int i = random.integer(0, 3); i > 0; --i)
      evidenceTile(tile).evidence.touch(column).observe(cells, 0);
    const Bits free = random.chance(0.5) ? cells : random.bits();
    for (int i = random.integer(0, 6); i > 0; --i)
      evidenceTile(tile).evidence.touch(column).observe(0, free);
  }
  for (std::uint32_t& count : tile.fine_counts) count += random.chance(0.5) ? 1 : 0;
}

void judge(const EvidenceJudgement& judgement, TileMap& map, const std::vector<ColumnIndex>& tiles,
           const Config& config) {
  const std::vector<ColumnIndex> affected =
      withNeighbours(map, tiles, agreementMargin(config.agreement));
  judgement.judgeEvidence(map, tiles);
  judgement.judgeAgreement(map, affected);
  judgement.segmentGround(map, affected);
}

TEST(EvidenceJudgement, JudgingWhatChangedEqualsJudgingEverything) {
  for (std::uint32_t seed = 0; seed < 8; ++seed) {
    test::Random random(seed);
    Config config;
    config.agreement.enabled = seed != 0;
    config.ground_layer.enabled = seed != 1;
    const EvidenceJudgement judgement(config);
    TileMap map = judgement.newMap();
    for (int x = -2; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) changeTile(map.tileAt({x, y}), random);
    }
    judge(judgement, map, tilesOf(map), config);
    for (int step = 0; step < 3; ++step) {
      const ColumnIndex changed{random.integer(-2, 1), random.integer(-1, 1)};
      changeTile(map.tileAt(changed), random);
      judge(judgement, map, {changed}, config);
      const ColumnWindow window{{-64, -32}, 128};
      const BitGrid dynamic = map.extract(window, &Tile::dynamic, Bits{0});
      const auto ground = map.extract(window, &Tile::static_bins, std::uint16_t{0});
      judge(judgement, map, tilesOf(map), config);
      int dynamic_columns = 0;
      forEachColumn(map, window, [&](int x, int y, const Tile& tile, std::size_t column) {
        ASSERT_EQ(dynamic.at(x, y), tile.dynamic[column]) << "seed " << seed;
        ASSERT_EQ(ground.at(x, y), tile.static_bins[column]) << "seed " << seed;
        dynamic_columns += tile.dynamic[column] != 0 ? 1 : 0;
      });
      EXPECT_GT(dynamic_columns, 0);
    }
  }
}

/// Runs near the ground of several columns; one column is known to be flat.
TEST(EvidenceJudgement, CountsTheGroundPointsOfRunsAsPointByPoint) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    test::Random random(seed);
    Config config;
    config.ground_layer.enabled = random.chance(0.5);
    const EvidenceJudgement judgement(config);
    std::vector<Eigen::Vector3d> points;
    for (int run = 0; run < 200; ++run) {
      const double x = random.uniform(0.0, 8.0), z = random.uniform(-0.5, 1.5);
      const double extent = random.pick<double>({0.0, 0.02, 1.0});
      for (int i = random.integer(1, 5); i > 0; --i) {
        points.emplace_back(x, 0.25, z + random.uniform(0.0, extent));
      }
    }
    const PlacedScan scan = test::placedScan({0, 0}, {0.0, 0.0, 0.0}, points);
    std::vector<Eigen::Vector3d> alone;  // the same points, no two of a column in a row
    for (const Eigen::Vector3d& point : points) {
      alone.push_back(point);
      alone.emplace_back(9.25, 9.25, 9.0);
    }
    const PlacedScan single = test::placedScan({0, 0}, {0.0, 0.0, 0.0}, alone);
    TileMap of_runs = judgement.newMap(), of_points = judgement.newMap();
    for (TileMap* map : {&of_runs, &of_points}) {
      map->tileAt({0, 0}).ground.fill(-depthBelowGround(config.matrix));
      evidenceTile(map->tileAt({0, 0})).flat.set(3 << Tile::kShift);
    }
    judgement.countGroundPoints(of_runs, scan);
    judgement.countGroundPoints(of_points, single);
    EXPECT_EQ(of_runs.tileAt({0, 0}).fine_counts, of_points.tileAt({0, 0}).fine_counts);
  }
}

}  // namespace
}  // namespace beautymap
