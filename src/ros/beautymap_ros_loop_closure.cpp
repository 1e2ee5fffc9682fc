// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
// How BeautyMapRos makes the map again when the poses are corrected.
#include <algorithm>
#include <cmath>

#include "beautymap/ros/beautymap_ros.h"
#include "io/tf_history.h"

namespace beautymap {

void BeautyMapRos::takePath(const nav_msgs::Path::ConstPtr& path) {
  if (rebuilding_) return;  // the next path comes soon enough
  const std::string frame = stripSlash(path->header.frame_id);
  {
    const std::lock_guard<std::mutex> lock(map_mutex_);
    if (!frame.empty() && !map_frame_.empty() && frame != map_frame_) {
      ROS_WARN_THROTTLE(kWarningPeriod,
                        "the corrected path is in the frame '%s', the map in '%s': not used",
                        frame.c_str(), map_frame_.c_str());
      return;
    }
  }
  StampedPoses corrected;
  for (const auto& stamped : path->poses) {
    const auto& p = stamped.pose.position;
    const auto& q = stamped.pose.orientation;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    const Eigen::Quaterniond rotation(q.w, q.x, q.y, q.z);
    if (!rotation.coeffs().allFinite() || std::abs(rotation.norm() - 1.0) > 0.1) continue;
    pose.linear() = rotation.normalized().toRotationMatrix();
    pose.translation() = Eigen::Vector3d(p.x, p.y, p.z);
    if (pose.matrix().allFinite()) corrected[stamped.header.stamp.toNSec()] = pose;
  }
  const PoseCorrection correction(
      log_->poses(), corrected, static_cast<std::uint64_t>(options_.loop_closure_tolerance * 1e9));
  if (correction.matched() == 0) {
    if (corrected.empty() || log_->size() == 0) return;
    ROS_WARN_THROTTLE(kWarningPeriod,
                      "no pose of the corrected path has the stamp of a scan (within "
                      "~loop_closure_tolerance)");
    return;
  }
  constexpr double kLever = 10.0;  // [m]
  if (std::max(correction.largestMove(), kLever * correction.largestTurn()) <=
      options_.loop_closure_min_move) {
    return;
  }
  stopRebuilding();
  rebuilding_ = true;
  stop_rebuilding_ = false;
  ROS_INFO("the corrected path moves scans by up to %.2f m: the map is made again",
           correction.largestMove());
  rebuild_thread_ = std::thread([this, correction] {
    try {
      rebuild(correction);
    } catch (const std::exception& error) {
      ROS_ERROR("the map could not be made again: %s", error.what());
    }
    rebuilding_ = false;
  });
}

void BeautyMapRos::rebuild(const PoseCorrection& correction) {
  log_->correct(correction);
  log_->rewind();
  const std::shared_ptr<OnlineCleaner> corrected = newCleaner();
  SourceScan scan;
  std::size_t scans = 0;
  const auto addNext = [&] {
    if (stop_rebuilding_ || !log_->next(scan)) return false;
    corrected->add(scan);
    corrected->finish(scan);
    ++scans;
    return true;
  };
  while (addNext()) {
  }
  // The last ones, which came meanwhile, while no further one is added to the present map.
  const std::lock_guard<std::mutex> processing(process_mutex_);
  while (addNext()) {
  }
  if (stop_rebuilding_) return;
  const std::lock_guard<std::mutex> lock(map_mutex_);
  cleaner_ = corrected;
  ROS_INFO("the map was made again from %zu scans", scans);
}

void BeautyMapRos::stopRebuilding() {
  stop_rebuilding_ = true;
  if (rebuild_thread_.joinable()) rebuild_thread_.join();
}

}  // namespace beautymap
