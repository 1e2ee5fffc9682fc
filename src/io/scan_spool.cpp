// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/io/scan_spool.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
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

int openUnnamed(const std::string& folder) {
#ifdef O_TMPFILE
  const int unnamed = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (unnamed >= 0) return unnamed;
#endif
  std::string name = folder + "/.beautymap-spool-XXXXXX";
  const int named = ::mkstemp(&name[0]);
  if (named >= 0) ::unlink(name.c_str());
  return named;
}

}  // namespace

ScanSpool::ScanSpool(const std::string& folder) : folder_(folder) {
  const int descriptor = openUnnamed(folder);
  if (descriptor >= 0) file_.reset(::fdopen(descriptor, "w+b"));
  if (!file_) {
    throw InputError("cannot make a temporary file in '" + folder + "': " + std::strerror(errno));
  }
  std::setvbuf(file_.get(), nullptr, _IONBF, 0);  // whole scans are large enough
}

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
  const std::vector<std::uint8_t>& data = scan.cloud.data;
  // Scans may be appended while others are read.
  if (::fseeko(file_.get(), 0, SEEK_END) != 0 ||
      std::fwrite(&record, sizeof(record), 1, file_.get()) != 1 ||
      std::fwrite(data.data(), 1, data.size(), file_.get()) != data.size()) {
    throw InputError("cannot keep the scans in a temporary file in '" + folder_ +
                     "': " + std::strerror(errno));
  }
  ++size_;
}

void ScanSpool::rewind() {
  read_offset_ = 0;
  read_ = 0;
}

bool ScanSpool::next(SourceScan& scan) {
  if (read_ == size_) return false;
  Record record;
  if (::fseeko(file_.get(), read_offset_, SEEK_SET) != 0 ||
      std::fread(&record, sizeof(record), 1, file_.get()) != 1) {
    throw InputError("cannot read back the temporary file in '" + folder_ + "'");
  }
  std::vector<std::uint8_t> buffer = std::move(scan.cloud.data);
  scan.cloud = layout_;
  scan.cloud.data = std::move(buffer);
  scan.cloud.data.resize(record.points * layout_.point_step);
  scan.cloud.width = static_cast<std::uint32_t>(record.points);
  scan.cloud.row_step = scan.cloud.width * layout_.point_step;
  scan.stamp_ns = record.stamp_ns;
  std::memcpy(scan.T_map_cloud.data(), record.T_map_cloud, sizeof(record.T_map_cloud));
  std::memcpy(scan.T_map_sensor.data(), record.T_map_sensor, sizeof(record.T_map_sensor));
  if (std::fread(scan.cloud.data.data(), 1, scan.cloud.data.size(), file_.get()) !=
      scan.cloud.data.size()) {
    throw InputError("cannot read back the temporary file in '" + folder_ + "'");
  }
  read_offset_ += static_cast<std::int64_t>(sizeof(record) + scan.cloud.data.size());
  ++read_;
  return true;
}

}  // namespace beautymap
