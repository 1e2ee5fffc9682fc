// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/io/scan_spool.h"

#include <cstring>
#include <utility>
#include <vector>

namespace beautymap {
namespace {

/// What precedes the points of a scan in the file.
struct Record {
  std::uint64_t stamp_ns;
  std::uint64_t points;
  double T_map_cloud[16];
  double T_map_sensor[16];
};

bool sameFields(const pcl::PCLPointCloud2& a, const pcl::PCLPointCloud2& b) {
  if (a.point_step != b.point_step || a.fields.size() != b.fields.size()) return false;
  for (std::size_t i = 0; i < a.fields.size(); ++i) {
    const pcl::PCLPointField &f = a.fields[i], &g = b.fields[i];
    if (f.name != g.name || f.offset != g.offset || f.datatype != g.datatype ||
        f.count != g.count) {
      return false;
    }
  }
  return true;
}

}  // namespace

bool ScanSpool::accepts(const SourceScan& scan) const {
  return places_.empty() || sameFields(scan.cloud, layout_);
}

std::int64_t ScanSpool::write(const SourceScan& scan) {
  Record record{scan.stamp_ns, scan.cloud.width, {}, {}};
  std::memcpy(record.T_map_cloud, scan.T_map_cloud.data(), sizeof(record.T_map_cloud));
  std::memcpy(record.T_map_sensor, scan.T_map_sensor.data(), sizeof(record.T_map_sensor));
  const std::int64_t place = file_.reserve(sizeof(record) + scan.cloud.data.size());
  std::int64_t offset = place;
  file_.write(offset, &record, sizeof(record));
  file_.write(offset, scan.cloud.data);
  return place;
}

void ScanSpool::add(const SourceScan& scan, std::int64_t place) {
  if (places_.empty()) {
    layout_ = scan.cloud;
    layout_.data.clear();
    layout_.width = 0;
  }
  places_.push_back(place);
}

void ScanSpool::rewind() { read_ = 0; }

bool ScanSpool::next(SourceScan& scan) {
  if (read_ == places_.size()) return false;
  std::int64_t offset = places_[read_++];
  Record record;
  file_.read(offset, &record, sizeof(record));
  std::vector<std::uint8_t> buffer = std::move(scan.cloud.data);
  scan.cloud = layout_;
  scan.cloud.data = std::move(buffer);
  scan.cloud.data.resize(record.points * layout_.point_step);
  scan.cloud.width = static_cast<std::uint32_t>(record.points);
  scan.cloud.row_step = scan.cloud.width * layout_.point_step;
  scan.stamp_ns = record.stamp_ns;
  std::memcpy(scan.T_map_cloud.data(), record.T_map_cloud, sizeof(record.T_map_cloud));
  std::memcpy(scan.T_map_sensor.data(), record.T_map_sensor, sizeof(record.T_map_sensor));
  file_.read(offset, scan.cloud.data);
  return true;
}

}  // namespace beautymap
