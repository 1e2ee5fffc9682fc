// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/io/scan_spool.h"

#include <gtest/gtest.h>

#include <vector>

#include "offline/offline_test_helpers.h"

namespace beautymap {
namespace {

void expectEqual(const SourceScan& a, const SourceScan& b) {
  EXPECT_EQ(a.cloud.data, b.cloud.data);
  EXPECT_EQ(a.cloud.width, b.cloud.width);
  EXPECT_EQ(a.cloud.height, b.cloud.height);
  EXPECT_EQ(a.cloud.point_step, b.cloud.point_step);
  EXPECT_EQ(a.cloud.row_step, b.cloud.row_step);
  ASSERT_EQ(a.cloud.fields.size(), b.cloud.fields.size());
  for (std::size_t i = 0; i < a.cloud.fields.size(); ++i) {
    EXPECT_EQ(a.cloud.fields[i].name, b.cloud.fields[i].name);
    EXPECT_EQ(a.cloud.fields[i].offset, b.cloud.fields[i].offset);
    EXPECT_EQ(a.cloud.fields[i].datatype, b.cloud.fields[i].datatype);
  }
  EXPECT_EQ(a.stamp_ns, b.stamp_ns);
  EXPECT_EQ(a.T_map_cloud.matrix(), b.T_map_cloud.matrix());
  EXPECT_EQ(a.T_map_sensor.matrix(), b.T_map_sensor.matrix());
}

TEST(ScanSpool, ScansComeBackAsTheyWereAsOftenAsWanted) {
  std::vector<SourceScan> scans = test::sourceDrive(1);
  scans.push_back(test::sourceScan(Scan(), 9));  // without points
  scans.push_back(scans[0]);
  const test::OutputFolder folder;
  ScanSpool spool(folder.path());
  for (const SourceScan& scan : scans) spool.append(scan);
  EXPECT_EQ(spool.size(), scans.size());
  SourceScan read;  // its buffers are used again
  for (int pass = 0; pass < 3; ++pass) {
    spool.rewind();
    for (const SourceScan& scan : scans) {
      ASSERT_TRUE(spool.next(read));
      expectEqual(read, scan);
    }
    EXPECT_FALSE(spool.next(read));
    EXPECT_FALSE(spool.next(read));
  }
}

TEST(ScanSpool, ScansComeBackInTheOrderInWhichTheyAreAdded) {
  const std::vector<SourceScan> scans = test::sourceDrive(4);
  const test::OutputFolder folder;
  ScanSpool spool(folder.path());
  const std::vector<std::int64_t> places = test::writeInThreads(spool, scans);
  // One that is not added is not in the spool.
  for (std::size_t i = 1; i < scans.size(); ++i) spool.add(scans[i], places[i]);
  EXPECT_EQ(spool.size(), scans.size() - 1);
  SourceScan read;
  for (std::size_t i = 1; i < scans.size(); ++i) {
    ASSERT_TRUE(spool.next(read));
    expectEqual(read, scans[i]);
  }
  EXPECT_FALSE(spool.next(read));
}

TEST(ScanSpool, ReadingMayStopInTheMiddle) {
  const std::vector<SourceScan> scans = test::sourceDrive(2);
  const test::OutputFolder folder;
  ScanSpool spool(folder.path());
  for (const SourceScan& scan : scans) spool.append(scan);
  SourceScan read;
  spool.rewind();
  ASSERT_TRUE(spool.next(read));
  spool.rewind();
  ASSERT_TRUE(spool.next(read));
  expectEqual(read, scans[0]);
}

TEST(ScanSpool, AnEmptySpoolHasNoScan) {
  const test::OutputFolder folder;
  ScanSpool spool(folder.path());
  SourceScan read;
  spool.rewind();
  EXPECT_FALSE(spool.next(read));
}

TEST(ScanSpool, TakesOnlyScansWithTheFieldsOfTheFirst) {
  const test::OutputFolder folder;
  ScanSpool spool(folder.path());
  const SourceScan labelled = test::sourceDrive(1, true)[0];
  const SourceScan plain = test::sourceDrive(1, false)[0];
  EXPECT_TRUE(spool.accepts(labelled));
  EXPECT_TRUE(spool.accepts(plain));
  spool.append(plain);
  EXPECT_FALSE(spool.accepts(labelled));
  EXPECT_TRUE(spool.accepts(plain));
  SourceScan other = plain;
  other.cloud.fields[3].name = "row";
  EXPECT_FALSE(spool.accepts(other));
  other = plain;
  other.cloud.fields[3].datatype = pcl::PCLPointField::INT16;
  EXPECT_FALSE(spool.accepts(other));
  other = plain;
  other.cloud.fields[3].offset = 14;
  EXPECT_FALSE(spool.accepts(other));
  other = plain;
  other.cloud.point_step = 32;
  EXPECT_FALSE(spool.accepts(other));
}

TEST(ScanSpool, LeavesNoFile) {
  const test::OutputFolder folder;
  {
    ScanSpool spool(folder.path());
    for (const SourceScan& scan : test::sourceDrive(3)) spool.append(scan);
    EXPECT_TRUE(folder.names().empty()) << "the file has no name, also while it is used";
  }
  EXPECT_TRUE(folder.names().empty());
}

TEST(ScanSpool, NamesTheFolderInWhichNoFileCanBeMade) {
  try {
    ScanSpool spool("/does/not/exist");
    FAIL() << "nothing was thrown";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("/does/not/exist"), std::string::npos);
  }
}

}  // namespace
}  // namespace beautymap
