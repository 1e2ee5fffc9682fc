// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/published/published_judgement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "beautymap/cleaner/map_cleaner.h"
#include "beautymap/cleaner/online_map.h"
#include "cleaner/yard.h"
#include "test_scenes.h"

namespace beautymap {
namespace {

using Classes = std::vector<PointClass>;
using test::add;
using test::LabelledScan;
using test::look;
using test::person;
using test::shareOf;

Config publishedConfig() {
  return loadConfig(std::string(BEAUTYMAP_SOURCE_DIR) + "/config/paper_indoor.yaml");
}

TEST(PublishedOnline, WhatEntersACellThatOneScanSawFreeIsDynamicAtOnce) {
  OnlineMap map(publishedConfig());
  add(map, look({}).scan);
  const LabelledScan entered = look({person(3, 1)});
  EXPECT_GT(shareOf(entered, map.addHits(entered.scan), PointClass::kDynamic), 0.9);
}

TEST(PublishedOnline, TheTrailOfWhatLeftGoesAwayWithTheFirstScanWithoutIt) {
  OnlineMap map(publishedConfig());
  const LabelledScan visit = look({person(3, 1)});
  add(map, visit.scan);
  EXPECT_EQ(shareOf(visit, map.classify(visit.scan), PointClass::kDynamic), 0.0);
  add(map, look({}).scan);
  map.settle();
  EXPECT_GT(shareOf(visit, map.classify(visit.scan), PointClass::kDynamic), 0.9);
}

/// With the ground known from the first scan the map that grows is the finished one.
TEST(PublishedOnline, ScansOfAKnownGroundGiveTheMapOfAReplayAlsoWithoutModules) {
  std::vector<LabelledScan> scans;
  for (int i = 0; i < 3; ++i) scans.push_back(look({}));
  for (int i = 0; i < 10; ++i) scans.push_back(look({person(2 + 0.2 * i, -2 + 0.4 * i)}));
  scans.push_back(look({}));
  for (const char* off : {"", "fine_ground.enabled=false", "restoration.enabled=false"}) {
    Config config = publishedConfig();
    if (*off != 0) setParameter(config, off);
    OnlineMap map(config);
    MapCleaner cleaner(config);
    for (const LabelledScan& scan : scans) add(map, scan.scan);
    map.settle();
    cleanMap(cleaner, [&](const auto& f) {
      for (const LabelledScan& scan : scans) f(scan.scan);
    });
    int differing = 0, dynamic = 0, points = 0;
    for (const LabelledScan& scan : scans) {
      const Classes online = map.classify(scan.scan), offline = cleaner.classify(scan.scan);
      for (std::size_t i = 0; i < online.size(); ++i, ++points) {
        differing += online[i] != offline[i] ? 1 : 0;
        dynamic += offline[i] == PointClass::kDynamic ? 1 : 0;
      }
    }
    EXPECT_GT(dynamic, 500) << off;
    // A person's column knows its ground only when the person has left.
    EXPECT_LT(differing, points / 1000) << off;
  }
}

TEST(PublishedOnline, WhatIsRememberedMovesWithTheGroundAndTheGroundIsExact) {
  Config config = publishedConfig();
  const PublishedJudgement judgement(config);
  TileMap map = judgement.newMap();
  Tile& tile = map.tileAt({0, 0});
  tile.ground[0] = 1.0F;
  tile.occupied[0] = 0b1101;
  EXPECT_TRUE(judgement.anchor(tile, 0, 0.57F));
  EXPECT_EQ(tile.ground[0], 0.57F);
  EXPECT_EQ(tile.occupied[0], Bits{0b110100}) << "0.43 m are two bits of 0.2 m";
  EXPECT_FALSE(judgement.anchor(tile, 1, 0.3F)) << "nothing is known of that column";
  EXPECT_EQ(tile.ground[1], 0.3F);
}

TEST(PublishedJudgement, ATileRemembersNoMoreThanOneBitPerCell) {
  const TileMap map = PublishedJudgement(publishedConfig()).newMap();
  EXPECT_LE((*map.newTile().state).memoryBytes(), Tile::kColumns * sizeof(Bits) + 64);
}

}  // namespace
}  // namespace beautymap
