// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/ground/scan_levelling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "beautymap/cleaner/map_cleaner.h"
#include "beautymap/cleaner/online_map.h"
#include "test_scenes.h"

namespace beautymap {
namespace {

using test::Box;
using test::BoxWorld;
using test::LabelledScan;

constexpr double kCell = 0.5;  // [m]
constexpr int kRadius = 100;   // [columns]
const Eigen::Vector3d kSensor(0.2, 0.3, 1.7);

/// Ground and walls, and what stands there only now.
Scan look(const std::vector<Box>& visitors = {}) {
  BoxWorld world;
  world.boxes = {{{-30, -20, 0}, {-29, 20, 3}}, {{-30, 19, 0}, {30, 20, 3}}};
  world.boxes.insert(world.boxes.end(), visitors.begin(), visitors.end());
  return test::castScan(world, kSensor, 48, -25.0, 10.0, 720).scan;
}

/// The scan with an error of its pose: turned about the sensor, which is raised.
Scan disturbed(Scan scan, double height, double roll_deg, double pitch_deg) {
  const double to_rad = std::acos(-1.0) / 180.0;
  const Eigen::Isometry3d turn(Eigen::AngleAxisd(pitch_deg * to_rad, Eigen::Vector3d::UnitY()) *
                               Eigen::AngleAxisd(roll_deg * to_rad, Eigen::Vector3d::UnitX()));
  const Eigen::Vector3d sensor = scan.sensor_in_map;
  scan.sensor_in_map.z() += height;
  scan.T_map_cloud = Eigen::Translation3d(scan.sensor_in_map) * turn *
                     Eigen::Translation3d(-sensor) * scan.T_map_cloud;
  return scan;
}

PlacedScan placed(const Scan& scan) {
  DroppedPoints dropped;
  return placeScan(scan, 0.0, kCell, ScanConfig(), dropped);
}

/// A map of which the levels are known from several scans.
class ScanLevelling : public testing::Test {
 protected:
  ScanLevelling() {
    for (int i = 0; i < 20; ++i) add(placed(look()));
  }
  void add(const PlacedScan& scan) { addLevels(map_, scan.anchor, lowestOfColumns(scan, kRadius)); }
  Levelling find(const PlacedScan& scan, const LevellingConfig& config = {}) const {
    return findLevelling(map_, scan.anchor, lowestOfColumns(scan, kRadius), kCell, config);
  }
  /// Nine of ten columns within 20 m have their ground no farther from zero [m].
  static double groundError(const PlacedScan& scan) {
    std::vector<float> errors;
    for (const ColumnLow& low : lowestOfColumns(scan, 40)) errors.push_back(std::abs(low.z));
    const auto ninth = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() * 9 / 10);
    std::nth_element(errors.begin(), ninth, errors.end());
    return *ninth;
  }

