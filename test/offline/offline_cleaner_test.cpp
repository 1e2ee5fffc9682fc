// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/offline/offline_cleaner.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "beautymap/cleaner/map_cleaner.h"
#include "beautymap/io/cloud_fields.h"
#include "beautymap/io/pcd_stream.h"
#include "offline/offline_test_helpers.h"

namespace beautymap {
namespace {

using test::MemorySource;
using test::OutputFolder;

Config testConfig() {
  Config config;
  config.judgement.method = "published";
  config.levelling.enabled = false;
  config.matrix.bits_below = 0;
  config.matrix.res_g = 1.0;
  config.matrix.room_res_g = 0.0;
  config.matrix.res_h = 0.5;
  config.fine_ground.bin_height = 0.125;
  return config;
}

/// What progress was told.
struct Progress {
  std::vector<std::string> passes;
  std::vector<std::size_t> steps;
};

OfflineReport run(ScanSource& source, const OfflineOptions& options, Progress* told = nullptr,
                  const Config& config = testConfig()) {
  ProgressListener listener;
  listener.begin = [&](const std::string& pass, std::size_t) {
    if (told) told->passes.push_back(pass), told->steps.push_back(0);
  };
  listener.step = [&] {
    if (told) ++told->steps.back();
  };
  return cleanOffline(source, config, options, listener);
}

OfflineOptions into(const OutputFolder& folder) {
  OfflineOptions options;
  options.output = folder.path();
  return options;
}

/// What the core says about each point, in the order of the ids.
std::vector<PointClass> classesOf(const std::vector<SourceScan>& sources,
                                  const Config& config = testConfig()) {
  std::vector<Scan> scans;
  for (const SourceScan& source : sources) {
    Scan scan;
    const FieldReader x(source.cloud, "x"), y(source.cloud, "y"), z(source.cloud, "z");
    for (std::size_t i = 0; i < source.cloud.width; ++i) {
      scan.cloud.push_back(pcl::PointXYZ(static_cast<float>(x(i)), static_cast<float>(y(i)),
                                         static_cast<float>(z(i))));
    }
    scan.T_map_cloud = source.T_map_cloud;
    scan.sensor_in_map = source.T_map_sensor.translation();
    scans.push_back(scan);
  }
  MapCleaner cleaner(config);
  cleanMap(cleaner, [&](const auto& f) {
    for (const Scan& scan : scans) f(scan);
  });
  std::vector<PointClass> classes;
  for (const Scan& scan : scans) {
    const std::vector<PointClass> of_scan = cleaner.classify(scan);
    classes.insert(classes.end(), of_scan.begin(), of_scan.end());
  }
  return classes;
}

std::vector<std::uint32_t> idsIn(const std::string& pcd) {
  const pcl::PCLPointCloud2 cloud = readPcd(pcd);
  const FieldReader id(cloud, "id");
  std::vector<std::uint32_t> ids;
  for (std::size_t i = 0; i < cloud.width; ++i) ids.push_back(static_cast<std::uint32_t>(id(i)));
  return ids;
}

std::vector<std::uint32_t> idsOf(const std::vector<PointClass>& classes, PointClass wanted) {
  std::vector<std::uint32_t> ids;
  for (std::size_t i = 0; i < classes.size(); ++i) {
    if (classes[i] == wanted) ids.push_back(static_cast<std::uint32_t>(i));
  }
  return ids;
}

TEST(OfflineCleaner, WritesThePointsAsTheCoreClassifiesThemInTheirOrder) {
  for (std::uint32_t seed = 0; seed < 4; ++seed) {
    const std::vector<SourceScan> scans = test::sourceDrive(seed);
    const std::vector<PointClass> classes = classesOf(scans);
    ASSERT_FALSE(idsOf(classes, PointClass::kDynamic).empty());
    const OutputFolder folder;
    MemorySource source(scans);
    const OfflineReport report = run(source, into(folder));
    EXPECT_EQ(idsIn(folder.file("cleaned.pcd")), idsOf(classes, PointClass::kStatic));
    EXPECT_EQ(idsIn(folder.file("dynamic.pcd")), idsOf(classes, PointClass::kDynamic));
    EXPECT_EQ(report.scans, scans.size());
    EXPECT_EQ(report.points, classes.size());
    EXPECT_EQ(report.static_points, idsOf(classes, PointClass::kStatic).size());
    EXPECT_EQ(report.dynamic_points, idsOf(classes, PointClass::kDynamic).size());
    EXPECT_EQ(report.dropped_points.total(), idsOf(classes, PointClass::kDropped).size());
  }
}

TEST(OfflineCleaner, LevelledScansAreWrittenAsTheyWerePosed) {
  std::vector<SourceScan> scans;
  std::uint32_t first_id = 0;
  for (int i = 0; i < 6; ++i) {
    test::BoxWorld world;  // a wall, and somebody who walks by
    world.boxes = {{{-20, 9, 0}, {20, 10, 3}},
                   {{4.0, 0.6 * i - 2.0, 0}, {4.6, 0.6 * i - 1.4, 1.8}}};
    const Scan scan = test::castScan(world, {0.2, 0.3, 1.7}, 32, -25.0, 10.0, 360).scan;
    scans.push_back(test::sourceScan(scan, first_id, true));
    first_id += scans.back().cloud.width;
    const double height = i % 2 == 0 ? 0.1 : -0.1;
    scans.back().T_map_cloud.translation().z() += height;
    scans.back().T_map_sensor.translation().z() += height;
  }
  Config config;
  config.matrix.res_g = 1.0;
  config.matrix.room_res_g = 0.0;
  config.levelling.min_correction = 0.0;
  Config as_posed = config;
  as_posed.levelling.enabled = false;
  const std::vector<PointClass> classes = classesOf(scans, config);
  ASSERT_NE(classes, classesOf(scans, as_posed)) << "no scan was levelled";
  const OutputFolder levelled, unchanged;
  MemorySource source(scans);
  run(source, into(levelled), nullptr, config);
  EXPECT_EQ(idsIn(levelled.file("cleaned.pcd")), idsOf(classes, PointClass::kStatic));
  EXPECT_EQ(idsIn(levelled.file("dynamic.pcd")), idsOf(classes, PointClass::kDynamic));
  source.rewind();
  run(source, into(unchanged), nullptr, as_posed);
  const auto heightsOf = [](const OutputFolder& folder) {
    std::map<std::uint32_t, double> heights;
    for (const char* file : {"cleaned.pcd", "dynamic.pcd"}) {
      const pcl::PCLPointCloud2 cloud = readPcd(folder.file(file));
      const FieldReader id(cloud, "id"), z(cloud, "z");
      for (std::size_t i = 0; i < cloud.width; ++i)
        heights[static_cast<std::uint32_t>(id(i))] = z(i);
    }
    return heights;
  };
  EXPECT_EQ(heightsOf(levelled), heightsOf(unchanged));
}

TEST(OfflineCleaner, PointsAreInTheMapFrameAndOtherFieldsBitExact) {
  const std::vector<SourceScan> scans = test::sourceDrive(5);
  const OutputFolder folder;
  MemorySource source(scans);
  run(source, into(folder));
  struct Expected {
    Eigen::Vector3d position;
    double ring, label;
  };
  std::map<std::uint32_t, Expected> truth;
  for (const SourceScan& scan : scans) {
    const FieldReader x(scan.cloud, "x"), y(scan.cloud, "y"), z(scan.cloud, "z");
    const FieldReader ring(scan.cloud, "ring"), id(scan.cloud, "id"), label(scan.cloud, "label");
    for (std::size_t i = 0; i < scan.cloud.width; ++i) {
      truth[static_cast<std::uint32_t>(id(i))] = {
          scan.T_map_cloud * Eigen::Vector3d(x(i), y(i), z(i)), ring(i), label(i)};
    }
  }
  for (const char* name : {"cleaned.pcd", "dynamic.pcd"}) {
    const pcl::PCLPointCloud2 cloud = readPcd(folder.file(name));
    const FieldReader x(cloud, "x"), y(cloud, "y"), z(cloud, "z");
    const FieldReader ring(cloud, "ring"), id(cloud, "id"), label(cloud, "label");
    EXPECT_EQ(ring.datatype(), pcl::PCLPointField::UINT16);
    EXPECT_EQ(label.datatype(), pcl::PCLPointField::UINT32);
    ASSERT_GT(cloud.width, 0U);
    for (std::size_t i = 0; i < cloud.width; ++i) {
      const Expected& expected = truth.at(static_cast<std::uint32_t>(id(i)));
      // The scenes' coordinates are multiples of 1/1024 m and quarter turns: exact.
      EXPECT_EQ(Eigen::Vector3d(x(i), y(i), z(i)), expected.position);
      EXPECT_EQ(ring(i), expected.ring);
      EXPECT_EQ(label(i), expected.label);
    }
  }
}

TEST(OfflineCleaner, ScoresEqualComparingAllPairsOfLabelsAndCleanedPoints) {
  const std::vector<SourceScan> scans = test::sourceDrive(6);
  const OutputFolder folder;
  MemorySource source(scans);
  const OfflineReport report = run(source, into(folder));
  const pcl::PCLPointCloud2 cleaned = readPcd(folder.file("cleaned.pcd"));
  const FieldReader cx(cleaned, "x"), cy(cleaned, "y"), cz(cleaned, "z");
  Score expected;
  for (const SourceScan& scan : scans) {
    const FieldReader x(scan.cloud, "x"), y(scan.cloud, "y"), z(scan.cloud, "z");
    const FieldReader label(scan.cloud, "label");
    for (std::size_t i = 0; i < scan.cloud.width; ++i) {
      const Eigen::Vector3d measured(x(i), y(i), z(i));
      if (!measured.allFinite() || measured.isZero(0.0)) continue;  // has no position
      const Eigen::Vector3d p = scan.T_map_cloud * measured;
      bool kept = false;
      for (std::size_t c = 0; c < cleaned.width && !kept; ++c) {
        kept = (p - Eigen::Vector3d(cx(c), cy(c), cz(c))).norm() < 0.05;
      }
      const bool moving = label(i) > 0;
      ++(moving ? expected.dynamic_points : expected.static_points);
      if (kept) ++(moving ? expected.kept_dynamic : expected.kept_static);
    }
  }
  ASSERT_TRUE(report.score);
  EXPECT_EQ(report.score->static_points, expected.static_points);
  EXPECT_EQ(report.score->dynamic_points, expected.dynamic_points);
  EXPECT_EQ(report.score->kept_static, expected.kept_static);
  EXPECT_EQ(report.score->kept_dynamic, expected.kept_dynamic);
}

TEST(OfflineCleaner, WithLabelsAPictureOfTheMistakesIsMade) {
  const OutputFolder labelled_folder, plain_folder;
  MemorySource labelled(test::sourceDrive(1, true)), plain(test::sourceDrive(1, false));
  run(labelled, into(labelled_folder));
  const OfflineReport report = run(plain, into(plain_folder));
  const std::set<std::string> files{"cleaned.pcd", "dynamic.pcd", "report.json",
                                    "before.png",  "after.png",   "matrix.png"};
  EXPECT_EQ(plain_folder.names(), files);
  EXPECT_FALSE(report.score);
  std::set<std::string> with_mistakes = files;
  with_mistakes.insert("mistakes.png");
  EXPECT_EQ(labelled_folder.names(), with_mistakes);
}

TEST(OfflineCleaner, TheReportSaysWhatWasDoneAndWithWhichParameters) {
  const OutputFolder folder;
  MemorySource source(test::sourceDrive(2));
  const OfflineReport report = run(source, into(folder));
  const auto json = nlohmann::json::parse(test::bytesOf(folder.file("report.json")));
  EXPECT_EQ(json.at("scans"), report.scans);
  EXPECT_EQ(json.at("points"), report.points);
  EXPECT_EQ(json.at("skipped").at("points").at("zero"), report.dropped_points.zero);
  EXPECT_TRUE(json.at("skipped").at("scans").empty());
  EXPECT_GT(json.at("scans_per_s"), 0.0);
  EXPECT_GT(json.at("peak_memory_mb"), 0.0);
  EXPECT_FALSE(json.at("stages_ms").empty());
  EXPECT_EQ(json.at("scores").at("HA"), report.score->HA());
  EXPECT_EQ(json.at("config").at("matrix").at("res_g"), 1.0);
  EXPECT_EQ(json.at("config").at("coarse_ground").at("enabled"), true);
  EXPECT_EQ(json.at("coordinates"), "float32");
}

TEST(OfflineCleaner, ARoomHasSmallerCells) {
  Scan room;
  for (int i = 0; i < 1000; ++i) {
    const float angle = 0.00628F * static_cast<float>(i);
    room.cloud.emplace_back(4.0F * std::cos(angle), 4.0F * std::sin(angle), 0.0F);
  }
  const OutputFolder folder;
  const Config config;
  MemorySource source({test::sourceScan(Scan(), 0), test::sourceScan(room, 0)});
  const OfflineReport report = run(source, into(folder), nullptr, config);
  EXPECT_EQ(report.scans, 2U);
  EXPECT_EQ(report.static_points, 1000U);
  EXPECT_EQ(report.cell_size_m, config.matrix.room_res_g);
  const auto json = nlohmann::json::parse(test::bytesOf(folder.file("report.json")));
  EXPECT_EQ(json.at("matrix").at("cell_size_m"), config.matrix.room_res_g);
  EXPECT_EQ(json.at("config").at("matrix").at("res_g"), config.matrix.res_g) << "as it was given";
}

TEST(OfflineCleaner, ReadsTheSourceOnce) {
  const std::vector<SourceScan> scans = test::sourceDrive(3);
  const OutputFolder folder;
  MemorySource source(scans);
  run(source, into(folder));
  EXPECT_EQ(source.reads(), scans.size() + 1) << "each scan, and the end";
}

TEST(OfflineCleaner, TheSameInputGivesTheSameBytes) {
  const OutputFolder first, second;
  MemorySource source(test::sourceDrive(4)), again(test::sourceDrive(4));
  run(source, into(first));
  run(again, into(second));
  for (const char* name :
       {"cleaned.pcd", "dynamic.pcd", "before.png", "after.png", "matrix.png", "mistakes.png"}) {
    EXPECT_EQ(test::bytesOf(first.file(name)), test::bytesOf(second.file(name))) << name;
  }
}

TEST(OfflineCleaner, AnyNumberOfThreadsGivesTheSameBytes) {
  for (const char* method : {"published", "evidence"}) {
    Config config = testConfig();
    config.judgement.method = method;
    const OutputFolder one, several;
    for (const OutputFolder* folder : {&one, &several}) {
      const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                        folder == &one ? 1 : 4);
      MemorySource source(test::sourceDrive(5));
      run(source, into(*folder), nullptr, config);
    }
    EXPECT_FALSE(test::bytesOf(one.file("dynamic.pcd")).empty());
    for (const char* name :
         {"cleaned.pcd", "dynamic.pcd", "before.png", "after.png", "matrix.png", "mistakes.png"}) {
      EXPECT_EQ(test::bytesOf(one.file(name)), test::bytesOf(several.file(name))) << name;
    }
  }
}

TEST(OfflineCleaner, ProgressIsToldOfEachPassAndEachScan) {
  const std::vector<SourceScan> scans = test::sourceDrive(3);
  const OutputFolder folder;
  MemorySource source(scans);
  Progress told;
  run(source, into(folder), &told);
  EXPECT_GE(told.passes.size(), 3U) << "building the matrix, comparing, writing";
  for (std::size_t pass = 0; pass < told.passes.size(); ++pass) {
    EXPECT_EQ(told.steps[pass], scans.size()) << told.passes[pass];
  }
}

TEST(OfflineCleaner, UnusableScansAreSkippedAndCounted) {
  std::vector<SourceScan> scans = test::sourceDrive(7);
  const std::vector<PointClass> classes = classesOf(scans);
  SourceScan lost = scans[1], other = test::sourceDrive(7, false)[0];
  lost.T_map_sensor.translation().x() = std::numeric_limits<double>::quiet_NaN();
  scans.insert(scans.begin() + 2, lost);
  scans.push_back(other);
  const OutputFolder folder;
  MemorySource source(scans);
  const OfflineReport report = run(source, into(folder));
  EXPECT_EQ(report.scans, scans.size() - 2);
  std::size_t skipped = 0;
  for (const auto& reason : report.skipped_scans) skipped += reason.second.count;
  EXPECT_EQ(skipped, 2U);
  EXPECT_EQ(report.skipped_scans.size(), 2U) << "two reasons";
  EXPECT_EQ(idsIn(folder.file("cleaned.pcd")), idsOf(classes, PointClass::kStatic));
}

TEST(OfflineCleaner, WithoutAUsableScanNothingIsLeftBehind) {
  SourceScan lost = test::sourceDrive(7)[0];
  lost.T_map_cloud.translation().x() = std::numeric_limits<double>::infinity();
  for (const std::vector<SourceScan>& scans : {std::vector<SourceScan>{}, {lost, lost}}) {
    const OutputFolder folder;
    MemorySource source(scans);
    EXPECT_THROW(run(source, into(folder)), InputError);
    EXPECT_TRUE(folder.names().empty());
  }
}

TEST(OfflineCleaner, ScansWithoutPointsMakeEmptyFiles) {
  const OutputFolder folder;
  MemorySource source({test::sourceScan(Scan(), 0), test::sourceScan(Scan(), 0)});
  const OfflineReport report = run(source, into(folder));
  EXPECT_EQ(report.scans, 2U);
  EXPECT_EQ(report.points, 0U);
  for (const char* name : {"cleaned.pcd", "dynamic.pcd"}) {
    EXPECT_EQ(readPcd(folder.file(name)).width, 0U) << name;
  }
}

TEST(OfflineCleaner, AFolderThatCannotBeMadeIsNamed) {
  const OutputFolder folder;
  std::ofstream(folder.file("file")) << "not a folder";
  OfflineOptions options;
  options.output = folder.file("file") + "/below";
  MemorySource source(test::sourceDrive(1));
  try {
    run(source, options);
    FAIL() << "nothing was thrown";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(options.output), std::string::npos);
  }
}

