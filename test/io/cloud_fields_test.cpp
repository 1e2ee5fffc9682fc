// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/io/cloud_fields.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "io_test_helpers.h"

namespace beautymap {
namespace test {
namespace {

using Cloud = pcl::PCLPointCloud2;

Cloud xyzCloud() { return makeCloud({{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}); }

TEST(NormalizeCloud, LeavesACompactCloudAsItIs) {
  Cloud cloud = xyzCloud();
  EXPECT_EQ(normalizeCloud(cloud), std::nullopt);
  EXPECT_EQ(cloud.data, xyzCloud().data);
  EXPECT_EQ(cloud.width, 3U);
  EXPECT_EQ(cloud.height, 1U);
}

TEST(NormalizeCloud, RemovesRowPaddingOfOrganizedClouds) {
  // 2 rows of 2 points, 5 bytes of padding behind the first row and none behind the last.
  const Cloud flat = makeCloud({{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {10, 11, 12}});
  Cloud cloud = flat;
  cloud.width = cloud.height = 2;
  cloud.row_step = 2 * 16 + 5;
  cloud.data.insert(cloud.data.begin() + 32, 5, 0xEE);
  ASSERT_EQ(normalizeCloud(cloud), std::nullopt);
  EXPECT_EQ(cloud.data, flat.data);
  EXPECT_EQ(cloud.width, 4U);
  EXPECT_EQ(cloud.height, 1U);
  EXPECT_EQ(cloud.row_step, 64U);
}

TEST(NormalizeCloud, AcceptsRowStepZero) {
  Cloud cloud = xyzCloud();
  cloud.row_step = 0;
  EXPECT_EQ(normalizeCloud(cloud), std::nullopt);
}

TEST(NormalizeCloud, SwapsBigEndianFieldsOfEverySize) {
  CloudBuilder builder;
  builder.field("x", 7, 0).field("y", 7, 4).field("z", 8, 8).field("ring", 4, 16);
  builder.field("flag", 2, 18).field("array", 4, 20, 2).size(2, 24);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto value = static_cast<float>(i);
    builder.set(i, 0, value + 0.5F).set(i, 4, value + 1.5F).set(i, 8, value + 2.25);
    builder.set<std::uint16_t>(i, 16, 0x1234).set<std::uint8_t>(i, 18, 7);
    builder.set<std::uint16_t>(i, 20, 0xABCD).set<std::uint16_t>(i, 22, 0x0102);
  }
  const Cloud little = builder.build();
  Cloud big = little;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto at = big.data.begin() + static_cast<std::ptrdiff_t>(i * 24);
    for (const auto& [offset, size] :
         std::vector<std::pair<int, int>>{{0, 4}, {4, 4}, {8, 8}, {16, 2}, {20, 2}, {22, 2}}) {
      std::reverse(at + offset, at + offset + size);
    }
  }
  big.is_bigendian = true;
  ASSERT_EQ(normalizeCloud(big), std::nullopt);
  EXPECT_EQ(big.data, little.data);
  EXPECT_FALSE(big.is_bigendian);
}

TEST(NormalizeCloud, SwapsOverlappingFieldsOnce) {
  CloudBuilder builder;
  builder.field("x", 7, 0).field("y", 7, 4).field("z", 7, 8);
  builder.field("rgb", 7, 12).field("rgba", 6, 12).size(1, 16);
  builder.set<std::uint32_t>(0, 12, 0x04030201);
  Cloud cloud = builder.build();
  cloud.is_bigendian = true;
  ASSERT_EQ(normalizeCloud(cloud), std::nullopt);
  EXPECT_EQ(FieldReader(cloud, "rgba")(0), 0x01020304);
}

TEST(NormalizeCloud, TakesCountZeroOfOldDriversForOne) {
  Cloud cloud = xyzCloud();
  for (auto& field : cloud.fields) field.count = 0;
  ASSERT_EQ(normalizeCloud(cloud), std::nullopt);
  EXPECT_EQ(cloud.fields[0].count, 1U);
}

TEST(NormalizeCloud, AcceptsIntegerCoordinates) {
  CloudBuilder builder;
  builder.field("x", 3, 0).field("y", 3, 2).field("z", 3, 4).size(1, 6);
  builder.set<std::int16_t>(0, 0, -5).set<std::int16_t>(0, 2, 6).set<std::int16_t>(0, 4, 7);
  Cloud cloud = builder.build();
  ASSERT_EQ(normalizeCloud(cloud), std::nullopt);
  EXPECT_EQ(pointAt(cloud, 0), Eigen::Vector3d(-5, 6, 7));
}

TEST(NormalizeCloud, AcceptsACloudWithoutPoints) {
  Cloud cloud = makeCloud({});
  EXPECT_EQ(normalizeCloud(cloud), std::nullopt);
  EXPECT_EQ(pointCount(cloud), 0U);
  // Rows without points, with padding that would lie far behind the data.
  cloud.height = cloud.row_step = 0x80000000;
  EXPECT_EQ(normalizeCloud(cloud), std::nullopt);
  EXPECT_EQ(pointCount(cloud), 0U);
  EXPECT_EQ(cloud.height, 1U);
}

struct Hostile {
  const char* name;
  void (*spoil)(Cloud& cloud);
  const char* sentence;
};

class NormalizeHostileCloud : public testing::TestWithParam<Hostile> {};

TEST_P(NormalizeHostileCloud, SaysWhatIsWrong) {
  Cloud cloud = xyzCloud();
  GetParam().spoil(cloud);
  const auto wrong = normalizeCloud(cloud);
  ASSERT_TRUE(wrong.has_value());
  EXPECT_NE(wrong->find(GetParam().sentence), std::string::npos) << *wrong;
}

INSTANTIATE_TEST_SUITE_P(
    All, NormalizeHostileCloud,
    testing::Values(
        Hostile{"PointStepZero", [](Cloud& c) { c.point_step = 0; }, "point_step is 0"},
        Hostile{"DataTooShort", [](Cloud& c) { c.data.resize(c.data.size() - 1); }, "too few"},
        Hostile{"NoData", [](Cloud& c) { c.data.clear(); }, "too few"},
        Hostile{"RowsBeyondTheData",
                [](Cloud& c) {
                  c.height = 3;
                  c.width = 1;
                  c.row_step = 17;
                },
                "row_step"},
        Hostile{"RowStepBelowTheRow",
                [](Cloud& c) {
                  c.height = 3;
                  c.width = 1;
                  c.row_step = 15;
                },
                "too small"},
        Hostile{"HugeWidth", [](Cloud& c) { c.width = 0xFFFFFFFF; }, "too few"},
        Hostile{"WidthTimesHeightOverflows",
                [](Cloud& c) {
                  c.width = c.height = 0x80000000;  // 2^62 points; 2^66 bytes are 0 in 64 bits
                  c.row_step = 0;
                },
                "too few"},
        Hostile{"FieldBeyondThePoint", [](Cloud& c) { c.fields[2].offset = 13; }, "'z' reaches"},
        Hostile{"OffsetOverflows", [](Cloud& c) { c.fields[2].offset = 0xFFFFFFFE; },
                "'z' reaches"},
        Hostile{"CountOverflows", [](Cloud& c) { c.fields[3].count = 0xFFFFFFFF; },
                "'label' reaches"},
        Hostile{"NoZ", [](Cloud& c) { c.fields.erase(c.fields.begin() + 2); }, "no field 'z'"},
        Hostile{"NoFields", [](Cloud& c) { c.fields.clear(); }, "no field 'x'"},
        Hostile{"UnknownType", [](Cloud& c) { c.fields[0].datatype = 99; }, "unknown datatype 99"}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(FieldReader, ReadsEveryType) {
  CloudBuilder builder;
  builder.size(1, 64);
  builder.field("i8", 1, 0).field("u8", 2, 1).field("i16", 3, 2).field("u16", 4, 4);
  builder.field("i32", 5, 6).field("u32", 6, 10).field("f32", 7, 14).field("f64", 8, 18);
  builder.field("i64", 9, 26).field("u64", 10, 34).field("bool", 11, 42);
  builder.set<std::int8_t>(0, 0, -3).set<std::uint8_t>(0, 1, 250).set<std::int16_t>(0, 2, -30000);
  builder.set<std::uint16_t>(0, 4, 60000).set<std::int32_t>(0, 6, -2000000000);
  builder.set<std::uint32_t>(0, 10, 4000000000U).set(0, 14, 0.25F).set(0, 18, 1e300);
  builder.set<std::int64_t>(0, 26, -5).set<std::uint64_t>(0, 34, 1ULL << 60);
  builder.set<std::uint8_t>(0, 42, 1);
  const Cloud cloud = builder.build();
  const std::vector<std::pair<std::string, double>> expected = {
      {"i8", -3},           {"u8", 250},     {"i16", -30000}, {"u16", 60000},
      {"i32", -2000000000}, {"u32", 4e9},    {"f32", 0.25},   {"f64", 1e300},
      {"i64", -5},          {"u64", 0x1p60}, {"bool", 1}};
  for (const auto& [name, value] : expected) EXPECT_EQ(FieldReader(cloud, name)(0), value) << name;
}

TEST(FieldReader, RefusesAFieldThatIsNotThere) {
  EXPECT_NE(inputErrorOf([] { FieldReader(xyzCloud(), "time"); }).find("x y z label"),
            std::string::npos);
}

/// Odd offsets, gaps and fields of every size around float32 coordinates.
CloudBuilder oddCloud(std::uint32_t points) {
  CloudBuilder builder;
  builder.field("u8", 2, 1).field("y", 7, 3).field("u16", 4, 7).field("x", 7, 11);
  builder.field("f64", 8, 15).field("z", 7, 23).field("array", 4, 29, 3).size(points, 37);
  return builder;
}

TEST(MoveCloud, MovesPointsAndKeepsEveryOtherByteOfFloat32Clouds) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> coordinate(-50.0F, 50.0F);
  CloudBuilder builder = oddCloud(100);
  for (std::size_t i = 0; i < 100; ++i) {
    builder.set(i, 11, coordinate(random)).set(i, 3, coordinate(random));
    builder.set(i, 23, coordinate(random));
  }
  const Cloud cloud = builder.build();
  const Eigen::Isometry3d T = poseAt(10, -20, 3, 0.7);
  const Cloud moved = moveCloud(cloud, T, false);
  ASSERT_EQ(moved.point_step, cloud.point_step);
  ASSERT_EQ(moved.fields.size(), cloud.fields.size());
  for (std::size_t i = 0; i < 100; ++i) {
    const Eigen::Vector3d exact = T * pointAt(cloud, i);
    // Computed in double, rounded once: half a unit in the last place of coordinates below 128 m.
    EXPECT_LE((pointAt(moved, i) - exact).cwiseAbs().maxCoeff(), std::ldexp(1.0, 6 - 24));
  }
  Cloud others = moved;
  for (std::size_t i = 0; i < 100; ++i) {
    for (const std::size_t offset : {3, 11, 23}) {
      std::memcpy(others.data.data() + i * 37 + offset, cloud.data.data() + i * 37 + offset, 4);
    }
  }
  EXPECT_EQ(others.data, cloud.data);
}

TEST(MoveCloud, IdentityChangesNothing) {
  CloudBuilder builder = oddCloud(3);
  const std::uint32_t signalling_nan = 0x7FA00001;
  builder.set(1, 11, signalling_nan);
  const Cloud cloud = builder.build();
  EXPECT_EQ(moveCloud(cloud, Eigen::Isometry3d::Identity(), false).data, cloud.data);
}

TEST(MoveCloud, KeepsTheOrderOfTheFieldsWhenTheTypeChanges) {
  CloudBuilder builder = oddCloud(2);
  for (std::size_t i = 0; i < 2; ++i) {
    builder.set(i, 11, 1.5F).set(i, 3, 2.5F).set(i, 23, static_cast<float>(i));
  }
  const Cloud cloud = builder.build();
  const Eigen::Isometry3d T = poseAt(500000.123, 5400000.456, 100);
  const Cloud moved = moveCloud(cloud, T, true);
  EXPECT_EQ(fieldNames(moved), fieldNames(cloud));
  EXPECT_EQ(moved.point_step, 1U + 8 + 2 + 8 + 8 + 8 + 6);
  EXPECT_EQ(FieldReader(moved, "x").datatype(), 8);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(pointAt(moved, i), (T * pointAt(cloud, i)).eval());
    for (const char* name : {"u8", "u16", "f64", "array"}) {
      double before = FieldReader(cloud, name)(i);
      double after = FieldReader(moved, name)(i);
      EXPECT_EQ(std::memcmp(&before, &after, sizeof(before)), 0) << name;
    }
    EXPECT_EQ(std::memcmp(moved.data.data() + i * moved.point_step + 35,
                          cloud.data.data() + i * cloud.point_step + 29, 6),
              0);
  }
}

TEST(MoveCloud, TurnsIntegerCoordinatesIntoFloats) {
  CloudBuilder builder;
  builder.field("x", 3, 0).field("y", 3, 2).field("z", 3, 4).size(1, 6);
  builder.set<std::int16_t>(0, 0, 1).set<std::int16_t>(0, 2, 2).set<std::int16_t>(0, 4, 3);
  const Cloud moved = moveCloud(builder.build(), poseAt(0.5, 0, 0), false);
  EXPECT_EQ(FieldReader(moved, "x").datatype(), 7);
  EXPECT_EQ(pointAt(moved, 0), Eigen::Vector3d(1.5, 2, 3));
}

TEST(MoveCloud, KeepsPointsNonFinite) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  const Cloud cloud = makeCloud({{nan, 0, 0}, {1, infinity, 2}, {nan, nan, nan}});
  for (const bool as_float64 : {false, true}) {
    const Cloud moved = moveCloud(cloud, poseAt(1, 2, 3, 0.3), as_float64);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_FALSE(pointAt(moved, i).allFinite());
  }
}

}  // namespace
}  // namespace test
}  // namespace beautymap