  TileMap map_{1};
};

TEST_F(ScanLevelling, BringsAScanToTheGroundOfTheOthers) {
  PlacedScan scan = placed(disturbed(look(), 0.08, 0.4, -0.3));
  add(scan);
  EXPECT_GT(groundError(scan), 0.1);
  const Levelling levelling = find(scan);
  applyLevelling(levelling, scan);
  EXPECT_LT(groundError(scan), 0.03);
  EXPECT_NEAR(scan.sensor.z(), kSensor.z(), 0.01);
}

TEST_F(ScanLevelling, LeavesScansThatFitAsTheyAre) {
  EXPECT_TRUE(find(placed(look())).isNone());
  const PlacedScan little = placed(disturbed(look(), 0.02, 0.0, 0.0));
  EXPECT_TRUE(find(little).isNone());
  LevellingConfig config;
  config.min_correction = 0.005;
  EXPECT_NEAR(find(little, config).height, -0.02, 0.005);
}

TEST_F(ScanLevelling, IsNotMistakenForWhatStandsThereNow) {
  const std::vector<Box> bus = {{{4, -3, 0}, {7, 9, 3}}, {{-9, -8, 0}, {-5, -6, 1.5}}};
  EXPECT_TRUE(find(placed(look(bus))).isNone());
  PlacedScan scan = placed(disturbed(look(bus), -0.06, -0.3, 0.2));
  applyLevelling(find(scan), scan);
  EXPECT_LT(groundError(scan), 0.03);
}

TEST_F(ScanLevelling, WithoutCommonGroundAScanStays) {
  Scan elsewhere = disturbed(look(), 0.08, 0.4, -0.3);
  elsewhere.T_map_cloud = Eigen::Translation3d(500, 0, 0) * elsewhere.T_map_cloud;
  elsewhere.sensor_in_map.x() += 500;
  PlacedScan scan = placed(elsewhere);
  add(scan);
  EXPECT_TRUE(find(scan).isNone()) << "nobody else saw that place";
  EXPECT_TRUE(find(placed(test::registeredScan({}, kSensor))).isNone());
  // Another storey: its floor is no error of the pose.
  PlacedScan upstairs = placed(disturbed(look(), 3.0, 0.0, 0.0));
  EXPECT_LT(std::abs(find(upstairs).height), 0.1);
}

TEST_F(ScanLevelling, RoughGroundThatAPlaneDoesNotExplainStays) {
  test::Random random(5);
  const auto lows = [&](double raised, double roughness) {
    std::vector<ColumnLow> columns;
    for (int x = -15; x < 15; ++x) {
      for (int y = -15; y < 15; ++y) {
        const double z = raised + random.uniform(-roughness, roughness);
        columns.push_back({x, y, static_cast<float>(z)});
      }
    }
    return columns;
  };
  for (const double roughness : {0.05, 0.3}) {
    TileMap map(1);
    for (int i = 0; i < 20; ++i) addLevels(map, {0, 0}, lows(0.0, roughness));
    const Levelling found = findLevelling(map, {0, 0}, lows(0.08, roughness), kCell, {});
    if (roughness < 0.1) {
      EXPECT_NEAR(found.height, -0.08, 0.01);
    } else {
      EXPECT_TRUE(found.isNone());
    }
  }
}

TEST_F(ScanLevelling, LevelsAreMeansOfTheScansAsTheyWerePosed) {
  TileMap map(1);
  const Scan scan = test::registeredScan({{0.1, 0.1, 0.5}, {0.2, 0.2, 0.9}}, {0.0, 0.0, 1.5});
  for (const double height : {0.0, 0.3}) {
    const PlacedScan raised = placed(disturbed(scan, height, 0.0, 0.0));
    addLevels(map, raised.anchor, lowestOfColumns(raised, kRadius));
  }
  const Tile& tile = *map.findTile({0, 0});
  EXPECT_FLOAT_EQ(tile.level[0], 0.65F);
  EXPECT_EQ(tile.level_scans[0], 2);
}

TEST_F(ScanLevelling, TheLowestStoreyIsAColumnsLevel) {
  TileMap map(1);
  const auto addHeight = [&](float z) { addLevels(map, {0, 0}, {{0, 0, z}}); };
  const Tile& tile = map.tileAt({0, 0});
  for (const float z : {2.0F, 2.2F, 5.0F}) addHeight(z);
  EXPECT_FLOAT_EQ(tile.level[0], 2.1F);
  EXPECT_EQ(tile.level_scans[0], 2);
  for (const float z : {-1.0F, 2.0F, -1.2F}) addHeight(z);
  EXPECT_FLOAT_EQ(tile.level[0], -1.1F);
  EXPECT_EQ(tile.level_scans[0], 2);
}

TEST(ApplyLevelling, MovesPointsRunsAndSensorAlike) {
  const PlacedScan before = placed(look());
  PlacedScan after = before;
  const Levelling levelling{0.1F, 0.002F, -0.001F};
  applyLevelling(levelling, after);
  EXPECT_FLOAT_EQ(after.sensor.z(), before.sensor.z() + 0.1F);
  for (std::size_t r = 0; r < before.runs.size(); ++r) {
    const ColumnRun &from = before.runs[r], &to = after.runs[r];
    const float height = levelling.at(from.x, from.y);
    EXPECT_FLOAT_EQ(to.lowest, from.lowest + height);
    EXPECT_FLOAT_EQ(to.highest, from.highest + height);
    for (std::uint32_t i = from.begin; i < from.end; ++i) {
      ASSERT_FLOAT_EQ(after.z[i], before.z[i] + height);
    }
  }
  EXPECT_EQ(after.x, before.x);
  EXPECT_EQ(after.y, before.y);
}

/// A walker among scans whose poses are wrong, and the shares that stay.
class NoisyPoses : public testing::Test {
 protected:
  struct Kept {
    double ground, walker;
  };
  NoisyPoses() {
    test::Random random(3);
    const auto error = [&] { return random.uniform(-1.0, 1.0); };
    for (int i = 0; i < 24; ++i) {
      const double y = -6.0 + 0.5 * i;
      BoxWorld world;
      world.boxes = {{{-30, 19, 0}, {30, 20, 3}}, {{4.7, y - 0.3, 0}, {5.3, y + 0.3, 1.8}}};
      LabelledScan scan = test::castScan(world, kSensor, 48, -25.0, 10.0, 720);
      scan.scan = disturbed(scan.scan, 0.1 * error(), 0.4 * error(), 0.4 * error());
      scans_.push_back(scan);
    }
  }
  template <typename Classify>
  Kept kept(Classify classify) const {
    double ground = 0, kept_ground = 0, walker = 0, kept_walker = 0;
    for (const LabelledScan& scan : scans_) {
      const std::vector<PointClass> classes = classify(scan.scan);
      for (std::size_t i = 0; i < classes.size(); ++i) {
        const bool is_kept = classes[i] == PointClass::kStatic;
        if (scan.box[i] == 1) {
          ++walker;
          kept_walker += is_kept ? 1 : 0;
        } else if (scan.box[i] != 0) {
          ++ground;
          kept_ground += is_kept ? 1 : 0;
        }
      }
    }
    return {kept_ground / ground, kept_walker / walker};
  }
  Kept replayed(bool levelling) const {
    Config config;
    config.matrix.room_res_g = 0.0;
    config.levelling.enabled = levelling;
    MapCleaner cleaner(config);
    cleanMap(cleaner, [&](const auto& f) {
      for (const LabelledScan& scan : scans_) f(scan.scan);
    });
    return kept([&](const Scan& scan) { return cleaner.classify(scan); });
  }

