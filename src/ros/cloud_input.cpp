// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/ros/cloud_input.h"

#include <tf2_eigen/tf2_eigen.h>

#include <utility>

#include "io/odometry_history.h"
#include "io/text.h"
#include "io/tf_history.h"

namespace beautymap {
namespace {

constexpr double kWarningPeriod = 5.0;  // [s]
const ros::Duration kTfMemory(30.0);
// Clocks are adjusted by less, bags that loop jump by more.
const ros::Duration kJump(0.5);
constexpr auto kStragglers = std::chrono::seconds(2);
// A driver that was restarted may have another clock.
constexpr int kNewTime = 10;

}  // namespace

CloudInput::CloudInput(const ros::NodeHandle& nh, const NodeOptions& options, Listener listener)
    : nh_(nh),
      options_(options),
      listener_(std::move(listener)),
      buffer_(kTfMemory),
      // Transforms come in the clouds' thread. With one of their own, a cloud that the filter is
      // just about to keep misses its transform and stays in the filter for ever.
      tf_listener_(buffer_, nh_, false),
      last_stamp_(options.cloud_topics.size()),
      now_(ros::Time::now()) {
  const auto queue_size = static_cast<std::uint32_t>(options_.queue_size);
  options_.map_frame = stripSlash(options_.map_frame);
  options_.sensor_frame = stripSlash(options_.sensor_frame);
  if (options_.pose_source == "odometry") {
    odometry_ = std::make_unique<OdometryHistory>();
    subscribers_.push_back(nh_.subscribe(options_.odom_topic, 1000, &CloudInput::receiveOdometry,
                                         this, ros::TransportHints().tcpNoDelay()));
  } else {
    filter_ = std::make_unique<Filter>(buffer_, options_.map_frame, queue_size, nh_);
    if (!options_.sensor_frame.empty() && options_.sensor_frame != options_.map_frame) {
      // Each must be reachable from the cloud's frame at its stamp.
      filter_->setTargetFrames({options_.map_frame, options_.sensor_frame});
    }
    filter_->registerCallback([this](const Cloud::ConstPtr& cloud) { deliverFromTf(cloud); });
    filter_->registerFailureCallback(
        [this](const Cloud::ConstPtr& cloud, auto reason) { failedInTf(cloud, reason); });
  }
  for (std::size_t i = 0; i < options_.cloud_topics.size(); ++i) {
    subscribers_.push_back(nh_.subscribe<Cloud>(
        options_.cloud_topics[i], queue_size,
        [this, i](const Cloud::ConstPtr& cloud) { receive(cloud, i); }, ros::VoidConstPtr(),
        ros::TransportHints().tcpNoDelay()));
  }
  timer_ = nh_.createWallTimer(ros::WallDuration(0.5), [this](const ros::WallTimerEvent&) {
    checkTime();
    warnOfLatePoses();
  });
}

CloudInput::~CloudInput() {
  for (ros::Subscriber& subscriber : subscribers_) subscriber.shutdown();
  timer_.stop();
}

CloudInput::Counts CloudInput::counts() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return counts_;
}

void CloudInput::count(std::uint64_t Counts::*counter, const std::string& problem) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++(counts_.*counter);
  counts_.last_problem = problem;
}

void CloudInput::checkTime() {
  const ros::Time now = ros::Time::now();
  if (now + kJump < now_) {
    ROS_WARN("time jumped back by %.1f s (does a bag loop, or was the simulation reset?)",
             (now_ - now).toSec());
    forgetWhatWaits();
    jumped_ = Clock::now();
    listener_.time_jumped_back();
  }
  now_ = now;
}

void CloudInput::forgetWhatWaits() {
  if (filter_) filter_->clear();
  if (odometry_) odometry_ = std::make_unique<OdometryHistory>();
  // The buffer of tf is cleared by its listener, which knows better what came after the jump.
  waiting_.clear();
  std::fill(last_stamp_.begin(), last_stamp_.end(), ros::Time());
  const std::lock_guard<std::mutex> lock(mutex_);
  received_.clear();
}

void CloudInput::receive(const Cloud::ConstPtr& cloud, std::size_t topic) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++counts_.received;
  }
  checkTime();
  if (refuse(*cloud, topic)) return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    received_[cloud.get()] = {Clock::now(), cloud};
  }
  if (filter_) {
    filter_->add(cloud);
    return;
  }
  waiting_.push_back(cloud);
  deliverWithOdometry();
  if (waiting_.size() > static_cast<std::size_t>(options_.queue_size)) {
    std::string why;
    poseFromOdometry(waiting_.front(), why);
    count(&Counts::no_pose, "no odometry for the cloud at " +
                                inSeconds(waiting_.front()->header.stamp.toNSec()) + ": " + why);
    takeReceived(waiting_.front().get());
    waiting_.pop_front();
  }
}

