// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/io/scan_sink.h"

#include "beautymap/io/pcd_stream.h"
#include "io_test_helpers.h"

namespace beautymap {
namespace test {
namespace {

/// Scans from memory.
class MemorySource : public ScanSource {
 public:
  std::vector<SourceScan> scans;
  bool is_semantic = false;

  bool next(SourceScan& scan) override {
    if (next_ == scans.size()) return false;
    scan = scans[next_++];
    return true;
  }
  void rewind() override { next_ = 0; }
  std::size_t size() const override { return scans.size(); }
  std::vector<std::string> describe() const override { return {}; }
  bool isMoving(std::uint32_t label) const override {
    return is_semantic ? label >= 252 : label > 0;
  }

 private:
  std::size_t next_ = 0;
};

void convert(ScanSource& source, const std::string& path, const SinkOptions& options = {}) {
  const auto sink = openScanSink(path, options, source);
  SourceScan scan;
  while (source.next(scan)) sink->write(scan);
  sink->close();
}

void convert(const std::string& from, const std::string& to) {
  const auto source = openScanSource({from}, {});
  convert(*source, to);
}

/// Float32 coordinates with gaps, and fields of many types.
pcl::PCLPointCloud2 richCloud() {
  CloudBuilder builder;
  builder.field("x", 7, 0).field("y", 7, 4).field("z", 7, 8).field("intensity", 7, 16);
  builder.field("ring", 4, 20).field("time", 8, 22).field("label", 2, 31).size(3, 32);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto value = static_cast<float>(i);
    builder.set(i, 0, value + 1.0F).set(i, 4, value * 0.5F).set(i, 8, -value);
    builder.set(i, 31, static_cast<std::uint8_t>(i == 1));
  }
  return builder.build();
}

SourceScan makeScan(const pcl::PCLPointCloud2& cloud, const Eigen::Isometry3d& pose,
                    std::uint64_t stamp_ns = 0) {
  SourceScan scan;
  scan.cloud = cloud;
  scan.T_map_cloud = scan.T_map_sensor = pose;
  scan.stamp_ns = stamp_ns;
  return scan;
}

std::string valueBytes(const pcl::PCLPointCloud2& cloud, std::size_t point,
                       const std::string& name) {
  for (const auto& field : cloud.fields) {
    if (field.name != name) continue;
    return {
        reinterpret_cast<const char*>(cloud.data.data()) + point * cloud.point_step + field.offset,
        fieldTypeSize(field.datatype) * field.count};
  }
  return "no field " + name;
}

class Sink : public testing::Test {
 protected:
  Sink() {
    source_.scans = {makeScan(richCloud(), poseAt(10, 0, 1, 0.5), 5'000'000'123),
                     makeScan(richCloud(), poseAt(12, 0, 1, 0.6), 5'100'000'456)};
  }
  TempFolder folder_;
  MemorySource source_;
};

TEST_F(Sink, WritesTheBenchmarksLayout) {
  convert(source_, folder_ / "out");
  const auto cloud = readPcd(folder_ / "out/pcd/000001.pcd");
  const auto header = readPcdHeader(folder_ / "out/pcd/000001.pcd");
  EXPECT_EQ(fieldNames(cloud), "x y z intensity ring time label");
  EXPECT_EQ(header.origin, Eigen::Vector3d(12, 0, 1));
  EXPECT_TRUE(Eigen::Isometry3d(header.orientation)
                  .isApprox(Eigen::Isometry3d(poseAt(0, 0, 0, 0.6)), 1e-12));
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d expected = poseAt(12, 0, 1, 0.6) * pointAt(richCloud(), i);
    EXPECT_TRUE(pointAt(cloud, i).isApprox(expected, 1e-6));
    for (const char* name : {"intensity", "ring", "time", "label"}) {
      EXPECT_EQ(valueBytes(cloud, i, name), valueBytes(richCloud(), i, name)) << name;
    }
  }
}

TEST_F(Sink, WritesTheGroundTruthOfAllScansInOrder) {
  convert(source_, folder_ / "out/");
  const auto truth = readPcd(folder_ / "out/gt_cloud.pcd");
  EXPECT_EQ(fieldNames(truth), "x y z intensity");
  ASSERT_EQ(pointCount(truth), 6U);
  const FieldReader intensity(truth, "intensity");
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(intensity(i), i % 3 == 1 ? 1.0 : 0.0);
    const std::string scan = folder_ / ("out/pcd/00000" + std::to_string(i / 3) + ".pcd");
    EXPECT_EQ(pointAt(truth, i), pointAt(readPcd(scan), i % 3));
  }
}

TEST_F(Sink, WritesNoGroundTruthWithoutLabels) {
  for (auto& scan : source_.scans) scan.cloud.fields.pop_back();
  convert(source_, folder_ / "out");
  EXPECT_FALSE(fs::exists(folder_ / "out/gt_cloud.pcd"));
}

TEST_F(Sink, WritesFloat64WhereFloat32IsTooCoarse) {
  for (auto& scan : source_.scans) {
    scan.T_map_cloud = scan.T_map_sensor = poseAt(691234.123, 5335678.456, 500);
  }
  convert(source_, folder_ / "out");
  for (const char* name : {"out/pcd/000000.pcd", "out/gt_cloud.pcd"}) {
    const auto cloud = readPcd(folder_ / name);
    EXPECT_EQ(FieldReader(cloud, "x").datatype(), 8);
    EXPECT_NEAR(pointAt(cloud, 1).y(), 5335678.456 + 0.5, 1e-6);
  }
}

TEST_F(Sink, WritesScansInTheSensorFrameWithTheirPosesToBags) {
  SinkOptions options;
  options.cloud_topic = "/velodyne_points";
  options.map_frame = "world";
  options.sensor_frame = "velodyne";
  convert(source_, folder_ / "out.bag", options);
  const auto source = openScanSource({folder_ / "out.bag"}, {});
  const auto scans = readAll(*source);
  ASSERT_EQ(scans.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(scans[i].cloud.data, source_.scans[i].cloud.data);
    EXPECT_EQ(scans[i].stamp_ns, source_.scans[i].stamp_ns);
    EXPECT_TRUE(scans[i].T_map_cloud.isApprox(source_.scans[i].T_map_cloud, 1e-12));
  }
  SourceOptions by_odometry;
  by_odometry.odom_topic = "/odom";
  const auto again = readAll(*openScanSource({folder_ / "out.bag"}, by_odometry));
  ASSERT_EQ(again.size(), 2U);
  EXPECT_TRUE(again[1].T_map_cloud.isApprox(scans[1].T_map_cloud, 1e-12));
}

TEST_F(Sink, MovesRegisteredCloudsIntoTheSensorFrameOfABag) {
  SourceScan& scan = source_.scans[0];
  scan.T_map_cloud.setIdentity();
  convert(source_, folder_ / "out.bag");
  const auto scans = readAll(*openScanSource({folder_ / "out.bag"}, {}));
  ASSERT_EQ(scans.size(), 2U);
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d in_map = scans[0].T_map_cloud * pointAt(scans[0].cloud, i);
    // Rounded to float32 at about 10 m from the sensor.
    EXPECT_LT((in_map - pointAt(richCloud(), i)).norm(), 2e-6);
    EXPECT_EQ(valueBytes(scans[0].cloud, i, "time"), valueBytes(richCloud(), i, "time"));
  }
}

TEST_F(Sink, InventsStampsForScansWithoutTime) {
  for (auto& scan : source_.scans) scan.stamp_ns = 0;
  convert(source_, folder_ / "out.bag");
  const auto scans = readAll(*openScanSource({folder_ / "out.bag"}, {}));
  ASSERT_EQ(scans.size(), 2U);
  EXPECT_EQ(scans[0].stamp_ns, 1'000'000'000U);
  EXPECT_EQ(scans[1].stamp_ns, 1'100'000'000U);
}

TEST_F(Sink, WritesClassesThatDoNotMoveAsLabelZero) {
  source_.is_semantic = true;
  for (auto& scan : source_.scans) {
    CloudBuilder builder;
    builder.field("x", 7, 0).field("y", 7, 4).field("z", 7, 8).field("label", 6, 12).size(2, 16);
    for (std::size_t i = 0; i < 2; ++i) {
      builder.set(i, 0, 1.0F).set(i, 4, 2.0F).set(i, 8, 3.0F);
      builder.set<std::uint32_t>(i, 12, i == 0 ? 40 : 253);
    }
    scan.cloud = builder.build();
  }
  convert(source_, folder_ / "out");
  source_.rewind();
  convert(source_, folder_ / "out.bag");
  for (const char* name : {"out", "out.bag"}) {
    const auto scans = readAll(*openScanSource({folder_ / name}, {}));
    ASSERT_EQ(scans.size(), 2U);
    EXPECT_EQ(FieldReader(scans[0].cloud, "label")(0), 0);
    EXPECT_EQ(FieldReader(scans[0].cloud, "label")(1), 1);
  }
  EXPECT_EQ(FieldReader(readPcd(folder_ / "out/gt_cloud.pcd"), "intensity")(0), 0.0);
  EXPECT_EQ(FieldReader(readPcd(folder_ / "out/gt_cloud.pcd"), "intensity")(1), 1.0);
}

TEST_F(Sink, KeepsTheBitsOf64BitIntegersInBags) {
  CloudBuilder builder;
  builder.field("x", 7, 0).field("y", 7, 4).field("z", 7, 8).field("id", 10, 12).size(1, 20);
  builder.set<std::uint64_t>(0, 12, 0x0102030405060708);
  source_.scans = {makeScan(builder.build(), poseAt(1, 0, 0), 1'000'000'000)};
  convert(source_, folder_ / "out.bag");
  const auto scans = readAll(*openScanSource({folder_ / "out.bag"}, {}));
  ASSERT_EQ(scans.size(), 1U);
  EXPECT_EQ(valueBytes(scans[0].cloud, 0, "id"), valueBytes(builder.build(), 0, "id"));
}

TEST_F(Sink, BringsScansBackAfterARoundTrip) {
  convert(source_, folder_ / "a.bag");
  convert(folder_ / "a.bag", folder_ / "b");
  convert(folder_ / "b", folder_ / "c.bag");
  const auto before = readAll(*openScanSource({folder_ / "a.bag"}, {}));
  const auto after = readAll(*openScanSource({folder_ / "c.bag"}, {}));
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t s = 0; s < after.size(); ++s) {
    EXPECT_TRUE(after[s].T_map_sensor.isApprox(before[s].T_map_sensor, 1e-9));
    for (std::size_t i = 0; i < 3; ++i) {
      // Twice rounded to float32 at about 12 m from the origin.
      EXPECT_LT((pointAt(after[s].cloud, i) - pointAt(before[s].cloud, i)).norm(), 5e-6);
      for (const char* name : {"intensity", "ring", "time", "label"}) {
        EXPECT_EQ(valueBytes(after[s].cloud, i, name), valueBytes(before[s].cloud, i, name));
      }
    }
  }
}

TEST_F(Sink, RefusesToOverwriteAFolderThatIsNotEmpty) {
  writeFile(folder_ / "out/precious.txt", "x");
  const std::string error = inputErrorOf([&] { convert(source_, folder_ / "out"); });
  EXPECT_NE(error.find("not an empty folder"), std::string::npos) << error;
  EXPECT_EQ(readFile(folder_ / "out/precious.txt"), "x");
  fs::create_directories(folder_ / "empty");
  convert(source_, folder_ / "empty");
  EXPECT_TRUE(fs::exists(folder_ / "empty/pcd/000001.pcd"));
}

TEST_F(Sink, LeavesNothingBehindWithoutClose) {
  for (const char* name : {"out", "out.bag"}) {
    {
      const auto sink = openScanSink(folder_ / name, {}, source_);
      sink->write(source_.scans[0]);
    }
    EXPECT_TRUE(fs::is_empty(folder_.path())) << name;
  }
}

TEST_F(Sink, SaysWhereItCannotWrite) {
  const std::string error =
      inputErrorOf([&] { convert(source_, folder_ / "no/such/folder/x.bag"); });
  EXPECT_NE(error.find("no/such/folder/x.bag"), std::string::npos) << error;
  writeFile(folder_ / "file", "x");
  EXPECT_NE(inputErrorOf([&] { convert(source_, folder_ / "file/out"); }), "");
}

}  // namespace
}  // namespace test
}  // namespace beautymap