  Kept online(bool levelling, double bin_height = GroundLayerConfig().bin_height) const {
    Config config;
    config.ground_layer.bin_height = bin_height;
    config.levelling.enabled = levelling;
    OnlineMap map(config);
    for (const LabelledScan& scan : scans_) {
      map.addHits(scan.scan);
      map.addSeenFree();
    }
    map.settle();
    return kept([&](const Scan& scan) { return map.classify(scan); });
  }

  std::vector<LabelledScan> scans_;
};

TEST_F(NoisyPoses, GroundStaysAndTheWalkerGoes) {
  const Kept with = replayed(true), without = replayed(false);
  EXPECT_GT(with.ground, 0.999);
  EXPECT_GT(with.ground, without.ground);
  EXPECT_LT(with.walker, 0.5 * without.walker);
}

TEST_F(NoisyPoses, OnlineToo) {
  const Kept with = online(true), without = online(false);
  EXPECT_GT(with.ground, 0.99);
  EXPECT_GT(with.ground, without.ground);
  EXPECT_LT(with.walker, 0.1);
}

TEST_F(NoisyPoses, OnlineWithCoarseBinsOfTheGroundToo) {
  const Kept with = online(true, 0.05), without = online(false, 0.05);
  EXPECT_GT(with.ground, 0.99);
  EXPECT_GT(with.ground, without.ground);
  EXPECT_LT(with.walker, without.walker);
}

}  // namespace
}  // namespace beautymap