TEST(OfflineCleaner, MapsWithLargeCoordinatesAreWrittenInFloat64) {
  std::vector<SourceScan> scans = test::sourceDrive(8), moved = scans;
  const Eigen::Vector3d shift(500000.0, 5800000.0, 200.0);
  for (SourceScan& scan : moved) {
    scan.T_map_cloud.pretranslate(shift);
    scan.T_map_sensor.pretranslate(shift);
  }
  const OutputFolder folder, moved_folder;
  MemorySource source(scans), moved_source(moved);
  EXPECT_FALSE(run(source, into(folder)).float64_coordinates);
  EXPECT_TRUE(run(moved_source, into(moved_folder)).float64_coordinates);
  const pcl::PCLPointCloud2 here = readPcd(folder.file("cleaned.pcd"));
  const pcl::PCLPointCloud2 there = readPcd(moved_folder.file("cleaned.pcd"));
  ASSERT_EQ(here.width, there.width);
  const std::array<const char*, 3> axes{"x", "y", "z"};
  for (int axis = 0; axis < 3; ++axis) {
    const FieldReader a(here, axes[static_cast<std::size_t>(axis)]);
    const FieldReader b(there, axes[static_cast<std::size_t>(axis)]);
    EXPECT_EQ(b.datatype(), pcl::PCLPointField::FLOAT64);
    for (std::size_t i = 0; i < here.width; ++i) ASSERT_EQ(a(i) + shift[axis], b(i));
  }
}

