// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/io/pcd_stream.h"

#include <pcl/io/pcd_io.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <cstring>

#include "io_test_helpers.h"

namespace beautymap {
namespace test {
namespace {

using Cloud = pcl::PCLPointCloud2;

void writeAll(const std::string& path, const Cloud& cloud,
              const Eigen::Isometry3d& viewpoint = Eigen::Isometry3d::Identity()) {
  PcdStreamWriter writer(path, cloud, viewpoint);
  for (std::size_t i = 0; i < pointCount(cloud); ++i) {
    writer.append(cloud.data.data() + i * cloud.point_step);
  }
  writer.close();
}

/// A cloud with gaps, an array and fields of every size, filled with a pattern.
Cloud oddCloud(std::uint32_t points) {
  CloudBuilder builder;
  builder.field("x", 7, 0).field("y", 7, 4).field("z", 7, 8);
  builder.field("intensity", 7, 16).field("ring", 4, 20).field("label", 2, 25);
  builder.field("time", 8, 26).field("normal", 7, 36, 3).size(points, 50);
  return builder.build();
}

std::string valuesOf(const Cloud& cloud, std::size_t point) {
  std::string bytes;
  for (const auto& field : cloud.fields) {
    bytes.append(
        reinterpret_cast<const char*>(cloud.data.data()) + point * cloud.point_step + field.offset,
        fieldTypeSize(field.datatype) * field.count);
  }
  return bytes;
}

void expectSameValues(const Cloud& a, const Cloud& b) {
  ASSERT_EQ(pointCount(a), pointCount(b));
  ASSERT_EQ(fieldNames(a), fieldNames(b));
  for (std::size_t i = 0; i < pointCount(a); ++i) ASSERT_EQ(valuesOf(a, i), valuesOf(b, i)) << i;
}

TEST(PcdStreamWriter, KeepsEveryFieldBitExact) {
  const TempFolder folder;
  const Cloud cloud = oddCloud(1000);
  writeAll(folder / "a.pcd", cloud);
  const Cloud read = readPcd(folder / "a.pcd");
  EXPECT_EQ(read.point_step, 12U + 4 + 2 + 1 + 8 + 12);
  for (std::size_t i = 0; i < cloud.fields.size(); ++i) {
    EXPECT_EQ(read.fields[i].datatype, cloud.fields[i].datatype);
    EXPECT_EQ(read.fields[i].count, cloud.fields[i].count);
  }
  expectSameValues(cloud, read);
}

TEST(PcdStreamWriter, WritesWhatPclReads) {
  const TempFolder folder;
  const Cloud cloud = makeCloud({{1, 2, 3}, {4, 5, 6}}, 9);
  writeAll(folder / "a.pcd", cloud, poseAt(1, 2, 3, M_PI / 2));
  Cloud read;
  Eigen::Vector4f origin;
  Eigen::Quaternionf orientation;
  int version = 0;
  ASSERT_EQ(pcl::PCDReader().read(folder / "a.pcd", read, origin, orientation, version), 0);
  expectSameValues(cloud, read);
  EXPECT_TRUE(origin.head<3>().isApprox(Eigen::Vector3f(1, 2, 3)));
  EXPECT_NEAR(orientation.w(), std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(orientation.z(), std::sqrt(0.5), 1e-6);
}

TEST(PcdStreamWriter, KeepsUtmSizedViewpointsExact) {
  const TempFolder folder;
  const Eigen::Isometry3d pose = poseAt(691234.5678901234, 5335678.123456789, 519.1, 1.2);
  writeAll(folder / "a.pcd", makeCloud({{1, 2, 3}}), pose);
  const PcdHeader header = readPcdHeader(folder / "a.pcd");
  EXPECT_EQ(header.origin, Eigen::Vector3d(pose.translation()));
  EXPECT_EQ(header.orientation.coeffs(), Eigen::Quaterniond(pose.linear()).coeffs());
}

TEST(PcdStreamWriter, DropsFieldsOfUnknownType) {
  const TempFolder folder;
  Cloud cloud = makeCloud({{1, 2, 3}});
  cloud.fields[3].datatype = 77;
  writeAll(folder / "a.pcd", cloud);
  EXPECT_EQ(fieldNames(readPcd(folder / "a.pcd")), "x y z");
}

TEST(PcdStreamWriter, WritesAFileWithoutPoints) {
  const TempFolder folder;
  writeAll(folder / "a.pcd", makeCloud({}));
  EXPECT_EQ(pointCount(readPcd(folder / "a.pcd")), 0U);
}

TEST(PcdStreamWriter, LeavesTheTargetAloneUntilClosed) {
  const TempFolder folder;
  writeFile(folder / "a.pcd", "before");
  const Cloud cloud = makeCloud({{1, 2, 3}});
  {
    PcdStreamWriter writer(folder / "a.pcd", cloud);
    writer.append(cloud.data.data());
    EXPECT_EQ(writer.size(), 1U);
  }
  EXPECT_EQ(readFile(folder / "a.pcd"), "before");
  // Nothing else is left behind.
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 1);
}

TEST(PcdStreamWriter, SaysWhereItCannotWrite) {
  const TempFolder folder;
  const std::string path = folder / "no/such/folder/a.pcd";
  const std::string error = inputErrorOf([&] { PcdStreamWriter(path, makeCloud({{1, 2, 3}})); });
  EXPECT_NE(error.find(path), std::string::npos) << error;
  EXPECT_NE(error.find("No such file"), std::string::npos) << error;
}

TEST(PcdStreamWriter, ReportsAFullDisk) {
  const TempFolder folder;
  // A limit on the size of files behaves like a full disk, with another errno.
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{1 << 16, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string error = inputErrorOf([&] { writeAll(folder / "a.pcd", oddCloud(5000)); });
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_NE(error.find("File too large"), std::string::npos) << error;
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(PcdStreamWriter, AcceptsOnlyTheLayoutItWasMadeFor) {
  const TempFolder folder;
  const Cloud cloud = makeCloud({{1, 2, 3}});
  const PcdStreamWriter writer(folder / "a.pcd", cloud);
  EXPECT_TRUE(writer.accepts(makeCloud({{4, 5, 6}, {7, 8, 9}})));
  Cloud other = cloud;
  other.fields[3].name = "ring";
  EXPECT_FALSE(writer.accepts(other));
  other = cloud;
  other.fields[3].offset = 13;
  EXPECT_FALSE(writer.accepts(other));
  other = cloud;
  other.point_step = 20;
  EXPECT_FALSE(writer.accepts(other));
}

TEST(PcdStreamWriter, ManyPointsAtOnceAreTheSameAsOneByOne) {
  const TempFolder folder;
  const Cloud packed = makeCloud({{1.5F, 2, 3}, {4, 5, 6}, {7, 8, 9.25F}}, 3);
  // Of more bytes than are gathered before they are written.
  Cloud large = packed;
  large.width = 100'000;
  large.data.resize(large.width * large.point_step);
  std::iota(large.data.begin(), large.data.end(), std::uint8_t{0});
  for (const Cloud& cloud : {oddCloud(200'000), packed, large}) {
    writeAll(folder / "one_by_one.pcd", cloud);
    PcdStreamWriter writer(folder / "at_once.pcd", cloud);
    writer.append(cloud.data.data(), 1);
    writer.append(cloud.data.data() + cloud.point_step, 0);
    writer.append(cloud.data.data() + cloud.point_step, pointCount(cloud) - 1);
    writer.close();
    EXPECT_EQ(readFile(folder / "at_once.pcd"), readFile(folder / "one_by_one.pcd"));
  }
}

TEST(ReadPcdBlocks, GivesAllPointsInOrderInBlocks) {
  const TempFolder folder;
  const Cloud cloud = oddCloud(10);
  writeAll(folder / "a.pcd", cloud);
  std::vector<std::size_t> sizes;
  std::size_t first = 0;
  readPcdBlocks(
      folder / "a.pcd",
      [&](const Cloud& block) {
        sizes.push_back(pointCount(block));
        for (std::size_t i = 0; i < pointCount(block); ++i) {
          EXPECT_EQ(valuesOf(block, i), valuesOf(cloud, first + i));
        }
        first += pointCount(block);
      },
      4);
  EXPECT_EQ(sizes, (std::vector<std::size_t>{4, 4, 2}));
}

TEST(ReadPcdBlocks, RangesThatFollowEachOtherGiveAllPointsOnce) {
  const TempFolder folder;
  const Cloud cloud = oddCloud(10);
  writeAll(folder / "binary.pcd", cloud);
  pcl::PCDWriter().writeASCII(folder / "ascii.pcd", readPcd(folder / "binary.pcd"));
  for (const char* name : {"binary.pcd", "ascii.pcd"}) {
    SCOPED_TRACE(name);
    const Cloud whole = readPcd(folder / name);
    std::size_t next = 0;
    for (const PcdRange range : {PcdRange{0, 3}, PcdRange{3, 3}, PcdRange{3, 8}, PcdRange{8, 99}}) {
      const auto compare = [&](const Cloud& block) {
        for (std::size_t i = 0; i < pointCount(block); ++i) {
          EXPECT_EQ(valuesOf(block, i), valuesOf(whole, next++));
        }
      };
      readPcdBlocks(folder / name, compare, 2, range);
      EXPECT_EQ(next, std::min<std::size_t>(range.end, 10));
    }
  }
}

TEST(ReadPcdBlocks, ReadsAsciiAndCompressedFiles) {
  const TempFolder folder;
  const Cloud cloud = makeCloud({{1.5F, 2, 3}, {4, 5, 6}, {7, 8, 9.25F}}, 3);
  pcl::PCDWriter writer;
  writer.writeASCII(folder / "ascii.pcd", cloud);
  writer.writeBinaryCompressed(folder / "compressed.pcd", cloud);
  writer.writeBinary(folder / "binary.pcd", cloud);
  for (const char* name : {"ascii.pcd", "compressed.pcd", "binary.pcd"}) {
    SCOPED_TRACE(name);
    expectSameValues(readPcd(folder / name), cloud);
    std::size_t blocks = 0;
    readPcdBlocks(
        folder / name, [&](const Cloud&) { ++blocks; }, 2);
    EXPECT_EQ(blocks, 2U);
  }
}

const char* const kHeader =
    "# .PCD v0.7\r\nVERSION 0.7\r\nFIELDS x y z _\r\nSIZE 4 4 4 1\r\nTYPE F F F U\r\n"
    "COUNT 1 1 1 4\r\nWIDTH 1\r\nHEIGHT 1\r\nVIEWPOINT 0 0 0 1 0 0 0\r\nPOINTS 1\r\nDATA binary\n";

TEST(ReadPcd, SkipsPaddingAndCarriageReturns) {
  const TempFolder folder;
  writeFile(folder / "a.pcd", kHeader + std::string(16, '\0'));
  const Cloud cloud = readPcd(folder / "a.pcd");
  EXPECT_EQ(fieldNames(cloud), "x y z");
  EXPECT_EQ(cloud.point_step, 16U);
}

TEST(ReadPcd, ReadsEveryTypeFromAscii) {
  const TempFolder folder;
  writeFile(folder / "a.pcd",
            "FIELDS x _ y z i8 u8 i16 big n\nSIZE 4 4 8 4 1 1 2 8 4\nTYPE F F F F I U I U F\n"
            "COUNT 1 2 1 1 1 1 1 1 2\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA ascii\n"
            "1.5 9 9 2.25 nan -3 250 -30000 18446744073709551615 7 8\r\n\n"
            "  -1e3\t9 9 1e300 inf 3 0 30000 1 -7 -8");
  const Cloud cloud = readPcd(folder / "a.pcd");
  ASSERT_EQ(pointCount(cloud), 2U);
  const auto value = [&](const char* name, std::size_t i) { return FieldReader(cloud, name)(i); };
  EXPECT_EQ(value("x", 0), 1.5);
  EXPECT_EQ(value("y", 0), 2.25);
  EXPECT_TRUE(std::isnan(value("z", 0)));
  EXPECT_EQ(value("i8", 0), -3);
  EXPECT_EQ(value("u8", 0), 250);
  EXPECT_EQ(value("i16", 0), -30000);
  EXPECT_EQ(value("big", 0), 18446744073709551615.0);
  EXPECT_EQ(value("n", 0), 7);
  EXPECT_EQ(value("x", 1), -1000);
  EXPECT_EQ(value("y", 1), 1e300);
  EXPECT_TRUE(std::isinf(value("z", 1)));
  EXPECT_EQ(value("n", 1), -7);
}

struct Broken {
  const char* name;
  std::string content;
  const char* sentence;
};

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  return text.replace(text.find(what), what.size(), with);
}

class ReadBrokenPcd : public testing::TestWithParam<Broken> {};

TEST_P(ReadBrokenPcd, SaysWhatIsWrong) {
  const TempFolder folder;
  writeFile(folder / "a.pcd", GetParam().content);
  const std::string error = inputErrorOf([&] { readPcd(folder / "a.pcd"); });
  EXPECT_NE(error.find(GetParam().sentence), std::string::npos) << error;
  EXPECT_NE(error.find("a.pcd"), std::string::npos) << error;
}

INSTANTIATE_TEST_SUITE_P(
    All, ReadBrokenPcd,
    testing::Values(
        Broken{"Empty", "", "not a PCD file"}, Broken{"Text", "hello\nworld\n", "not a PCD file"},
        Broken{"Zeros", std::string(5000, '\0'), "not a PCD file"},
        Broken{"Truncated", kHeader + std::string(15, 'x'), "truncated"},
        Broken{"HugePoints",
               replaced(replaced(kHeader, "POINTS 1", "POINTS 4611686018427387904"), "WIDTH 1",
                        "WIDTH 4611686018427387904"),
               "truncated"},
        Broken{"HugeAscii",
               replaced(replaced(replaced(kHeader, "POINTS 1", "POINTS 4000000000"), "WIDTH 1",
                                 "WIDTH 4000000000"),
                        "DATA binary", "DATA ascii"),
               "truncated"},
        Broken{"HugeCompressed",
               replaced(replaced(replaced(kHeader, "POINTS 1", "POINTS 4000000000"), "WIDTH 1",
                                 "WIDTH 4000000000"),
                        "DATA binary", "DATA binary_compressed"),
               "truncated"},
        Broken{"BrokenCompressed",
               replaced(kHeader, "DATA binary", "DATA binary_compressed") + std::string(40, '\x7F'),
               "as many as the header promises"},
        Broken{"DamagedCompressed",
               replaced(kHeader, "DATA binary", "DATA binary_compressed") +
                   std::string("\x04\0\0\0\x0C\0\0\0\xFF\xFF\xFF\xFF", 12),
               "cannot be decompressed"},
        Broken{"TruncatedCompressed",
               replaced(kHeader, "DATA binary", "DATA binary_compressed") +
                   std::string("\x09\0\0\0\x0C\0\0\0\xFF\xFF\xFF\xFF", 12),
               "9 bytes of compressed points are promised, 4 are there"},
        Broken{"AsciiWithoutANumber",
               replaced(kHeader, "DATA binary", "DATA ascii") + "1 2 three 0 0 0 0\n",
               "point 0 does not have a number"},
        Broken{"AsciiWithAShortLine", replaced(kHeader, "DATA binary", "DATA ascii") + "1 2\n    ",
               "point 0 does not have a number"},
        Broken{"AsciiWithoutALine", replaced(kHeader, "DATA binary", "DATA ascii") + "       \n",
               "there are 0"},
        Broken{"NegativeWidth", replaced(kHeader, "WIDTH 1", "WIDTH -1"), "WIDTH"},
        Broken{"WidthIsNotPoints", replaced(kHeader, "WIDTH 1", "WIDTH 2"), "is not POINTS"},
        Broken{"FieldsDiffer", replaced(kHeader, "SIZE 4 4 4 1", "SIZE 4 4 4"), "differ in length"},
        Broken{"HugeCount", replaced(kHeader, "COUNT 1 1 1 4", "COUNT 1 1 1 99999999999"),
               "impossible size"},
        Broken{"UnknownType", replaced(kHeader, "SIZE 4 4 4 1", "SIZE 4 4 3 1"), "unknown type"},
        Broken{"UnknownEncoding", replaced(kHeader, "DATA binary", "DATA zip"), "'zip'"},
        Broken{"NoZ", replaced(kHeader, "FIELDS x y z", "FIELDS x y w") + std::string(16, '\0'),
               "no field 'z'"},
        Broken{"ShortViewpoint", replaced(kHeader, "0 0 0 1 0 0 0", "0 0 0"), "VIEWPOINT"}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(ReadPcd, NamesAFileThatDoesNotExist) {
  EXPECT_NE(inputErrorOf([] { readPcd("/no/such.pcd"); }).find("/no/such.pcd"), std::string::npos);
}

}  // namespace
}  // namespace test
}  // namespace beautymap
