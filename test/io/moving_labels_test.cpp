// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/io/moving_labels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "beautymap/io/cloud_fields.h"
#include "beautymap/io/pcd_stream.h"
#include "beautymap/io/scan_sink.h"
#include "io_test_helpers.h"

namespace beautymap {
namespace test {
namespace {

namespace fs = std::filesystem;

/// Points in a row with these labels, as a field of the type that holds T.
template <typename T>
pcl::PCLPointCloud2 cloudWithLabels(const std::vector<T>& labels, std::uint8_t datatype) {
  CloudBuilder builder;
  builder.field("x", 7, 0).field("y", 7, 4).field("z", 7, 8).field("label", datatype, 12);
  builder.size(static_cast<std::uint32_t>(labels.size()), 20);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    builder.set(i, 0, 1.0F + static_cast<float>(i)).set(i, 4, 2.0F).set(i, 8, 3.0F);
    builder.set(i, 12, labels[i]);
  }
  return builder.build();
}

class MovingLabels : public testing::Test {
 protected:
  MovingLabels() { fs::create_directories(fs::path(folder_ / "in/pcd")); }
  void write(const pcl::PCLPointCloud2& cloud) {
    PcdStreamWriter writer(folder_ / "in/pcd/000000.pcd", cloud, Eigen::Isometry3d::Identity());
    for (std::size_t i = 0; i < pointCount(cloud); ++i) {
      writer.append(cloud.data.data() + i * cloud.point_step);
    }
    writer.close();
  }
  std::unique_ptr<ScanSource> open() { return openScanSource({folder_ / "in"}, options_); }
  std::vector<PointLabel> labels() {
    const auto source = open();
    return labelsOf(readAll(*source).at(0).cloud, *source);
  }
  TempFolder folder_;
  SourceOptions options_;
};

constexpr PointLabel kStatic = PointLabel::kStatic, kMoving = PointLabel::kMoving,
                     kIgnored = PointLabel::kIgnored;

TEST_F(MovingLabels, OnlyOneMovesAndOtherValuesAreIgnored) {
  write(cloudWithLabels<std::uint8_t>({0, 1, 2, 255, 0}, 2));
  EXPECT_EQ(labels(), (std::vector<PointLabel>{kStatic, kMoving, kIgnored, kIgnored, kStatic}));
}

TEST_F(MovingLabels, WhatMovesCanBeTold) {
  options_.moving_labels = {2, 3};
  write(cloudWithLabels<float>({0, 1, 2, 3, 4}, 7));
  EXPECT_EQ(labels(), (std::vector<PointLabel>{kStatic, kIgnored, kMoving, kMoving, kIgnored}));
  options_.moving_labels = {1, 0};
  EXPECT_NE(inputErrorOf([&] { open(); }).find("0, which means static"), std::string::npos);
}

TEST_F(MovingLabels, PointsWithoutAPositionAreIgnored) {
  auto cloud = cloudWithLabels<std::uint8_t>({1, 1, 0, 0}, 2);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(cloud.data.data() + 4, &nan, sizeof(nan));
  std::memset(cloud.data.data() + 2 * cloud.point_step, 0, 12);
  write(cloud);
  EXPECT_EQ(labels(), (std::vector<PointLabel>{kIgnored, kMoving, kIgnored, kStatic}));
}

TEST_F(MovingLabels, ConvertedInputsSayTheSameWithoutTheOption) {
  for (const bool floats : {false, true}) {
    write(floats ? cloudWithLabels<float>({0, 1, 2, 3}, 7)
                 : cloudWithLabels<std::uint16_t>({0, 1, 2, 3}, 4));
    options_.moving_labels = {2};
    const auto source = open();
    const std::string out = folder_ / (floats ? "floats" : "integers");
    const auto sink = openScanSink(out, {}, *source);
    for (const SourceScan& scan : readAll(*source)) sink->write(scan);
    sink->close();
    const auto converted = openScanSource({out}, {});
    EXPECT_EQ(labelsOf(readAll(*converted).at(0).cloud, *converted),
              (std::vector<PointLabel>{kStatic, kIgnored, kMoving, kIgnored}));
    // Without the ignored points.
    const auto truth = readPcd(out + "/gt_cloud.pcd");
    ASSERT_EQ(pointCount(truth), 2U);
    EXPECT_EQ(FieldReader(truth, "intensity")(0), 0.0);
    EXPECT_EQ(FieldReader(truth, "intensity")(1), 1.0);
  }
}

}  // namespace
}  // namespace test
}  // namespace beautymap
