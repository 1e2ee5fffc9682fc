// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/online/online_cleaner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <thread>

#include "beautymap/io/cloud_fields.h"
#include "beautymap/io/pcd_stream.h"
#include "beautymap/online/save_points.h"
#include "beautymap/simulation/simulated_source.h"
#include "io/io_test_helpers.h"

namespace beautymap {
namespace {

using test::TempFolder;
using Records = std::vector<std::vector<std::uint8_t>>;

std::vector<SourceScan> simulate(const std::string& scene, int scans) {
  simulation::SimulationOptions options;
  options.scene = scene;
  options.sensor = "vlp16";
  options.scans = scans;
  options.seed = 4;
  simulation::SimulatedSource source(options);
  std::vector<SourceScan> all(static_cast<std::size_t>(options.scans));
  for (SourceScan& scan : all) source.next(scan);
  return all;
}

const std::vector<SourceScan>& street() {
  static const std::vector<SourceScan> scans = simulate("street", 30);
  return scans;
}

void add(OnlineCleaner& cleaner, const std::vector<SourceScan>& scans, std::size_t begin = 0,
         std::size_t end = std::numeric_limits<std::size_t>::max()) {
  for (std::size_t i = begin; i < std::min(end, scans.size()); ++i) {
    cleaner.add(scans[i]);
    cleaner.finish(scans[i]);
  }
}

Config everyPoint() {
  Config config;
  config.online.map_voxel = 0.0;
  return config;
}

/// The sorted records of a PCD file.
Records recordsOf(const std::string& path) {
  const pcl::PCLPointCloud2 cloud = readPcd(path);
  Records records;
  for (std::size_t i = 0; i < cloud.width; ++i) {
    const auto* record = cloud.data.data() + i * cloud.point_step;
    records.emplace_back(record, record + cloud.point_step);
  }
  std::sort(records.begin(), records.end());
  return records;
}

/// Cleaned and removed points as they are saved.
std::pair<Records, Records> saved(const OnlineCleaner& cleaner) {
  const TempFolder folder;
  savePoints(cleaner, folder / "a.pcd", folder / "b.pcd", 0.0);
  return {recordsOf(folder / "a.pcd"), recordsOf(folder / "b.pcd")};
}

TEST(OnlineCleaner, EveryUsablePointIsSavedOnceWithAllItsFields) {
  OnlineCleaner cleaner(everyPoint(), "");
  add(cleaner, street());
  const TempFolder folder;
  savePoints(cleaner, folder / "a.pcd", folder / "b.pcd", 0.0);
  Records found = recordsOf(folder / "a.pcd"), removed = recordsOf(folder / "b.pcd");
  EXPECT_GT(removed.size(), 100U);
  found.insert(found.end(), removed.begin(), removed.end());
  std::sort(found.begin(), found.end());
  // What was given, written by the same writer.
  PcdStreamWriter writer(folder / "all.pcd", street().front().cloud);
  std::uint64_t points = 0;
  for (const SourceScan& scan : street()) {
    const auto moved = moveCloud(scan.cloud, scan.T_map_cloud, false);
    for (std::size_t i = 0; i < moved.width; ++i) {
      writer.append(moved.data.data() + i * moved.point_step);
    }
    points += moved.width;
  }
  writer.close();
  EXPECT_EQ(found.size() + cleaner.dropped().total(), points);
  EXPECT_EQ(found, recordsOf(folder / "all.pcd"));
}

TEST(OnlineCleaner, StandingStillDoesNotMakeTheMapGrow) {
  OnlineCleaner cleaner(Config(), "");
  const std::vector<SourceScan> still(5, street().front());
  add(cleaner, still, 0, 1);
  const std::size_t once = cleaner.size().points;
  EXPECT_LT(once, street().front().cloud.width);
  add(cleaner, still, 1);
  EXPECT_EQ(cleaner.size().points, once);
}

TEST(OnlineCleaner, TilesOutsideTheRadiusComeBackFromDiskAsTheyWere) {
  // The drive is shorter than a radius: the sensor is moved away and back.
  std::vector<SourceScan> there_and_back(street().begin(), street().begin() + 20);
  for (std::size_t i = 8; i < 14; ++i) {
    there_and_back[i].T_map_cloud.pretranslate(Eigen::Vector3d(500, 0, 0));
    there_and_back[i].T_map_sensor.pretranslate(Eigen::Vector3d(500, 0, 0));
  }
  Config config = everyPoint();
  config.scan.max_range = 40.0;
  OnlineCleaner unbounded(config, "");
  config.online.radius = 40.0;
  const TempFolder folder;
  {
    OnlineCleaner bounded(config, folder / "tiles");
    for (std::size_t i = 0; i < there_and_back.size(); ++i) {
      const auto expected = unbounded.add(there_and_back[i]);
      unbounded.finish(there_and_back[i]);
      EXPECT_EQ(bounded.add(there_and_back[i]), expected) << "scan " << i;
      bounded.finish(there_and_back[i]);
      EXPECT_TRUE(i != 10 || bounded.size().tiles_on_disk > 5U);
      EXPECT_EQ(bounded.size().points, unbounded.size().points);
      // Who looks at a map has it judged; so does who puts tiles on disk, and what is judged a
      // scan earlier may be judged a little differently.
      EXPECT_EQ(saved(bounded), saved(unbounded)) << "scan " << i;
    }
    EXPECT_GT(bounded.size().tiles_on_disk, 0U);
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "tiles")) << "the cleaner tidies up";
}

TEST(OnlineCleaner, ALoadedSessionGoesOnAsIfNothingHadHappened) {
  const TempFolder folder;
  OnlineCleaner whole(Config(), "");
  add(whole, street());
  OnlineCleaner first(Config(), "");
  add(first, street(), 0, 15);
  first.saveSession(folder / "half.session", "odom");
  OnlineCleaner second(Config(), "");
  EXPECT_EQ(second.loadSession(folder / "half.session"), "odom");
  EXPECT_EQ(saved(second), saved(first));
  add(second, street(), 15);
  EXPECT_EQ(saved(second), saved(whole));
}

TEST(OnlineCleaner, ARoomHasSmallerCellsAlsoWhenItsSessionGoesOn) {
  const Config config;
  const std::vector<SourceScan> stairs = simulate("stairs", 10);
  const auto sizeOf = [](const OnlineCleaner& cleaner) {
    return cleaner.matrixAround(5.0).config.res_g;
  };
  OnlineCleaner outside(config, "");
  add(outside, street(), 0, 1);
  add(outside, stairs, 0, 1);
  EXPECT_EQ(sizeOf(outside), config.matrix.res_g) << "the first scan decides";
  OnlineCleaner whole(config, ""), first(config, ""), second(config, "");
  SourceScan empty = stairs.front();
  empty.cloud.width = 0;
  empty.cloud.data.clear();
  whole.add(empty);
  whole.finish(empty);
  add(whole, stairs);
  EXPECT_EQ(sizeOf(whole), config.matrix.room_res_g) << "the first scan with points";
  const TempFolder folder;
  add(first, stairs, 0, 5);
  first.saveSession(folder / "half.session", "odom");
  second.loadSession(folder / "half.session");
  EXPECT_EQ(sizeOf(second), config.matrix.room_res_g);
  add(second, stairs, 5);
  EXPECT_EQ(saved(second), saved(whole));
}

TEST(OnlineCleaner, SessionsThatCannotBeContinuedAreRefused) {
  const TempFolder folder;
  OnlineCleaner cleaner(Config(), "");
  add(cleaner, street(), 0, 3);
  cleaner.saveSession(folder / "a.session", "map");
  Config other;
  other.matrix.res_g = 1.0;
  EXPECT_THROW(OnlineCleaner(other, "").loadSession(folder / "a.session"), InputError);
  EXPECT_THROW(OnlineCleaner(Config(), "").loadSession(folder / "missing"), InputError);
  std::ofstream(folder / "text") << "no session";
  EXPECT_THROW(OnlineCleaner(Config(), "").loadSession(folder / "text"), InputError);
  std::filesystem::resize_file(folder / "a.session",
                               std::filesystem::file_size(folder / "a.session") / 2);
  EXPECT_THROW(OnlineCleaner(Config(), "").loadSession(folder / "a.session"), InputError);
}

TEST(OnlineCleaner, ASessionOfTheOtherJudgementIsRefusedWithBothNames) {
  const TempFolder folder;
  Config published;
  published.judgement.method = "published";
  const std::string file = folder / "a.session";
  for (const auto& [first, second] :
       {std::make_pair(Config(), published), std::make_pair(published, Config())}) {
    OnlineCleaner cleaner(first, "");
    add(cleaner, street(), 0, 3);
    cleaner.saveSession(file, "map");
    OnlineCleaner again(first, "");
    again.loadSession(file);
    EXPECT_EQ(saved(again), saved(cleaner));
    try {
      OnlineCleaner(second, "").loadSession(file);
      FAIL() << "it was loaded";
    } catch (const InputError& error) {
      const std::string what = error.what();
      EXPECT_NE(what.find("evidence"), std::string::npos) << what;
      EXPECT_NE(what.find("published"), std::string::npos) << what;
    }
  }
}

TEST(OnlineCleaner, AFolderThatIsMissingLeavesTheMap) {
  OnlineCleaner cleaner(Config(), "");
  add(cleaner, street(), 0, 2);
  EXPECT_THROW(savePoints(cleaner, "/nowhere/a.pcd", "/nowhere/b.pcd", 0.0), InputError);
  EXPECT_THROW(cleaner.saveSession("/nowhere/a.session", "map"), InputError);
  EXPECT_GT(saved(cleaner).first.size(), 1000U);
}

TEST(OnlineCleaner, AnEmptyMapIsNotSaved) {
  const TempFolder folder;
  OnlineCleaner cleaner(Config(), "");
  EXPECT_THROW(savePoints(cleaner, folder / "a.pcd", folder / "b.pcd", 0.0), InputError);
}

TEST(OnlineCleaner, ADisplayVoxelThinsWhatIsSaved) {
  const TempFolder folder;
  OnlineCleaner cleaner(Config(), "");
  add(cleaner, street(), 0, 5);
  const auto all = savePoints(cleaner, folder / "a.pcd", folder / "b.pcd", 0.0);
  const auto thin = savePoints(cleaner, folder / "a.pcd", folder / "b.pcd", 1.0);
  EXPECT_LT(2 * thin.first, all.first);
  EXPECT_EQ(readPcd(folder / "a.pcd").width, thin.first);
}

TEST(OnlineCleaner, OnlyTilesThatChangedAreLookedAtAgain) {
  OnlineCleaner cleaner(Config(), "");
  // Long enough to find out which of the columns hang over free space.
  const std::vector<SourceScan> still(20, street().front());
  add(cleaner, still);
  const auto tiles = cleaner.tiles();
  std::vector<OnlineCleaner::TileView> views(tiles.size());
  for (std::size_t i = 0; i < tiles.size(); ++i) EXPECT_TRUE(cleaner.look(tiles[i], views[i]));
  add(cleaner, still, 19);
  for (std::size_t i = 0; i < tiles.size(); ++i) EXPECT_FALSE(cleaner.look(tiles[i], views[i]));
  add(cleaner, street(), 1, 2);
  int changed = 0;
  for (std::size_t i = 0; i < tiles.size(); ++i)
    changed += cleaner.look(tiles[i], views[i]) ? 1 : 0;
  EXPECT_GT(changed, 0);
}

TEST(OnlineCleaner, TheMapIsLookedAtWhileItGrows) {
  OnlineCleaner cleaner(Config(), "");
  std::atomic<bool> done{false};
  std::size_t most = 0;
  std::thread reader([&] {
    while (!done) {
      std::size_t points = 0;
      for (const ColumnIndex tile : cleaner.tiles()) {
        OnlineCleaner::TileView view;
        cleaner.look(tile, view);
        points += view.cleaned.size() + view.removed.size();
      }
      most = std::max(most, points);
      cleaner.matrixAround(20.0);
      cleaner.size();
    }
  });
  add(cleaner, street(), 0, 10);
  done = true;
  reader.join();
  EXPECT_LE(most, cleaner.size().points * cleaner.layout().point_step);
}

TEST(OnlineCleaner, ABadPoseIsRefusedAndChangesNothing) {
  OnlineCleaner cleaner(Config(), "");
  SourceScan scan = street().front();
  scan.T_map_sensor.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(cleaner.add(scan), std::invalid_argument);
  EXPECT_EQ(cleaner.size().tiles, 0U);
  add(cleaner, street(), 0, 1);
  EXPECT_GT(cleaner.size().points, 0U);
}

}  // namespace
}  // namespace beautymap
