// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/online/scan_log.h"

namespace beautymap {

bool ScanLog::append(const SourceScan& scan) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!spool_.accepts(scan)) return false;
  spool_.append(scan);
  poses_[scan.stamp_ns] = scan.T_map_sensor;
  moves_.push_back(Eigen::Isometry3d::Identity());
  stamps_.push_back(scan.stamp_ns);
  return true;
}

void ScanLog::rewind() {
  const std::lock_guard<std::mutex> lock(mutex_);
  spool_.rewind();
  read_ = 0;
}

bool ScanLog::next(SourceScan& scan) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!spool_.next(scan)) return false;
  const Eigen::Isometry3d& move = moves_[read_++];
  scan.T_map_cloud = move * scan.T_map_cloud;
  scan.T_map_sensor = move * scan.T_map_sensor;
  return true;
}

StampedPoses ScanLog::poses() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return poses_;
}

void ScanLog::correct(const PoseCorrection& correction) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (std::size_t i = 0; i < moves_.size(); ++i) {
    moves_[i] = correction.at(stamps_[i]) * moves_[i];
  }
  for (auto& pose : poses_) pose.second = correction.at(pose.first) * pose.second;
}

std::size_t ScanLog::size() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return spool_.size();
}

}  // namespace beautymap
