// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
// What beautymap_online_scores measures, on a short scene: a map cleaned in one pass is as good as
// the replay of the same scans.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "beautymap/cleaner/map_cleaner.h"
#include "beautymap/cleaner/online_map.h"
#include "beautymap/evaluation/evaluation.h"
#include "beautymap/io/cloud_fields.h"
#include "beautymap/io/scan_conversion.h"
#include "beautymap/simulation/simulated_source.h"

namespace beautymap {
namespace {

struct LabelledScan {
  Scan scan;
  std::vector<bool> moving;
};

std::vector<LabelledScan> simulate(const std::string& scene, const std::string& sensor) {
  simulation::SimulationOptions options;
  options.scene = scene;
  options.sensor = sensor;
  options.scans = 60;
  options.seed = 1;
  simulation::SimulatedSource source(options);
  std::vector<LabelledScan> scans;
  SourceScan read;
  while (source.next(read)) {
    scans.emplace_back();
    convertScan(read, scans.back().scan);
    const FieldReader label(read.cloud, "label");
    for (std::size_t i = 0; i < read.cloud.width; ++i) {
      scans.back().moving.push_back(source.isMoving(static_cast<std::uint32_t>(label(i))));
    }
  }
  return scans;
}

void count(const LabelledScan& scan, const std::vector<PointClass>& classes, Score& score) {
  for (std::size_t i = 0; i < classes.size(); ++i) {
    const bool kept = classes[i] == PointClass::kStatic;
    ++(scan.moving[i] ? score.dynamic_points : score.static_points);
    if (kept) ++(scan.moving[i] ? score.kept_dynamic : score.kept_static);
  }
}

/// @return  those of the replay
Score expectScoresOfAReplay(const std::string& scene, const std::string& sensor) {
  SCOPED_TRACE(scene + " " + sensor);
  const std::vector<LabelledScan> scans = simulate(scene, sensor);
  EXPECT_EQ(scans.size(), 60U);
  OnlineMap map{Config()};
  MapCleaner cleaner{Config()};
  for (const LabelledScan& scan : scans) {
    map.addHits(scan.scan);
    map.addSeenFree();
  }
  map.settle();
  cleanMap(cleaner, [&](const auto& f) {
    for (const LabelledScan& scan : scans) f(scan.scan);
  });
  Score online, replay;
  for (const LabelledScan& scan : scans) {
    count(scan, map.classify(scan.scan), online);
    count(scan, cleaner.classify(scan.scan), replay);
  }
  EXPECT_GT(replay.dynamic_points, 1000U);
  EXPECT_GT(replay.HA(), 90.0);
  EXPECT_GT(online.HA(), replay.HA() - 0.5);
  return replay;
}

TEST(OnlineScores, PeopleCloseToASensorThatSeesNoGroundBesideIt) {
  expectScoresOfAReplay("crowd", "vlp16");
}

TEST(OnlineScores, ACrowdAroundASensorThatLooksUp) { expectScoresOfAReplay("crowd", "mid360"); }

TEST(OnlineScores, TrafficStraightBelowTheSensor) {
  const Score score = expectScoresOfAReplay("slope", "cone");
  EXPECT_GT(score.SA(), 99.5);
  EXPECT_GT(score.DA(), 98.5);
}

TEST(OnlineScores, Traffic) { expectScoresOfAReplay("street", "vlp16"); }

}  // namespace
}  // namespace beautymap
