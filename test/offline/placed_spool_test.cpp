// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/io/placed_spool.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "beautymap/io/scan_source.h"
#include "offline/offline_test_helpers.h"

namespace beautymap {
namespace {

/// Scans with and without dropped points, and one without points.
std::vector<PlacedScan> placedScans() {
  std::vector<Scan> scans = test::randomDrive(3);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  scans[1].cloud[7].x = nan;
  scans.emplace_back();
  scans.push_back(scans[0]);
  std::vector<PlacedScan> placed;
  DroppedPoints dropped;
  for (const Scan& scan : scans) {
    placed.push_back(placeScan(scan, 0.5, 0.5, ScanConfig(), dropped));
    placed.back().steepest_slope = 0.1F * static_cast<float>(placed.size());
  }
  return placed;
}

void expectEqualHeights(const PlacedScan& a, const PlacedScan& b) {
  EXPECT_EQ(a.anchor, b.anchor);
  EXPECT_EQ(a.sensor, b.sensor);
  EXPECT_EQ(a.cloud_size, b.cloud_size);
  EXPECT_EQ(a.z, b.z);
  EXPECT_EQ(a.steepest_slope, b.steepest_slope);
  ASSERT_EQ(a.isWhole(), b.isWhole());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a.sourceOf(i), b.sourceOf(i));
  ASSERT_EQ(a.runs.size(), b.runs.size());
  for (std::size_t i = 0; i < a.runs.size(); ++i) {
    const ColumnRun &p = a.runs[i], &q = b.runs[i];
    EXPECT_TRUE(p.x == q.x && p.y == q.y && p.begin == q.begin && p.end == q.end);
    EXPECT_TRUE(p.lowest == q.lowest && p.highest == q.highest);
  }
}

TEST(PlacedSpool, ScansComeBackAsTheyWereAsOftenAsWanted) {
  const std::vector<PlacedScan> scans = placedScans();
  const test::OutputFolder folder;
  PlacedSpool spool(folder.path());
  for (const PlacedScan& scan : scans) spool.add(spool.write(scan));
  EXPECT_EQ(spool.size(), scans.size());
  PlacedScan read;  // its memory is used again
  for (int pass = 0; pass < 3; ++pass) {
    spool.rewind();
    for (const PlacedScan& scan : scans) {
      ASSERT_TRUE(spool.next(read));
      expectEqualHeights(read, scan);
      EXPECT_EQ(read.x, scan.x);
      EXPECT_EQ(read.y, scan.y);
    }
    EXPECT_FALSE(spool.next(read));
    EXPECT_FALSE(spool.next(read));
  }
}

TEST(PlacedSpool, ScansComeBackInTheOrderInWhichTheyAreAdded) {
  const std::vector<PlacedScan> scans = placedScans();
  const test::OutputFolder folder;
  PlacedSpool spool(folder.path());
  const std::vector<std::int64_t> places = test::writeInThreads(spool, scans);
  // One that is not added is not in the spool.
  for (std::size_t i = 1; i < scans.size(); ++i) spool.add(places[i]);
  EXPECT_EQ(spool.size(), scans.size() - 1);
  PlacedScan read;
  for (std::size_t i = 1; i < scans.size(); ++i) {
    ASSERT_TRUE(spool.next(read));
    expectEqualHeights(read, scans[i]);
    EXPECT_EQ(read.x, scans[i].x);
  }
  EXPECT_FALSE(spool.next(read));
}

TEST(PlacedSpool, WithoutXAndYTheRestComesBack) {
  const std::vector<PlacedScan> scans = placedScans();
  const test::OutputFolder folder;
  PlacedSpool spool(folder.path());
  for (const PlacedScan& scan : scans) spool.add(spool.write(scan));
  PlacedScan read;
  spool.rewind();
  for (const PlacedScan& scan : scans) {
    ASSERT_TRUE(spool.next(read, PlacedSpool::Part::kHeights));
    expectEqualHeights(read, scan);
  }
  EXPECT_FALSE(spool.next(read, PlacedSpool::Part::kHeights));
}

TEST(PlacedSpool, XAndYNeedNotBeKept) {
  const std::vector<PlacedScan> scans = placedScans();
  const test::OutputFolder folder;
  PlacedSpool spool(folder.path(), PlacedSpool::Part::kHeights);
  for (const PlacedScan& scan : scans) spool.add(spool.write(scan));
  PlacedScan read;
  for (const PlacedScan& scan : scans) {
    ASSERT_TRUE(spool.next(read));
    expectEqualHeights(read, scan);
  }
  EXPECT_FALSE(spool.next(read));
}

TEST(PlacedSpool, LeavesNoFile) {
  const test::OutputFolder folder;
  PlacedSpool spool(folder.path());
  for (const PlacedScan& scan : placedScans()) spool.add(spool.write(scan));
  EXPECT_TRUE(folder.names().empty()) << "the file has no name, also while it is used";
}

TEST(PlacedSpool, NamesTheFolderInWhichNoFileCanBeMade) {
  try {
    PlacedSpool spool("/does/not/exist");
    FAIL() << "nothing was thrown";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("/does/not/exist"), std::string::npos);
  }
}

}  // namespace
}  // namespace beautymap
