// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/cleaner/online_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <stdexcept>
#include <utility>

#include "beautymap/cleaner/map_cleaner.h"
#include "beautymap/evidence/evidence_judgement.h"
#include "cleaner/yard.h"
#include "test_scenes.h"

namespace beautymap {
namespace {

using Classes = std::vector<PointClass>;
using test::add;
using test::Box;
using test::BoxWorld;
using test::kVisitor;
using test::LabelledScan;
using test::look;
using test::person;
using test::shareOf;
using test::yard;

/// What the map says now about the points of a scan.
Classes classesOf(OnlineMap& map, const Scan& scan) {
  map.settle();
  return map.classify(scan);
}

double staticShare(const Classes& classes) {
  return static_cast<double>(std::count(classes.begin(), classes.end(), PointClass::kStatic)) /
         static_cast<double>(classes.size());
}

TEST(OnlineMap, WhatStandsStillStaysFromTheFirstScanOn) {
  OnlineMap map{Config()};
  const LabelledScan scan = look({person(5, 1)});
  for (int i = 0; i < 8; ++i) {
    EXPECT_EQ(staticShare(map.addHits(scan.scan)), 1.0) << "scan " << i;
    map.addSeenFree();
  }
}

TEST(OnlineMap, WhatEntersSpaceThatWasSeenFreeIsDynamicAtOnce) {
  OnlineMap map{Config()};
  for (int i = 0; i < 6; ++i) add(map, look({}).scan);
  const LabelledScan entered = look({person(5, 1)});
  EXPECT_GT(shareOf(entered, map.addHits(entered.scan), PointClass::kDynamic), 0.95);
}

TEST(OnlineMap, TheTrailOfWhatLeftGoesAway) {
  OnlineMap map{Config()};
  std::vector<LabelledScan> walk;
  for (int i = 0; i < 12; ++i) {
    walk.push_back(look({person(5, -3 + 0.5 * i)}));
    add(map, walk.back().scan);
  }
  for (int i = 0; i < 6; ++i) add(map, look({}).scan);
  for (const LabelledScan& scan : walk) {
    EXPECT_GT(shareOf(scan, classesOf(map, scan.scan), PointClass::kDynamic), 0.95);
  }
  EXPECT_GT(staticShare(classesOf(map, look({}).scan)), 0.99);
}

TEST(OnlineMap, WhatStandsForLongInSpaceThatWasFreeBecomesStaticAgain) {
  OnlineMap map{Config()};
  for (int i = 0; i < 6; ++i) add(map, look({}).scan);
  const LabelledScan parked = look({person(5, 1)});
  for (int i = 0; i < 200; ++i) add(map, parked.scan);
  EXPECT_GT(shareOf(parked, classesOf(map, parked.scan), PointClass::kStatic), 0.95);
}

TEST(OnlineMap, ScansOfAKnownGroundGiveTheMapOfAReplay) {
  // With the ground known from the first scan no column is anchored again, and with all heights
  // remembered the evidence is the same.
  Config config;
  std::vector<LabelledScan> scans;
  for (int i = 0; i < 8; ++i) scans.push_back(look({}));
  for (int i = 0; i < 10; ++i) scans.push_back(look({person(4, -3 + 0.4 * i)}));
  for (int i = 0; i < 3; ++i) scans.push_back(look({}));
  OnlineMap map(config);
  MapCleaner cleaner(config);
  for (const LabelledScan& scan : scans) {
    add(map, scan.scan);
  }
  cleanMap(cleaner, [&](const auto& f) {
    for (const LabelledScan& scan : scans) f(scan.scan);
  });
  int differing = 0, dynamic = 0;
  for (const LabelledScan& scan : scans) {
    const Classes online = classesOf(map, scan.scan);
    const Classes offline = cleaner.classify(scan.scan);
    for (std::size_t i = 0; i < online.size(); ++i) {
      differing += online[i] != offline[i] ? 1 : 0;
      dynamic += offline[i] == PointClass::kDynamic ? 1 : 0;
    }
  }
  EXPECT_GT(dynamic, 1000);
  EXPECT_EQ(differing, 0);
}

/// From a sensor that sees the floor only from 8.5 m on.
LabelledScan lookAhead(const BoxWorld& world) {
  return test::castScan(world, Eigen::Vector3d(0.1, 0.2, 1.5), 64, -10.0, 30.0, 720);
}

TEST(OnlineMap, WhatEntersBelowACeilingIsDynamicAtOnce) {
  // The ceiling alone is seen there: its height is no ground, as the space below is free.
  const Box ceiling{{3, -2, 3}, {7, 3, 3.2}};
  OnlineMap map{Config()};
  BoxWorld world = yard({person(20, 20), ceiling});
  for (int i = 0; i < 15; ++i) add(map, lookAhead(world).scan);
  world.boxes[kVisitor] = person(5, 1);
  const LabelledScan entered = lookAhead(world);
  EXPECT_GT(shareOf(entered, map.addHits(entered.scan), PointClass::kDynamic), 0.95);
}

TEST(OnlineMap, CellsAreJudgedByTheirEvidenceAlsoWhenTheGroundFell) {
  // A visitor's upper part is all that is seen of its columns, until the floor is.
  OnlineMap map{Config()};
  for (int i = 0; i < 6; ++i) add(map, lookAhead(yard({person(2, 1)})).scan);
  for (int i = 0; i < 6; ++i) add(map, look({}).scan);
  const EvidenceJudgement judgement{Config()};
  int judged = 0;
  std::as_const(map).map().forEachTile([&](ColumnIndex, const Tile& tile) {
    Tile again = tile;
    for (std::size_t column = 0; column < Tile::kColumns; ++column) {
      judgement.judgeEvidence(again, column, ~Bits{0});
      judged += evidenceTile(again).suspected[column] != 0 ? 1 : 0;
    }
    EXPECT_EQ(evidenceTile(again).suspected, evidenceTile(tile).suspected);
    EXPECT_EQ(evidenceTile(again).strong, evidenceTile(tile).strong);
    EXPECT_EQ(evidenceTile(again).leaning, evidenceTile(tile).leaning);
    EXPECT_EQ(evidenceTile(again).unknown, evidenceTile(tile).unknown);
  });
  EXPECT_GT(judged, 0);
  const LabelledScan visit = lookAhead(yard({person(2, 1)}));
  EXPECT_GT(shareOf(visit, classesOf(map, visit.scan), PointClass::kDynamic), 0.95);
}

TEST(OnlineMap, AMapAtUtmCoordinatesIsAsExactAsOneAtTheOrigin) {
  // Multiples of a tile, so that both maps have the same columns.
  const Eigen::Vector3d utm(16.0 * 30000, 16.0 * 300000, 512.0);
  OnlineMap near{Config()}, far{Config()};
  for (int i = 0; i < 8; ++i) {
    const auto visitor = std::vector<Box>(i < 6 ? 0 : 1, person(5, 1));
    const Classes at_origin = near.addHits(look(visitor).scan);
    EXPECT_EQ(at_origin, far.addHits(look(visitor, utm).scan)) << "scan " << i;
    near.addSeenFree();
    far.addSeenFree();
  }
}

TEST(OnlineMap, UnusablePointsAreDroppedAndCounted) {
  OnlineMap map{Config()};
  Scan scan = test::registeredScan({{3, 0, 0}, {0, 0, 0}, {1e5, 0, 0}}, {0, 0, 1.5});
  scan.cloud.push_back(pcl::PointXYZ(test::kNan, 0.0F, 0.0F));
  const Classes expected{PointClass::kStatic, PointClass::kDropped, PointClass::kDropped,
                         PointClass::kDropped};
  EXPECT_EQ(map.addHits(scan), expected);
  EXPECT_EQ(map.dropped().total(), 3U);
  map.addSeenFree();
  EXPECT_TRUE(map.addHits(test::registeredScan({}, {0, 0, 1.5})).empty());
  map.addSeenFree();
}

TEST(OnlineMap, APoseThatIsNotFiniteLeavesTheMapUnchanged) {
  OnlineMap map{Config()};
  Scan scan = look({}).scan;
  scan.sensor_in_map.x() = test::kNan;
  EXPECT_THROW(map.addHits(scan), std::invalid_argument);
  EXPECT_EQ(map.map().tileCount(), 0U);
  EXPECT_EQ(map.zOrigin(), 0.0);
}

TEST(OnlineMap, ConfigurationsThatNeedTheFinishedMapAreRefused) {
  Config config;
  config.coarse_ground.enabled = false;
  EXPECT_THROW(OnlineMap{config}, ConfigError);
}

TEST(OnlineMap, RevisionsChangeOnlyWhereThePointsMayBeJudgedOtherwise) {
  OnlineMap map{Config()};
  for (int i = 0; i < 10; ++i) add(map, look({}).scan);
  map.settle();
  std::vector<std::uint64_t> before;
  map.map().forEachTile([&](ColumnIndex, const Tile& tile) { before.push_back(tile.revision); });
  add(map, look({}).scan);
  map.settle();
  std::size_t i = 0;
  map.map().forEachTile(
      [&](ColumnIndex, const Tile& tile) { EXPECT_EQ(tile.revision, before[i++]); });
  add(map, look({person(5, 1)}).scan);
  int changed = 0;
  i = 0;
  map.map().forEachTile(
      [&](ColumnIndex, const Tile& tile) { changed += tile.revision != before[i++] ? 1 : 0; });
  EXPECT_GT(changed, 0);
}

}  // namespace
}  // namespace beautymap
