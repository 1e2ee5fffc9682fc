// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/cleaner/map_cleaner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "beautymap/evidence/evidence_tile.h"
#include "cleaner/reference_cleaner.h"
#include "test_scenes.h"

namespace beautymap {
namespace {

using test::Random;

using Classes = std::vector<std::vector<PointClass>>;

/// The phases over all scans.
MapCleaner clean(const std::vector<Scan>& scans, const Config& config) {
  MapCleaner cleaner(config);
  cleanMap(cleaner, [&](const auto& f) {
    for (const Scan& scan : scans) f(scan);
  });
  return cleaner;
}

Classes classify(MapCleaner& cleaner, const std::vector<Scan>& scans) {
  Classes classes;
  for (const Scan& scan : scans) classes.push_back(cleaner.classify(scan));
  return classes;
}

Classes cleanedClasses(const std::vector<Scan>& scans, const Config& config) {
  MapCleaner cleaner = clean(scans, config);
  return classify(cleaner, scans);
}

int countOf(const Classes& classes, PointClass wanted) {
  int count = 0;
  for (const auto& scan : classes) {
    count += static_cast<int>(std::count(scan.begin(), scan.end(), wanted));
  }
  return count;
}

/// The published settings for 64 beams, in a region that covers the small worlds of the tests.
Config paperConfig() {
  Config config;
  config.judgement.method = "published";
  config.levelling.enabled = false;
  config.matrix.bits_below = 0;
  config.matrix.res_g = 1.0;
  config.matrix.res_h = 0.5;
  config.matrix.n_bit = 32;
  config.matrix.roi_size = 40.0;
  config.coarse_ground.wide_radius = 0;
  config.fine_ground.bin_height = 0.125;
  return config;
}

/// Cell sizes are powers of two, so that cell borders are exact in float; everything else is
/// anything.
Config randomConfig(std::uint32_t seed) {
  Random random(seed + 77777);
  Config config;
  config.judgement.method = "published";
  config.levelling.enabled = false;
  config.matrix.bits_below = 0;
  config.scan.min_range = random.pick<double>({0.0, 1.0});
  config.matrix.res_g = random.pick<double>({0.5, 1.0, 2.0});
  config.matrix.res_h = random.pick<double>({0.25, 0.5});
  config.matrix.n_bit = random.chance(0.5) ? random.integer(2, 10) : random.integer(2, kMaxBits);
  config.matrix.roi_size = random.uniform(3.0, 30.0);
  config.coarse_ground.enabled = random.chance(0.85);
  config.coarse_ground.radius = random.integer(1, 3);
  config.coarse_ground.min_share = random.pick<double>({0.0, 0.25, 0.625});
  config.coarse_ground.mad_factor = random.pick<double>({1.0, 3.0});
  config.coarse_ground.wide_radius = 0;
  config.restoration.enabled = random.chance(0.8);
  config.restoration.blind_radius = random.uniform(0.0, 2.0);
  config.restoration.sight_range = random.uniform(2.0, 15.0);
  config.restoration.steepest_share = random.pick<double>({0.5, 0.95, 0.999, 1.0});
  config.fine_ground.enabled = random.chance(0.8);
  config.fine_ground.bin_height = random.pick<double>({0.0625, 0.125});
  config.fine_ground.ground_ratio = random.uniform(0.2, 0.95);
  return config;
}

std::vector<Scan> translated(std::vector<Scan> scans, const Eigen::Vector3d& shift) {
  for (Scan& scan : scans) {
    scan.T_map_cloud.pretranslate(shift);
    scan.sensor_in_map += shift;
  }
  return scans;
}

TEST(MapCleaner, AgreesPointByPointWithTheMethodWrittenOutInFull) {
  int compared = 0, undecided = 0, dynamic = 0;
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    const std::vector<Scan> scans = test::randomDrive(seed);
    const Config config = randomConfig(seed);
    const test::ReferenceCleaner reference(config, scans);
    const Classes classes = cleanedClasses(scans, config);
    for (std::size_t s = 0; s < scans.size(); ++s) {
      ASSERT_EQ(classes[s].size(), scans[s].cloud.size());
      for (std::size_t i = 0; i < classes[s].size(); ++i) {
        const std::optional<PointClass> expected = reference.classOf(s, i);
        ++(expected ? compared : undecided);
        if (!expected) continue;
        dynamic += *expected == PointClass::kDynamic ? 1 : 0;
        ASSERT_EQ(static_cast<int>(classes[s][i]), static_cast<int>(*expected))
            << "seed " << seed << " scan " << s << " point " << i;
      }
    }
  }
  EXPECT_GT(dynamic, compared / 20) << "the scenes must hold something to remove";
  EXPECT_LT(undecided, compared / 50);
}

/// Properties that hold for every input, over random worlds and parameters.
class MapCleanerProperties : public ::testing::TestWithParam<std::uint32_t> {
 protected:
  MapCleanerProperties()
      : scans_(test::randomDrive(GetParam())), config_(randomConfig(GetParam())) {}

