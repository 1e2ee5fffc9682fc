// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "beautymap/io/scan_source.h"
#include "test_scenes.h"

namespace beautymap::test {

/// A folder that is removed with everything in it.
class OutputFolder {
 public:
  OutputFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "beautymap_test_XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~OutputFolder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
  }
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  std::string path() const { return path_; }
  std::string file(const std::string& name) const { return path_ + "/" + name; }
  std::set<std::string> names() const {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path_)) {
      names.insert(entry.path().filename().string());
    }
    return names;
  }

 private:
  std::string path_;
};

inline std::string bytesOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

inline pcl::PCLPointField pointField(const std::string& name, std::uint8_t datatype,
                                     std::uint32_t offset) {
  pcl::PCLPointField field;
  field.name = name;
  field.datatype = datatype;
  field.offset = offset;
  field.count = 1;
  return field;
}

/// A point as the test's clouds hold it: 28 bytes, of which two are padding.
struct TestPoint {
  float x, y, z;
  std::uint16_t ring;
  std::uint32_t id;     ///< different for every point of a drive
  std::uint32_t label;  ///< 1: moving
};

inline pcl::PCLPointCloud2 cloudOf(const std::vector<TestPoint>& points, bool with_label) {
  pcl::PCLPointCloud2 cloud;
  cloud.fields = {pointField("x", pcl::PCLPointField::FLOAT32, 0),
                  pointField("y", pcl::PCLPointField::FLOAT32, 4),
                  pointField("z", pcl::PCLPointField::FLOAT32, 8),
                  pointField("ring", pcl::PCLPointField::UINT16, 12),
                  pointField("id", pcl::PCLPointField::UINT32, 16)};
  if (with_label) cloud.fields.push_back(pointField("label", pcl::PCLPointField::UINT32, 20));
  cloud.height = 1;
  cloud.width = static_cast<std::uint32_t>(points.size());
  cloud.point_step = 28;
  cloud.row_step = cloud.width * cloud.point_step;
  cloud.data.assign(cloud.row_step, 0xAB);
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::uint8_t* record = cloud.data.data() + i * cloud.point_step;
    std::memcpy(record, &points[i].x, 4);
    std::memcpy(record + 4, &points[i].y, 4);
    std::memcpy(record + 8, &points[i].z, 4);
    std::memcpy(record + 12, &points[i].ring, 2);
    std::memcpy(record + 16, &points[i].id, 4);
    if (with_label) std::memcpy(record + 20, &points[i].label, 4);
  }
  return cloud;
}

/// A core scan as a source would deliver it; ids count on from `first_id`.
inline SourceScan sourceScan(const Scan& scan, std::uint32_t first_id, bool with_label = true) {
  std::vector<TestPoint> points;
  for (const pcl::PointXYZ& p : scan.cloud) {
    const auto id = first_id + static_cast<std::uint32_t>(points.size());
    points.push_back(
        {p.x, p.y, p.z, static_cast<std::uint16_t>(id * 7919), id, id % 3 == 0 ? 1U : 0U});
  }
  SourceScan source;
  source.cloud = cloudOf(points, with_label);
  source.T_map_cloud = scan.T_map_cloud;
  source.T_map_sensor.translation() = scan.sensor_in_map;
  source.stamp_ns = 1000000000ULL + first_id;
  return source;
}

inline std::vector<SourceScan> sourceDrive(std::uint32_t seed, bool with_label = true) {
  std::vector<SourceScan> drive;
  std::uint32_t id = 0;
  for (const Scan& scan : randomDrive(seed)) {
    drive.push_back(sourceScan(scan, id, with_label));
    id += drive.back().cloud.width;
  }
  return drive;
}

/// Scans from memory, which counts how often it is read.
class MemorySource : public ScanSource {
 public:
  explicit MemorySource(std::vector<SourceScan> scans) : scans_(std::move(scans)) {}
  bool next(SourceScan& scan) override {
    ++reads_;
    if (next_ == scans_.size()) return false;
    scan = scans_[next_++];
    return true;
  }
  void rewind() override { next_ = 0; }
  std::size_t size() const override { return scans_.size(); }
  std::vector<std::string> describe() const override { return {"from memory"}; }
  std::size_t reads() const { return reads_; }

 private:
  std::vector<SourceScan> scans_;
  std::size_t next_ = 0;
  std::size_t reads_ = 0;
};

/// Writes each scan in a thread of its own.
/// @return their places in the spool's file
template <typename Spool, typename ScanType>
std::vector<std::int64_t> writeInThreads(Spool& spool, const std::vector<ScanType>& scans) {
  std::vector<std::int64_t> places(scans.size());
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    threads.emplace_back([&, i] { places[i] = spool.write(scans[i]); });
  }
  for (std::thread& thread : threads) thread.join();
  return places;
}

}  // namespace beautymap::test
