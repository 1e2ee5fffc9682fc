// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/io/placed_spool.h"

#include <vector>

namespace beautymap {
namespace {

/// What precedes the arrays of a scan in the file.
struct Record {
  std::uint64_t cloud_size, points, runs;
  ColumnIndex anchor;
  float sensor[3];
  float steepest_slope;
};

}  // namespace

std::int64_t PlacedSpool::write(const PlacedScan& scan) {
  const Eigen::Vector3f& sensor = scan.sensor;
  const Record record{scan.cloud_size,
                      scan.size(),
                      scan.runs.size(),
                      scan.anchor,
                      {sensor.x(), sensor.y(), sensor.z()},
                      scan.steepest_slope};
  const bool has_xy = kept_ == Part::kAll;
  const std::size_t indices = scan.isWhole() ? 0 : scan.size() * sizeof(scan.source_index[0]);
  const std::int64_t place =
      file_.reserve(sizeof(record) + scan.runs.size() * sizeof(scan.runs[0]) +
                    (has_xy ? 3 : 1) * scan.size() * sizeof(scan.z[0]) + indices);
  std::int64_t offset = place;
  file_.write(offset, &record, sizeof(record));
  file_.write(offset, scan.runs);
  file_.write(offset, scan.z);
  if (!scan.isWhole()) file_.write(offset, scan.source_index);
  if (has_xy) {
    file_.write(offset, scan.x);
    file_.write(offset, scan.y);
  }
  return place;
}

bool PlacedSpool::next(PlacedScan& scan, Part part) {
  if (read_ == places_.size()) return false;
  std::int64_t offset = places_[read_++];
  Record record;
  file_.read(offset, &record, sizeof(record));
  scan.cloud_size = record.cloud_size;
  scan.anchor = record.anchor;
  scan.sensor = {record.sensor[0], record.sensor[1], record.sensor[2]};
  scan.steepest_slope = record.steepest_slope;
  const auto readArray = [&](auto& values, std::size_t size) {
    values.resize(size);
    file_.read(offset, values);
  };
  readArray(scan.runs, record.runs);
  readArray(scan.z, record.points);
  readArray(scan.source_index, scan.isWhole() ? 0 : record.points);
  if (kept_ == Part::kAll && part == Part::kAll) {
    readArray(scan.x, record.points);
    readArray(scan.y, record.points);
  }
  return true;
}

}  // namespace beautymap
