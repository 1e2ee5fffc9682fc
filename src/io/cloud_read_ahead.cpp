// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "cloud_read_ahead.h"

#include <algorithm>
#include <thread>
#include <utility>

namespace beautymap {
namespace {

// Messages of one stretch. A chunk of a bag (some clouds) that two stretches share is decompressed
// twice; long stretches take memory.
constexpr std::size_t kStretch = 8;

}  // namespace

RecordedCloud readCloud(const rosbag::MessageInstance& message) {
  RecordedCloud read{message.getTime(), nullptr, ""};
  try {
    read.cloud = message.instantiate<sensor_msgs::PointCloud2>();
  } catch (const std::exception& error) {
    read.error = error.what();
  }
  return read;
}

CloudReadAhead::CloudReadAhead(const RosbagFiles& files, const RosbagFiles::Query& query,
                               const ros::Time& begin, const ros::Time& end, std::size_t stride)
    : stride_(stride),
      readers_(files.areBz2() ? std::max(1U, std::thread::hardware_concurrency()) : 1),
      stretch_(files.areBz2() ? kStretch : 1),
      policy_(files.areBz2() ? std::launch::async : std::launch::deferred) {
  for (Reader& reader : readers_) {
    if (&reader != &readers_.front()) reader.files = std::make_unique<RosbagFiles>(files.paths());
    reader.view = (reader.files ? *reader.files : files).view(query, begin, end);
    reader.at = reader.view->begin();
  }
}

CloudReadAhead::Clouds CloudReadAhead::read(Reader& reader, std::size_t stretch) const {
  Clouds clouds;
  const auto end = reader.view->end();
  const std::size_t last = (stretch + 1) * stretch_ * stride_;
  for (; reader.at != end && reader.position < last; ++reader.at, ++reader.position) {
    if (reader.position < stretch * stretch_ * stride_ || reader.position % stride_ != 0) continue;
    clouds.push_back(readCloud(*reader.at));
  }
  return clouds;
}

void CloudReadAhead::start() {
  Reader& reader = readers_[next_stretch_ % readers_.size()];
  const std::size_t stretch = next_stretch_++;
  stretches_.push_back(
      std::async(policy_, [this, &reader, stretch] { return read(reader, stretch); }));
}

bool CloudReadAhead::next(RecordedCloud& cloud) {
  if (clouds_.empty()) {
    while (stretches_.size() < readers_.size()) start();
    clouds_ = stretches_.front().get();
    stretches_.pop_front();
    if (clouds_.empty()) return false;
    start();
  }
  cloud = std::move(clouds_.front());
  clouds_.pop_front();
  return true;
}

void CloudReadAhead::rewind() {
  stretches_.clear();
  clouds_.clear();
  next_stretch_ = 0;
  for (Reader& reader : readers_) {
    reader.at = reader.view->begin();
    reader.position = 0;
  }
}

}  // namespace beautymap