/// Also remembers the stamp.
bool CloudInput::refuse(const Cloud& cloud, std::size_t topic) {
  const std::string frame = stripSlash(cloud.header.frame_id);
  std::string problem;
  if (cloud.header.stamp.isZero()) {
    problem = "a cloud without a stamp on " + options_.cloud_topics[topic] +
              ": its pose is unknown; let its driver set header.stamp";
  } else if (frame.empty()) {
    problem = "a cloud without header.frame_id on " + options_.cloud_topics[topic];
  } else if (filter_ && options_.sensor_frame.empty() && frame == options_.map_frame) {
    problem = "the clouds on " + options_.cloud_topics[topic] +
              " are registered in the map frame '" + frame +
              "' already: say where the sensor is with ~sensor_frame";
  }
  if (!problem.empty()) {
    ROS_WARN_THROTTLE(kWarningPeriod, "%s", problem.c_str());
    count(&Counts::unusable, problem);
    return true;
  }
  // On its way when time jumped: it would make all that follow it too old.
  const bool is_straggler = jumped_ && Clock::now() - *jumped_ < kStragglers &&
                            cloud.header.stamp > ros::Time::now() + kJump;
  if (is_straggler) {
    count(&Counts::out_of_order, "a cloud from before time jumped back: skipped");
    return true;
  }
  if (cloud.header.stamp >= last_stamp_[topic]) {
    older_in_a_row_ = 0;
  } else if (++older_in_a_row_ >= kNewTime) {
    ROS_WARN("the clouds' stamps went back and stay there: going on with them");
    forgetWhatWaits();
    older_in_a_row_ = 0;
  } else {
    problem = "a cloud on " + options_.cloud_topics[topic] + " is " +
              std::to_string((last_stamp_[topic] - cloud.header.stamp).toSec()) +
              " s older than the one before: skipped";
    ROS_WARN_THROTTLE(kWarningPeriod, "%s", problem.c_str());
    count(&Counts::out_of_order, problem);
    return true;
  }
  last_stamp_[topic] = cloud.header.stamp;
  return false;
}

CloudInput::Clock::time_point CloudInput::takeReceived(const Cloud* cloud) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto found = received_.find(cloud);
  if (found == received_.end()) return Clock::now();
  const Clock::time_point time = found->second.first;
  received_.erase(found);
  return time;
}

void CloudInput::deliverFromTf(const Cloud::ConstPtr& cloud) {
  const Clock::time_point received = takeReceived(cloud.get());
  const ros::Time& stamp = cloud->header.stamp;
  const std::string frame = stripSlash(cloud->header.frame_id);
  try {
    PosedCloud posed{cloud, options_.map_frame, Eigen::Isometry3d::Identity(),
                     Eigen::Isometry3d::Identity(), received};
    const auto pose = [&](const std::string& of) {
      return Eigen::Isometry3d(
          tf2::transformToEigen(buffer_.lookupTransform(options_.map_frame, of, stamp)));
    };
    posed.T_map_cloud = pose(frame);
    posed.T_map_sensor =
        options_.sensor_frame.empty() ? posed.T_map_cloud : pose(options_.sensor_frame);
    listener_.cloud(std::move(posed));
  } catch (const tf2::TransformException& error) {
    count(&Counts::no_pose, error.what());
    ROS_WARN_THROTTLE(kWarningPeriod, "no pose for the cloud at %s: %s",
                      inSeconds(stamp.toNSec()).c_str(), error.what());
  }
}

void CloudInput::failedInTf(const Cloud::ConstPtr& cloud,
                            tf2_ros::filter_failure_reasons::FilterFailureReason reason) {
  std::string problem = explainTf(*cloud);
  if (problem.empty()) {
    // The filter gave up just when tf came.
    deliverFromTf(cloud);
    return;
  }
  takeReceived(cloud.get());
  if (reason == tf2_ros::filter_failure_reasons::OutTheBack) {
    problem +=
        "; the cloud is older than what tf remembers (30 s): is it stamped by another clock?";
  }
  ROS_WARN_THROTTLE(kWarningPeriod, "%s", problem.c_str());
  count(&Counts::no_pose, problem);
}

std::string CloudInput::explainTf(const Cloud& cloud) const {
  const std::string frame = stripSlash(cloud.header.frame_id);
  std::string error;
  for (const std::string& from : {frame, options_.sensor_frame}) {
    if (from.empty() ||
        buffer_.canTransform(options_.map_frame, from, cloud.header.stamp, &error)) {
      continue;
    }
    std::string text = "no transform from '" + from + "' to '" + options_.map_frame +
                       "' for the cloud at " + inSeconds(cloud.header.stamp.toNSec()) + ": ";
    if (!buffer_._frameExists(options_.map_frame)) {
      text += "tf has no frame '" + options_.map_frame +
              "': is the LiDAR odometry running, and is ~map_frame the name of its fixed frame?";
    } else if (!buffer_._frameExists(from)) {
      text += "tf has no frame '" + from +
              "': is the static transform to the sensor published, and is its name right?";
    } else if (!buffer_.canTransform(options_.map_frame, from, ros::Time(0))) {
      text += "the two are not connected";
    } else {
      text +=
          "tf does not reach the stamp: the odometry is behind, or the clocks differ (with a bag: "
          "rosbag play --clock and /use_sim_time)";
    }
    return text;
  }
  return {};
}

void CloudInput::warnOfLatePoses() {
  Cloud::ConstPtr oldest;
  Clock::time_point since = Clock::now();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const auto& entry : received_) {
      if (entry.second.first < since) {
        since = entry.second.first;
        oldest = entry.second.second;
      }
    }
  }
  if (!oldest || Clock::now() - since < std::chrono::duration<double>(options_.tf_timeout)) return;
  std::string why;
  if (filter_) {
    why = explainTf(*oldest);
  } else {
    poseFromOdometry(oldest, why);
    why = "no odometry on " + nh_.resolveName(options_.odom_topic) + " for the cloud at " +
          inSeconds(oldest->header.stamp.toNSec()) + ": " + why;
  }
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    counts_.last_problem = why;
  }
  ROS_WARN_THROTTLE(kWarningPeriod, "%s", why.c_str());
}

}  // namespace beautymap
