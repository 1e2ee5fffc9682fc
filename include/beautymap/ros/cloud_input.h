// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/message_filter.h>
#include <tf2_ros/transform_listener.h>

#include <Eigen/Geometry>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "beautymap/ros/node_options.h"

namespace beautymap {

class OdometryHistory;

/// A cloud and where it was taken.
struct PosedCloud {
  sensor_msgs::PointCloud2ConstPtr message;
  std::string map_frame;
  Eigen::Isometry3d T_map_cloud;
  Eigen::Isometry3d T_map_sensor;
  std::chrono::steady_clock::time_point received;
};

/// Receives clouds and finds their poses: waits for tf at their stamps, or for odometry around
/// them. What cannot be used is counted, with a throttled warning that says what to do.
class CloudInput {
 public:
  struct Listener {
    std::function<void(PosedCloud)> cloud;
    std::function<void()> time_jumped_back;
  };
  struct Counts {
    std::uint64_t received = 0;
    std::uint64_t no_pose = 0;       ///< tf or odometry did not come
    std::uint64_t out_of_order = 0;  ///< older than the cloud before on the same topic
    std::uint64_t unusable = 0;      ///< stamp 0, or registered without sensor_frame
    std::string last_problem;
  };

  CloudInput(const ros::NodeHandle& nh, const NodeOptions& options, Listener listener);
  ~CloudInput();
  Counts counts() const;

 private:
  using Cloud = sensor_msgs::PointCloud2;
  using Clock = std::chrono::steady_clock;
  using Filter = tf2_ros::MessageFilter<Cloud>;

  void receive(const Cloud::ConstPtr& cloud, std::size_t topic);
  bool refuse(const Cloud& cloud, std::size_t topic);
  void checkTime();
  void forgetWhatWaits();
  void deliverFromTf(const Cloud::ConstPtr& cloud);
  void failedInTf(const Cloud::ConstPtr& cloud,
                  tf2_ros::filter_failure_reasons::FilterFailureReason reason);
  void receiveOdometry(const nav_msgs::Odometry::ConstPtr& message);
  void deliverWithOdometry();
  std::optional<PosedCloud> poseFromOdometry(const Cloud::ConstPtr& cloud, std::string& why);
  Eigen::Isometry3d fromChild(const std::string& frame) const;
  void warnOfLatePoses();
  /// What tf lacks for a cloud; empty when it knows the poses.
  std::string explainTf(const Cloud& cloud) const;
  Clock::time_point takeReceived(const Cloud* cloud);
  void count(std::uint64_t Counts::*counter, const std::string& problem);

  ros::NodeHandle nh_;
  NodeOptions options_;
  Listener listener_;
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener tf_listener_;
  std::unique_ptr<Filter> filter_;
  std::unique_ptr<OdometryHistory> odometry_;
  std::deque<Cloud::ConstPtr> waiting_;  ///< for odometry
  std::vector<ros::Subscriber> subscribers_;
  std::vector<ros::Time> last_stamp_;  ///< of each topic
  ros::WallTimer timer_;
  ros::Time now_;                            ///< at the last check
  std::optional<Clock::time_point> jumped_;  ///< when time jumped back last
  int older_in_a_row_ = 0;                   ///< clouds older than the one before

  mutable std::mutex mutex_;
  std::map<const Cloud*, std::pair<Clock::time_point, Cloud::ConstPtr>> received_;
  Counts counts_;
};

}  // namespace beautymap
