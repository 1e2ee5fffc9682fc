// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/online/point_store.h"

#include <gtest/gtest.h>

#include <set>

#include "io/io_test_helpers.h"
#include "test_scenes.h"

namespace beautymap {
namespace {

const Eigen::Isometry3d kAtOrigin = Eigen::Isometry3d::Identity();

TEST(VoxelSet, HoldsEachKeyOnce) {
  test::Random random(3);
  VoxelSet voxels;
  std::set<std::uint64_t> oracle;
  for (int i = 0; i < 20000; ++i) {
    const std::uint64_t key = random.bits() >> random.integer(40, 60);
    EXPECT_EQ(voxels.insert(key), oracle.insert(key).second);
  }
  EXPECT_EQ(voxels.size(), oracle.size());
  const auto keys = voxels.keys();
  EXPECT_EQ(std::set<std::uint64_t>(keys.begin(), keys.end()), oracle);
}

TEST(PointStore, KeepsEveryRecordInTheTileOfItsColumn) {
  const std::vector<Eigen::Vector3f> points{
      {0.1F, 0.2F, 1.0F}, {-0.1F, 0.2F, 2.0F}, {0.1F, 0.2F, 1.0F}};
  const auto cloud = test::makeCloud(points, 7);
  PointStore store(0.5, 0.0);
  const PlacedScan placed =
      test::placedScan({0, 0}, {0, 0, 0}, {{0.1, 0.2, 1.0}, {-0.1, 0.2, 2.0}, {0.1, 0.2, 1.0}});
  EXPECT_EQ(store.add(placed, cloud, kAtOrigin, false), 3U);
  ASSERT_NE(store.findTile({0, 0}), nullptr);
  ASSERT_NE(store.findTile({-1, 0}), nullptr);
  pcl::PCLPointCloud2 kept = store.layout();
  kept.data = store.findTile({0, 0})->records;
  kept.width = 2;
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(test::pointAt(kept, i), points[0].cast<double>());
    EXPECT_EQ(FieldReader(kept, "label")(i), 7.0);
  }
  EXPECT_EQ(store.findTile({0, 0})->size(), 2U);
  EXPECT_EQ(store.findTile({-1, 0})->z[0], 2.0F);
}

TEST(PointStore, KeepsTheFirstPointOfEachVoxelWhereverTheSensorIs) {
  test::Random random(5);
  PointStore store(0.5, 0.25);
  std::set<std::tuple<double, double, double>> voxels;
  for (int scan = 0; scan < 5; ++scan) {
    const ColumnIndex anchor{random.integer(-30, 30), random.integer(-30, 30)};
    std::vector<Eigen::Vector3d> points;
    std::vector<Eigen::Vector3f> floats;
    for (int i = 0; i < 400; ++i) {
      points.emplace_back(test::dyadic(random.uniform(-2, 2)), test::dyadic(random.uniform(-2, 2)),
                          test::dyadic(random.uniform(-2, 2)));
      floats.push_back(points.back().cast<float>());
      voxels.emplace(std::floor((anchor.x * 0.5 + points.back().x()) / 0.25),
                     std::floor((anchor.y * 0.5 + points.back().y()) / 0.25),
                     std::floor(points.back().z() / 0.25));
    }
    store.add(test::placedScan(anchor, {0, 0, 0}, points), test::makeCloud(floats), kAtOrigin,
              false);
  }
  EXPECT_EQ(store.size(), voxels.size());
}

TEST(PointStore, AnotherSensorsFieldsAreMatchedByName) {
  PointStore store(0.5, 0.0);
  store.add(test::placedScan({0, 0}, {0, 0, 0}, {{1, 1, 1}}), test::makeCloud({{1, 1, 1}}, 9),
            kAtOrigin, false);
  // y and x swapped, no label, another field.
  test::CloudBuilder builder;
  builder.field("y", 7, 0).field("x", 7, 4).field("z", 7, 8).field("ring", 4, 12).size(1, 14);
  builder.set(0, 0, 2.0F).set(0, 4, 3.0F).set(0, 8, 4.0F);
  store.add(test::placedScan({0, 0}, {0, 0, 0}, {{3, 2, 4}}), builder.build(), kAtOrigin, false);
  pcl::PCLPointCloud2 cloud = store.layout();
  cloud.data = store.findTile({0, 0})->records;
  cloud.width = 2;
  EXPECT_EQ(test::pointAt(cloud, 1), Eigen::Vector3d(3, 2, 4));
  EXPECT_EQ(FieldReader(cloud, "label")(0), 9.0);
  EXPECT_EQ(FieldReader(cloud, "label")(1), 0.0);
}

}  // namespace
}  // namespace beautymap
