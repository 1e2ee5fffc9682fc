// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "rosbag_source.h"

#include <nav_msgs/Odometry.h>
#include <pcl_conversions/pcl_conversions.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <cstdio>
#include <future>
#include <thread>

#include "beautymap/io/cloud_fields.h"
#include "rosbag_topics.h"
#include "scan_files.h"
#include "stamps.h"
#include "text.h"

namespace beautymap {
namespace {

using Topic = RosbagFiles::Topic;

/// Record times.
struct Window {
  ros::Time begin = ros::TIME_MIN;
  ros::Time end = ros::TIME_MAX;
};

Window chooseWindow(const RosbagFiles& files, const SourceOptions& options) {
  const double length_s = secondsBetween(files.end(), files.begin());
  Window window;
  if (options.start_s > 0.0) {
    if (options.start_s > length_s) {
      throw InputError("start is " + std::to_string(options.start_s) +
                       " s, but the input is only " + std::to_string(length_s) + " s long");
    }
    window.begin = shifted(files.begin(), options.start_s);
  }
  if (options.duration_s > 0.0 && options.start_s + options.duration_s < length_s) {
    window.end = shifted(files.begin(), options.start_s + options.duration_s);
  }
  return window;
}

/// Poses are recorded before and after the scans that need them. A little of a long recording must
/// not take the time of reading it all.
Window widened(Window window) {
  constexpr double kMargin = 30.0;  // [s]
  return {shifted(window.begin, -kMargin), shifted(window.end, kMargin)};
}

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// Every readable message of a window of time, in the order of record times.
template <typename Message>
std::vector<boost::shared_ptr<Message>> readAll(const RosbagFiles& files,
                                                const RosbagFiles::Query& query,
                                                const Window& window) {
  std::vector<boost::shared_ptr<Message>> messages;
  const auto view = files.view(query, window.begin, window.end);
  for (const auto& instance : *view) {
    try {
      auto message = instance.instantiate<Message>();
      if (message != nullptr) messages.push_back(std::move(message));
    } catch (const std::exception&) {
      continue;  // the scans that miss it are counted
    }
  }
  return messages;
}

/// Cuts the part of a window that has messages into equal stretches.
std::vector<Window> stretchesOf(const RosbagFiles& files, const Window& window,
                                std::uint64_t count) {
  const std::uint64_t begin = std::max(window.begin, files.begin()).toNSec();
  const std::uint64_t length = std::min(window.end, files.end()).toNSec() - begin + 1;
  std::vector<Window> stretches(count);
  for (std::uint64_t i = 0; i < count; ++i) {
    // In this order nothing overflows, whatever a damaged bag has as its times.
    stretches[i].begin.fromNSec(begin + length / count * i);
    stretches[i].end.fromNSec(i + 1 < count ? begin + length / count * (i + 1) - 1
                                            : begin + length - 1);
  }
  return stretches;
}

/// Calls `use` with every readable message of a window of time. Clouds lie between the messages,
/// and compressed bags must be decompressed as a whole: each thread reads its own stretch of time.
template <typename Message, typename Use>
void forEach(const RosbagFiles& files, const RosbagFiles::Query& query, const Window& window,
             const Use& use) {
  const std::uint64_t threads = std::max(1U, std::thread::hardware_concurrency());
  std::vector<RosbagFiles> opened;
  for (std::uint64_t t = 1; t < threads; ++t) opened.emplace_back(files.paths());
  std::vector<std::future<std::vector<boost::shared_ptr<Message>>>> parts;
  for (const Window& stretch : stretchesOf(files, window, threads)) {
    const RosbagFiles& own = parts.empty() ? files : opened[parts.size() - 1];
    parts.push_back(std::async(std::launch::async, [&own, &query, stretch] {
      return readAll<Message>(own, query, stretch);
    }));
  }
  for (auto& part : parts) {
    for (const auto& message : part.get()) use(*message);
  }
}

RosbagFiles::Query transforms(bool is_static) {
  return [is_static](const rosbag::ConnectionInfo& connection) {
    // tf/tfMessage of old bags is the same message.
    const bool is_type =
        connection.datatype == "tf2_msgs/TFMessage" || connection.datatype == "tf/tfMessage";
    return is_type && endsWith("/" + connection.topic, is_static ? "/tf_static" : "/tf");
  };
}

TfHistory loadTf(const RosbagFiles& files, const Window& window) {
  TfHistory tf;
  const auto insert = [&](const tf2_msgs::TFMessage& message, bool is_static) {
    for (const auto& transform : message.transforms) tf.insert(transform, is_static);
  };
  // Static transforms are few, and recorded once, at the beginning.
  for (const auto& message : readAll<tf2_msgs::TFMessage>(files, transforms(true), Window())) {
    insert(*message, true);
  }
  forEach<tf2_msgs::TFMessage>(files, transforms(false), window,
                               [&](const auto& message) { insert(message, false); });
  tf.finish();
  return tf;
}

OdometryHistory loadOdometry(const RosbagFiles& files, const Topic& topic, const Window& window) {
  OdometryHistory odometry;
  forEach<nav_msgs::Odometry>(files, messagesOf(topic), window,
                              [&](const auto& message) { odometry.insert(message); });
  odometry.finish();
  return odometry;
}

}  // namespace

RosbagSource::RosbagSource(const std::vector<std::string>& paths, const SourceOptions& options)
    : files_(paths),
      topic_(chooseCloudTopic(files_, options.cloud_topic)),
      stride_(static_cast<std::size_t>(std::max(1, options.stride))),
      cloud_frame_(frameOfClouds(files_, topic_)),
      poses_(loadPoses(options)) {
  moving_labels_ = options.moving_labels;
  const Window window = chooseWindow(files_, options);
  const auto view = files_.view(messagesOf(topic_), window.begin, window.end);
  size_ = (view->size() + stride_ - 1) / stride_;
  describeFirstScan(*view);
  clouds_.emplace(files_, messagesOf(topic_), window.begin, window.end, stride_);
}

std::unique_ptr<ScanPoses> RosbagSource::loadPoses(const SourceOptions& options) const {
  const Window window = widened(chooseWindow(files_, options));
  TfHistory tf = loadTf(files_, window);
  if (!options.odom_topic.empty()) {
    const Topic topic = chooseOdometryTopic(files_, options.odom_topic);
    OdometryHistory odometry = loadOdometry(files_, topic, window);
    if (odometry.size() == 0) {
      throw InputError("none of the " + std::to_string(topic.messages) + " messages on " +
                       topic.name + " holds a usable pose");
    }
    return posesFromOdometry(std::move(odometry), std::move(tf), options, cloud_frame_);
  }
  if (tf.empty()) {
    const std::string list = odometryCandidates(files_);
    throw InputError(
        files_.paths().front() + ": there are no usable transforms on /tf or /tf_static" +
        (tf.unusable() > 0 ? " (" + std::to_string(tf.unusable()) +
                                 " unusable, the first: " + tf.unusableExample() + ")"
                           : "") +
        (list.empty() ? " and there is no odometry: the poses of the scans are unknown. Record /tf "
                        "of a LiDAR odometry beside the clouds"
                      : "; take the poses from odometry with --odom-topic" + list));
  }
  return posesFromTf(std::move(tf), options, cloud_frame_);
}

void RosbagSource::describeFirstScan(rosbag::View& view) {
  char length[64];
  std::snprintf(length, sizeof(length), "%.1f s", secondsBetween(files_.end(), files_.begin()));
  description_ = {"bags: " + join(files_.paths()) + " (" + length + ")"};
  SourceScan scan;
  bool found = false;
  // Poses often begin some scans after the clouds; there is no need to search the whole recording.
  constexpr std::size_t kTries = 20;
  std::size_t position = 0;
  for (auto at = view.begin(); !found && at != view.end() && position / stride_ < kTries; ++at) {
    found = position++ % stride_ == 0 && use(readCloud(*at), scan);
  }
  description_.push_back("clouds: " + topic_.name + ", " + std::to_string(size()) +
                         " scans, frame '" + cloud_frame_ + "'" +
                         (found ? ", fields " + fieldNames(scan.cloud) : ""));
  for (const std::string& line : poses_->describe()) description_.push_back(line);
  if (found) description_.push_back("first pose: " + describePose(scan.T_map_sensor));
  skipped_.clear();
}

bool RosbagSource::use(const RecordedCloud& recorded, SourceScan& scan) {
  const std::string when = "recorded at " + inSeconds(recorded.recorded.toNSec()) + ": ";
  const auto& cloud = recorded.cloud;
  if (cloud == nullptr) {
    skip("unreadable message", recorded.error.empty()
                                   ? "not the sensor_msgs/PointCloud2 that this program knows"
                                   : when + recorded.error + " (the bag may be damaged)");
    return false;
  }
  scan.stamp_ns = cloud->header.stamp.toNSec();
  const std::string frame = stripSlash(cloud->header.frame_id);
  const std::string which = "scan at " + inSeconds(scan.stamp_ns) + ": ";
  if (scan.stamp_ns == 0) {
    skip("stamp 0", when + "header.stamp is 0, so its pose is unknown");
    return false;
  }
  if (scan.stamp_ns > kLatestStampNs) {
    skip("stamp after 2033", which + "its clock was never set");
    return false;
  }
  if (cloud->width == 0 || cloud->height == 0) {
    skip("empty cloud", which + "no points");
    return false;
  }
  pcl_conversions::moveToPCL(*cloud, scan.cloud);
  if (const auto wrong = normalizeCloud(scan.cloud)) {
    skip("malformed cloud", which + *wrong);
    return false;
  }
  std::string reason;
  if (poses_->find(frame, scan.stamp_ns, scan, reason)) return true;
  const bool is_first = skipped_.count(reason) == 0;
  skip(reason, is_first ? poses_->explain(frame, scan.stamp_ns) : "");
  return false;
}

bool RosbagSource::next(SourceScan& scan) {
  RecordedCloud recorded;
  while (clouds_->next(recorded)) {
    if (use(recorded, scan)) return true;
  }
  return false;
}

void RosbagSource::rewind() {
  clouds_->rewind();
  skipped_.clear();
}

std::size_t RosbagSource::size() const { return size_; }

}  // namespace beautymap