TEST(OfflineCleaner, AVoxelKeepsItsFirstPoint) {
  const std::vector<SourceScan> scans = test::sourceDrive(9);
  const std::vector<PointClass> classes = classesOf(scans);
  OutputFolder folder;
  OfflineOptions options = into(folder);
  options.voxel_m = 0.5;
  MemorySource source(scans);
  run(source, options);
  for (const PointClass wanted : {PointClass::kStatic, PointClass::kDynamic}) {
    std::vector<std::uint32_t> expected;
    std::set<std::array<double, 3>> voxels;
    std::uint32_t next_id = 0;
    for (const SourceScan& scan : scans) {
      const FieldReader x(scan.cloud, "x"), y(scan.cloud, "y"), z(scan.cloud, "z");
      for (std::size_t i = 0; i < scan.cloud.width; ++i, ++next_id) {
        if (classes[next_id] != wanted) continue;
        const Eigen::Vector3d p = scan.T_map_cloud * Eigen::Vector3d(x(i), y(i), z(i)) / 0.5;
        if (voxels.insert({std::floor(p.x()), std::floor(p.y()), std::floor(p.z())}).second) {
          expected.push_back(next_id);
        }
      }
    }
    const char* name = wanted == PointClass::kStatic ? "cleaned.pcd" : "dynamic.pcd";
    EXPECT_EQ(idsIn(folder.file(name)), expected);
  }
}

}  // namespace
}  // namespace beautymap
