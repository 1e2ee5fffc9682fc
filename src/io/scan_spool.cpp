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
  return size_ == 0 || sameFields(scan.cloud, layout_);
}

void ScanSpool::append(const SourceScan& scan) {
  if (size_ == 0) {
    layout_ = scan.cloud;
    layout_.data.clear();
    layout_.width = 0;
  }
  Record record{scan.stamp_ns, scan.cloud.width, {}, {}};
  std::memcpy(record.T_map_cloud, scan.T_map_cloud.data(), sizeof(record.T_map_cloud));
  std::memcpy(record.T_map_sensor, scan.T_map_sensor.data(), sizeof(record.T_map_sensor));
  file_.append(&record, sizeof(record));
  file_.append(scan.cloud.data);
  ++size_;
}

void ScanSpool::rewind() {
  read_offset_ = 0;
  read_ = 0;
}

bool ScanSpool::next(SourceScan& scan) {
  if (read_ == size_) return false;
  Record record;
  file_.read(read_offset_, &record, sizeof(record));
  std::vector<std::uint8_t> buffer = std::move(scan.cloud.data);
  scan.cloud = layout_;
  scan.cloud.data = std::move(buffer);
  scan.cloud.data.resize(record.points * layout_.point_step);
  scan.cloud.width = static_cast<std::uint32_t>(record.points);
  scan.cloud.row_step = scan.cloud.width * layout_.point_step;
  scan.stamp_ns = record.stamp_ns;
  std::memcpy(scan.T_map_cloud.data(), record.T_map_cloud, sizeof(record.T_map_cloud));
  std::memcpy(scan.T_map_sensor.data(), record.T_map_sensor, sizeof(record.T_map_sensor));
  file_.read(read_offset_, scan.cloud.data);
  ++read_;
  return true;
}

}  // namespace beautymap
