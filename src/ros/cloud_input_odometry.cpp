// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
// The input whose poses come as odometry messages.
#include <tf2_eigen/tf2_eigen.h>

#include <utility>

#include "beautymap/ros/cloud_input.h"
#include "io/odometry_history.h"
#include "io/tf_history.h"

namespace beautymap {
namespace {

constexpr double kWarningPeriod = 5.0;  // [s]
const ros::Duration kMemory(30.0);

}  // namespace

void CloudInput::receiveOdometry(const nav_msgs::Odometry::ConstPtr& message) {
  checkTime();
  const std::string frame = stripSlash(message->header.frame_id);
  if (odometry_->size() > 0 && frame != odometry_->mapFrame()) {
    ROS_WARN_THROTTLE(kWarningPeriod,
                      "odometry in the frame '%s' is left out: the map is in '%s' (reset to begin "
                      "another one)",
                      frame.c_str(), odometry_->mapFrame().c_str());
    return;
  }
  odometry_->insert(*message);
  if (message->header.stamp > ros::Time(60.0)) {
    odometry_->forgetBefore((message->header.stamp - kMemory).toNSec());
  }
  deliverWithOdometry();
}

void CloudInput::deliverWithOdometry() {
  odometry_->finish();
  std::string why;
  while (!waiting_.empty()) {
    auto posed = poseFromOdometry(waiting_.front(), why);
    if (!posed) return;
    posed->received = takeReceived(posed->message.get());
    waiting_.pop_front();
    listener_.cloud(std::move(*posed));
  }
}

Eigen::Isometry3d CloudInput::fromChild(const std::string& frame) const {
  const std::string& child = odometry_->childFrame();
  // A frame that tf does not connect is taken for the odometry's own child frame.
  if (frame.empty() || frame == child || child.empty() ||
      !buffer_.canTransform(child, frame, ros::Time(0))) {
    return Eigen::Isometry3d::Identity();
  }
  return Eigen::Isometry3d(
      tf2::transformToEigen(buffer_.lookupTransform(child, frame, ros::Time(0))));
}

std::optional<PosedCloud> CloudInput::poseFromOdometry(const Cloud::ConstPtr& cloud,
                                                       std::string& why) {
  const auto T_map_child = odometry_->lookup(cloud->header.stamp.toNSec(), why);
  if (!T_map_child) return std::nullopt;
  const std::string frame = stripSlash(cloud->header.frame_id);
  const bool is_registered = frame == odometry_->mapFrame();
  PosedCloud posed{cloud, odometry_->mapFrame(), Eigen::Isometry3d::Identity(),
                   Eigen::Isometry3d::Identity(), Clock::now()};
  if (!is_registered) posed.T_map_cloud = *T_map_child * fromChild(frame);
  posed.T_map_sensor = is_registered || !options_.sensor_frame.empty()
                           ? *T_map_child * fromChild(options_.sensor_frame)
                           : posed.T_map_cloud;
  return posed;
}

}  // namespace beautymap