  const std::vector<Scan> scans_;
  Config config_;
};

TEST_P(MapCleanerProperties, EveryPointIsInExactlyOneClass) {
  MapCleaner cleaner = clean(scans_, config_);
  const Classes classes = classify(cleaner, scans_);
  std::size_t points = 0;
  for (std::size_t s = 0; s < scans_.size(); ++s) {
    EXPECT_EQ(classes[s].size(), scans_[s].cloud.size());
    points += scans_[s].cloud.size();
  }
  const auto dropped = static_cast<std::size_t>(countOf(classes, PointClass::kDropped));
  EXPECT_EQ(dropped, cleaner.dropped().total());
  EXPECT_GE(dropped, 3 * scans_.size()) << "a NaN, a zero and a far point in each scan";
  EXPECT_EQ(dropped + static_cast<std::size_t>(countOf(classes, PointClass::kStatic) +
                                               countOf(classes, PointClass::kDynamic)),
            points);
}

TEST_P(MapCleanerProperties, ARemovedCellWasOccupied) {
  const MapCleaner cleaner = clean(scans_, config_);
  cleaner.map().forEachTile([](ColumnIndex, const Tile& tile) {
    for (std::size_t i = 0; i < Tile::kColumns; ++i)
      EXPECT_EQ(tile.dynamic[i] & ~tile.occupied[i], 0U);
  });
}

TEST_P(MapCleanerProperties, RestorationNeverAddsCandidates) {
  config_.restoration.enabled = true;
  const MapCleaner restored = clean(scans_, config_);
  config_.restoration.enabled = false;
  const MapCleaner all = clean(scans_, config_);
  restored.map().forEachTile([&](ColumnIndex index, const Tile& tile) {
    const Tile* same = all.map().findTile(index);
    ASSERT_NE(same, nullptr);
    for (std::size_t i = 0; i < Tile::kColumns; ++i)
      EXPECT_EQ(tile.dynamic[i] & ~same->dynamic[i], 0U);
  });
}

TEST_P(MapCleanerProperties, TheOrderOfTheScansDoesNotMatter) {
  const Classes classes = cleanedClasses(scans_, config_);
  std::vector<Scan> reversed(scans_.rbegin(), scans_.rend());
  Classes reversed_classes = cleanedClasses(reversed, config_);
  std::reverse(reversed_classes.begin(), reversed_classes.end());
  EXPECT_EQ(classes, reversed_classes);
}

TEST_P(MapCleanerProperties, TheOrderOfTheScansMayDifferBetweenPhases) {
  MapCleaner cleaner(config_);
  for (const Scan& scan : scans_) cleaner.observe(scan);
  cleaner.estimateGround();
  for (std::size_t p = 0; p < cleaner.passes().size(); ++p) {
    const JudgementPass& pass = cleaner.passes()[p];
    for (std::size_t i = 0; i < scans_.size(); ++i) {
      cleaner.add(pass, scans_[(i + 2 * (p + 1)) % scans_.size()]);
    }
    cleaner.conclude(pass);
  }
  EXPECT_EQ(classify(cleaner, scans_), cleanedClasses(scans_, config_));
}

TEST_P(MapCleanerProperties, TranslatingTheWorldByWholeCellsChangesNothing) {
  const Classes classes = cleanedClasses(scans_, config_);
  // Whole columns of 0.5, 1 and 2 m, also to where maps in UTM coordinates lie; any height.
  for (const Eigen::Vector3d& shift : std::vector<Eigen::Vector3d>{
           {2, 0, 0}, {-34, 18, 0}, {500000, 5800000, 431.25}, {-500000, -5800000, -77.5}}) {
    EXPECT_EQ(cleanedClasses(translated(scans_, shift), config_), classes) << shift.transpose();
  }
}

TEST_P(MapCleanerProperties, PointsBelowTheGroundAreKept) {
  MapCleaner cleaner = clean(scans_, config_);
  const Classes classes = classify(cleaner, scans_);
  for (std::size_t s = 0; s < scans_.size(); ++s) {
    for (std::size_t i = 0; i < classes[s].size(); ++i) {
      if (classes[s][i] == PointClass::kDropped) continue;
      const Eigen::Vector3d p =
          scans_[s].T_map_cloud * scans_[s].cloud[i].getVector3fMap().cast<double>();
      const ColumnIndex column = columnOf(p, config_.matrix.res_g);
      const Tile* tile = cleaner.map().findTile(TileMap::tileOf(column));
      ASSERT_NE(tile, nullptr);
      const float ground = tile->ground[static_cast<std::size_t>(TileMap::indexInTile(column))];
      if (p.z() - cleaner.zOrigin() >= ground) continue;
      EXPECT_EQ(classes[s][i], PointClass::kStatic);
    }
  }
}

TEST_P(MapCleanerProperties, NothingIsRemovedWithinTheBlindRadiusOfAllSensors) {
  config_.restoration.enabled = true;
  config_.restoration.blind_radius = 4.0;
  const MapCleaner cleaner = clean(scans_, config_);
  cleaner.map().forEachTile([&](ColumnIndex index, const Tile& tile) {
    for (std::size_t i = 0; i < Tile::kColumns; ++i) {
      if (tile.dynamic[i] == 0) continue;
      const Eigen::Vector2d centre =
          config_.matrix.res_g *
          Eigen::Vector2d(index.x * Tile::kSide + static_cast<int>(i) / Tile::kSide + 0.5,
                          index.y * Tile::kSide + static_cast<int>(i) % Tile::kSide + 0.5);
      double farthest = 0.0;
      for (const Scan& s : scans_) {
        farthest = std::max(farthest, (s.sensor_in_map.head<2>() - centre).norm());
      }
      EXPECT_GT(farthest, 4.0 - 1e-4) << "distances of some metres are computed in float";
    }
  });
}

TEST_P(MapCleanerProperties, TheSameScansTwiceGiveTheSameMap) {
  config_.restoration.steepest_share = 1.0;
  std::vector<Scan> twice = scans_;
  twice.insert(twice.end(), scans_.begin(), scans_.end());
  Classes classes = cleanedClasses(twice, config_);
  classes.resize(scans_.size());
  EXPECT_EQ(classes, cleanedClasses(scans_, config_));
}

INSTANTIATE_TEST_SUITE_P(Seeds, MapCleanerProperties, ::testing::Range<std::uint32_t>(0, 12));

/// A square with a wall and a parked car, a walker on a line between them and the sensor, and the
/// sensor at rest.
constexpr int kWall = 0, kCar = 1, kWalker = 2;

std::vector<test::LabelledScan> squareWithAWalker(int scans) {
  std::vector<test::LabelledScan> drive;
  for (int s = 0; s < scans; ++s) {
    test::BoxWorld world;
    world.boxes.push_back({{12.25, -12.0, 0.0}, {12.75, 12.0, 4.0}});
    world.boxes.push_back({{-9.0, 4.0, 0.0}, {-5.0, 6.0, 1.5}});
    const double y = -6.0 + 12.0 * s / (scans - 1);
    world.boxes.push_back({{6.3, y - 0.3, 0.0}, {6.7, y + 0.3, 1.75}});
    drive.push_back(test::castScan(world, {0.3, 0.4, 1.75}, 64, -25.0, 10.0, 720));
  }
  return drive;
}

struct Removed {
  int points = 0;
  int removed = 0;
};

/// Points on one box, at least `min_height` above the ground.
Removed removedOf(const std::vector<test::LabelledScan>& drive, const Classes& classes, int box,
                  double min_height) {
  Removed count;
  for (std::size_t s = 0; s < drive.size(); ++s) {
    for (std::size_t i = 0; i < classes[s].size(); ++i) {
      if (drive[s].box[i] != box || drive[s].scan.cloud[i].z < min_height) continue;
      ++count.points;
      count.removed += classes[s][i] == PointClass::kDynamic ? 1 : 0;
    }
  }
  return count;
}

std::vector<Scan> scansOf(const std::vector<test::LabelledScan>& drive) {
  std::vector<Scan> scans;
  for (const test::LabelledScan& scan : drive) scans.push_back(scan.scan);
  return scans;
}

TEST(MapCleanerScene, AWalkersTrailIsRemovedAboveTheGroundCell) {
  const auto drive = squareWithAWalker(13);
  const Removed walker =
      removedOf(drive, cleanedClasses(scansOf(drive), paperConfig()), kWalker, 0.51);
  ASSERT_GT(walker.points, 1000);
  EXPECT_EQ(walker.removed, walker.points);
}

TEST(MapCleanerScene, TheDefaultRemovesAWalkerDownToTheGroundAndKeepsTheRest) {
  const auto drive = squareWithAWalker(13);
  const Classes classes = cleanedClasses(scansOf(drive), Config());
  const Removed walker = removedOf(drive, classes, kWalker, 0.2);
  ASSERT_GT(walker.points, 1000);
  // He is in view all the time, but where he turns round his last steps are seen free only a few
  // times.
  EXPECT_GT(walker.removed, 0.9 * walker.points);
  for (const int box : {kWall, kCar}) {
    const Removed still = removedOf(drive, classes, box, 0.0);
    ASSERT_GT(still.points, 1000);
    EXPECT_EQ(still.removed, 0) << (box == kWall ? "wall" : "car");
  }
}

TEST(MapCleanerScene, OneScanAloneRemovesNothingByDefault) {
  auto drive = squareWithAWalker(13);
  // All scans but one see the walker where he stands in the first.
  std::vector<Scan> scans(6, drive.front().scan);
  scans.insert(scans.begin() + 3, drive.back().scan);
  const Classes classes = cleanedClasses(scans, Config());
  for (const PointClass c : classes.front()) EXPECT_NE(c, PointClass::kDynamic);
}

TEST(MapCleanerScene, AParkedCarAndAWallStay) {
  const auto drive = squareWithAWalker(13);
  const Classes classes = cleanedClasses(scansOf(drive), paperConfig());
  for (const int box : {kWall, kCar}) {
    const Removed still = removedOf(drive, classes, box, 0.0);
    ASSERT_GT(still.points, 1000);
    EXPECT_EQ(still.removed, 0) << (box == kWall ? "wall" : "car");
  }
}

TEST(MapCleanerScene, WithoutRestorationWhatTheWalkerHidIsLost) {
  const auto drive = squareWithAWalker(13);
  Config config = paperConfig();
  config.restoration.enabled = false;
  EXPECT_GT(removedOf(drive, cleanedClasses(scansOf(drive), config), kWall, 0.51).removed, 0);
}

TEST(MapCleanerScene, KeepsCellsBehindAWall) {
  // A box that the second scan cannot see: the wall stands between.
  test::BoxWorld world;
  world.boxes.push_back({{7.25, -15.0, 0.0}, {7.75, 15.0, 4.0}});
  world.boxes.push_back({{11.0, -1.0, 0.0}, {13.0, 1.0, 1.75}});
  const std::vector<test::LabelledScan> drive{
      test::castScan(world, {17.3, 0.4, 1.75}, 64, -25.0, 10.0, 720),
      test::castScan(world, {2.3, 0.4, 1.75}, 64, -25.0, 10.0, 720)};
  const Removed hidden = removedOf(drive, cleanedClasses(scansOf(drive), paperConfig()), 1, 0.0);
  ASSERT_GT(hidden.points, 500);
  EXPECT_EQ(hidden.removed, 0);
}

TEST(MapCleanerScene, WithoutTheWallTheSameBoxIsRemoved) {
  // Something behind the sensor returns the beams above the horizon: without it the sight mask ends
  // below them.
  test::BoxWorld without_box;
  without_box.boxes.push_back({{-30.0, -20.0, 0.0}, {-25.0, 20.0, 12.0}});
  test::BoxWorld with_box = without_box;
  with_box.boxes.push_back({{11.0, -1.0, 0.0}, {13.0, 1.0, 1.75}});
  const std::vector<test::LabelledScan> drive{
      test::castScan(with_box, {17.3, 0.4, 1.75}, 64, -25.0, 10.0, 720),
      test::castScan(without_box, {2.3, 0.4, 1.75}, 64, -25.0, 10.0, 720)};
  const Removed box = removedOf(drive, cleanedClasses(scansOf(drive), paperConfig()), 1, 0.51);
  ASSERT_GT(box.points, 500);
  EXPECT_EQ(box.removed, box.points);
}

/// What a map cleaner knows of a map.
struct State {
  std::size_t tiles;
  std::uint64_t dropped;
  Classes classes;
  bool operator==(const State& other) const {
    return tiles == other.tiles && dropped == other.dropped && classes == other.classes;
  }
};

State stateOf(MapCleaner& cleaner, const std::vector<Scan>& scans) {
  return {cleaner.map().tileCount(), cleaner.dropped().total(), classify(cleaner, scans)};
}

TEST(MapCleanerInput, APoseThatIsNotFiniteIsRefusedAndTheMapUnchanged) {
  const std::vector<Scan> scans = test::randomDrive(3);
  MapCleaner cleaner = clean(scans, paperConfig());
  const State before = stateOf(cleaner, scans);
  const double nan = test::kNan;
  std::vector<Scan> bad(3, scans[0]);
  bad[0].sensor_in_map.x() = nan;
  bad[1].T_map_cloud.translation().z() = nan;
  bad[2].T_map_cloud.linear()(0, 1) = test::kInfinity;
  for (const Scan& scan : bad) {
    EXPECT_THROW(cleaner.observe(scan), std::invalid_argument);
    for (const JudgementPass& pass : cleaner.passes()) {
      EXPECT_THROW(cleaner.add(pass, scan), std::invalid_argument);
    }
    EXPECT_THROW(cleaner.classify(scan), std::invalid_argument);
  }
  EXPECT_TRUE(stateOf(cleaner, scans) == before);
}

TEST(MapCleanerInput, ARefusedFirstScanDoesNotSetTheOrigin) {
  MapCleaner cleaner(paperConfig());
  Scan bad;
  bad.sensor_in_map.z() = test::kNan;
  EXPECT_THROW(cleaner.observe(bad), std::invalid_argument);
  EXPECT_EQ(cleaner.zOrigin(), 0.0);
  const std::vector<Scan> scans = test::randomDrive(3);
  for (const Scan& scan : scans) cleaner.observe(scan);
  EXPECT_EQ(cleaner.zOrigin(), scans[0].sensor_in_map.z());
}

TEST(MapCleanerInput, ScansWithoutUsablePointsChangeNothing) {
  const std::vector<Scan> scans = test::randomDrive(4);
  Scan empty, unusable;
  empty.sensor_in_map = unusable.sensor_in_map = Eigen::Vector3d(0.25, 0.25, 1.5);
  const float values[] = {test::kNan, test::kInfinity, -test::kInfinity, 3e38F, -3e38F, 1e9F};
  for (const float value : values) unusable.cloud.push_back(pcl::PointXYZ(value, 1.0F, value));
  unusable.cloud.push_back(pcl::PointXYZ(0.0F, 0.0F, 0.0F));
  std::vector<Scan> more = scans;
  more.push_back(empty);
  more.push_back(unusable);
  Classes classes = cleanedClasses(more, paperConfig());
  EXPECT_TRUE(classes[scans.size()].empty());
  EXPECT_EQ(classes.back(), std::vector<PointClass>(7, PointClass::kDropped));
  classes.resize(scans.size());
  EXPECT_EQ(classes, cleanedClasses(scans, paperConfig()));
}

TEST(MapCleanerInput, OnlyScansWithoutUsablePointsMakeAnEmptyMap) {
  const std::vector<Scan> scans(2);
  MapCleaner cleaner = clean(scans, paperConfig());
  EXPECT_EQ(cleaner.map().tileCount(), 0U);
  EXPECT_EQ(countOf(classify(cleaner, scans), PointClass::kStatic), 0);
}

TEST(MapCleanerInput, ASensorOutsideTheMappedAreaJudgesNothingThere) {
  std::vector<Scan> scans = test::randomDrive(5);
  const Classes alone = cleanedClasses(scans, paperConfig());
  Scan far_away = test::registeredScan({{-7000.0, 300.0, 2.0}}, {-7003.0, 300.0, 1.5});
  scans.push_back(far_away);
  Classes classes = cleanedClasses(scans, paperConfig());
  EXPECT_EQ(classes.back(), std::vector<PointClass>{PointClass::kStatic});
  classes.pop_back();
  EXPECT_EQ(classes, alone);
}

TEST(MapCleanerInput, WhereNoMapIsPointsAreStatic) {
  MapCleaner cleaner = clean(test::randomDrive(6), paperConfig());
  const std::size_t tiles = cleaner.map().tileCount();
  const Scan elsewhere = test::registeredScan({{900.0, 900.0, 1.0}}, {895.0, 900.0, 1.0});
  EXPECT_EQ(cleaner.classify(elsewhere), std::vector<PointClass>{PointClass::kStatic});
  EXPECT_EQ(cleaner.map().tileCount(), tiles);
}

TEST(MapCleanerInput, ABadHeightOfOneScanHarmsNoOther) {
  // A pose that jumps by 1e7 m for one scan: its points stand in the top bit or far below ground.
  std::vector<Scan> scans = test::randomDrive(8);
  for (const double jump : {1e7, -1e7}) {
    std::vector<Scan> with_jump = scans;
    with_jump.push_back(translated({scans[0]}, {0.0, 0.0, jump})[0]);
    Config config = paperConfig();
    config.scan.max_range = 1000.0;
    config.matrix.room_res_g = 0.0;
    const Classes classes = cleanedClasses(with_jump, config);
    EXPECT_EQ(classes.back().size(), scans[0].cloud.size());
    EXPECT_EQ(countOf(classes, PointClass::kDropped), 3 * static_cast<int>(with_jump.size()));
  }
}

TEST(MapCleanerAblation, WithoutTheGroundModuleNoGroundCellIsSplit) {
  Config config = paperConfig();
  config.coarse_ground.enabled = false;
  const MapCleaner cleaner = clean(test::randomDrive(9), config);
  cleaner.map().forEachTile([](ColumnIndex, const Tile& tile) {
    for (std::size_t i = 0; i < Tile::kColumns; ++i) EXPECT_EQ(tile.static_bins[i], 0);
  });
}

TEST(MapCleanerAblation, TheGroundModuleRemovesPartsOfGroundCells) {
  const auto drive = squareWithAWalker(13);
  const std::vector<Scan> scans = scansOf(drive);
  Config config = paperConfig();
  const int with_module = countOf(cleanedClasses(scans, config), PointClass::kDynamic);
  config.fine_ground.enabled = false;
  EXPECT_GT(with_module, countOf(cleanedClasses(scans, config), PointClass::kDynamic));
}

TEST(MapCleaner, OnlyCellsThatCanBeJudgedAreLookedAt) {
  const Config config;
  Scan scan;
  scan.sensor_in_map = {0.0, 0.0, 1.5};
  for (float x = 10.25F; x < 13.0F; x += 0.5F) {
    for (float y = 0.25F; y < 3.0F; y += 0.5F) {
      const bool middle = x == 11.25F && y == 1.25F;
      scan.cloud.emplace_back(x, y, middle ? 0.25F : 0.0F);  // a hole in the floor below a foot
      if (x == 12.25F) scan.cloud.emplace_back(x, y, 0.95F);
    }
  }
  MapCleaner cleaner(config);
  cleaner.observe(scan);
  cleaner.estimateGround();
  cleaner.add(cleaner.passes().front(), scan);
  const int ground = config.matrix.bits_below;
  const auto at = [&](double x, double y) {
    const ColumnIndex column = columnOf({x, y, 0.0}, config.matrix.res_g);
    return std::make_pair(cleaner.map().findTile(TileMap::tileOf(column)),
                          static_cast<std::size_t>(TileMap::indexInTile(column)));
  };
  const auto [flat, floor] = at(10.25, 0.25);
  EXPECT_TRUE(evidenceTile(*flat).flat[floor]);
  EXPECT_EQ(evidenceTile(*flat).possible[floor], Bits{0});
  EXPECT_FALSE(evidenceTile(*flat).evidence.has(floor));
  const auto [high, post] = at(12.25, 1.25);
  const EvidenceTile& high_state = evidenceTile(*high);
  EXPECT_FALSE(high_state.flat[post]);
  EXPECT_TRUE(high_state.evidence.has(post));
  EXPECT_EQ(high_state.possible[post] & ~lowBits(ground + 5), Bits{0}) << "nothing above the post";
  EXPECT_EQ(high_state.possible[post] & lowBits(ground), Bits{0}) << "nothing below the floor";
  EXPECT_EQ(high_state.possible[post] & high->occupied[post], high->occupied[post]);
  // Whether the ground cell was seen free decides what becomes of the points above it.
  const auto [hole, foot] = at(11.25, 1.25);
  EXPECT_EQ(evidenceTile(*hole).possible[foot], Bits{3} << ground);
}

TEST(MapCleaner, MemoryDoesNotGrowWithTheNumberOfScans) {
  const std::vector<Scan> scans = test::randomDrive(10);
  std::vector<Scan> many;
  for (int i = 0; i < 10; ++i) many.insert(many.end(), scans.begin(), scans.end());
  EXPECT_EQ(clean(many, paperConfig()).map().memoryBytes(),
            clean(scans, paperConfig()).map().memoryBytes());
}

TEST(MapCleaner, EachStageIsTimed) {
  const MapCleaner cleaner = clean(test::randomDrive(1), paperConfig());
  for (const char* stage : {"coarse_ground", "binary_encoding", "matrix_comparison", "sight_mask",
                            "reverse_ray_casting", "fine_ground"}) {
    const auto& stages = cleaner.times().stages();
    const auto found = std::find_if(stages.begin(), stages.end(),
                                    [&](const auto& entry) { return entry.first == stage; });
    ASSERT_NE(found, stages.end()) << stage;
    EXPECT_GE(found->second, 0.0);
  }
}

}  // namespace
}  // namespace beautymap
