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
};

}  // namespace

void PlacedSpool::append(const PlacedScan& scan) {
  const Eigen::Vector3f& sensor = scan.sensor;
  const Record record{scan.cloud_size,
                      scan.size(),
                      scan.runs.size(),
                      scan.anchor,
                      {sensor.x(), sensor.y(), sensor.z()}};
  file_.append(&record, sizeof(record));
  file_.append(scan.runs);
  file_.append(scan.z);
  if (!scan.isWhole()) file_.append(scan.source_index);
  file_.append(scan.x);
  file_.append(scan.y);
  ++size_;
}

void PlacedSpool::rewind() {
  read_offset_ = 0;
  read_ = 0;
}

bool PlacedSpool::next(PlacedScan& scan, Part part) {
  if (read_ == size_) return false;
  Record record;
  file_.read(read_offset_, &record, sizeof(record));
  scan.cloud_size = record.cloud_size;
  scan.anchor = record.anchor;
  scan.sensor = {record.sensor[0], record.sensor[1], record.sensor[2]};
  const auto readArray = [&](auto& values, std::size_t size) {
    values.resize(size);
    file_.read(read_offset_, values);
  };
  readArray(scan.runs, record.runs);
  readArray(scan.z, record.points);
  readArray(scan.source_index, scan.isWhole() ? 0 : record.points);
  if (part == Part::kAll) {
    readArray(scan.x, record.points);
    readArray(scan.y, record.points);
  } else {
    read_offset_ += static_cast<std::int64_t>(2 * record.points * sizeof(scan.x[0]));
  }
  ++read_;
  return true;
}

}  // namespace beautymap
