// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "rosbag_topics.h"

#include <nav_msgs/Odometry.h>
#include <sensor_msgs/PointCloud2.h>

#include <vector>

#include "beautymap/io/scan_source.h"
#include "text.h"
#include "tf_history.h"

namespace beautymap {

using Topic = RosbagFiles::Topic;

RosbagFiles::Query messagesOf(const Topic& topic) {
  return [topic](const rosbag::ConnectionInfo& connection) {
    return connection.topic == topic.name && connection.datatype == topic.type;
  };
}

namespace {

const char* const kCloudType = "sensor_msgs/PointCloud2";
const char* const kOdometryType = "nav_msgs/Odometry";

/// Topics are named with and without a leading slash.
bool sameTopic(const std::string& a, const std::string& b) {
  return stripSlash(a) == stripSlash(b);
}

/// The header.frame_id of a topic's first readable message.
template <typename Message>
std::string firstFrame(const RosbagFiles& files, const Topic& topic) {
  const auto view = files.view(messagesOf(topic));
  for (const auto& instance : *view) {
    try {
      const auto message = instance.instantiate<Message>();
      if (message != nullptr) return stripSlash(message->header.frame_id);
    } catch (const std::exception&) {
      continue;
    }
  }
  return "";
}

/// One line a topic of this type: name, type, frame, count.
template <typename Message>
std::string candidates(const RosbagFiles& files, const std::string& type) {
  std::string lines;
  for (const Topic& topic : files.topics()) {
    if (topic.type != type) continue;
    lines += "\n  " + topic.name + " (" + type + ", frame '" + firstFrame<Message>(files, topic) +
             "', " + std::to_string(topic.messages) + " messages)";
  }
  return lines;
}

std::string allTopics(const RosbagFiles& files) {
  std::vector<std::string> topics;
  for (const Topic& topic : files.topics()) topics.push_back(topic.name + " (" + topic.type + ")");
  return join(topics);
}

}  // namespace

std::string frameOfClouds(const RosbagFiles& files, const Topic& topic) {
  return firstFrame<sensor_msgs::PointCloud2>(files, topic);
}

std::string odometryCandidates(const RosbagFiles& files) {
  return candidates<nav_msgs::Odometry>(files, kOdometryType);
}

Topic chooseCloudTopic(const RosbagFiles& files, const std::string& wanted) {
  std::vector<Topic> found;
  for (const Topic& topic : files.topics()) {
    if (topic.type == kCloudType && (wanted.empty() || sameTopic(topic.name, wanted))) {
      found.push_back(topic);
    }
  }
  if (found.size() == 1) return found.front();
  const std::string list = candidates<sensor_msgs::PointCloud2>(files, kCloudType);
  if (list.empty()) {
    throw InputError(
        files.paths().front() +
        ": there are no sensor_msgs/PointCloud2 messages; topics: " + allTopics(files));
  }
  if (wanted.empty()) {
    throw InputError("there are several topics with clouds: name one with --cloud-topic" + list);
  }
  throw InputError("there are no clouds on " + wanted + " (--cloud-topic); candidates:" + list);
}

Topic chooseOdometryTopic(const RosbagFiles& files, const std::string& wanted) {
  for (const Topic& topic : files.topics()) {
    if (topic.type == kOdometryType && sameTopic(topic.name, wanted)) return topic;
  }
  const std::string list = odometryCandidates(files);
  throw InputError("there is no nav_msgs/Odometry on " + wanted + " (--odom-topic); " +
                   (list.empty() ? "topics: " + allTopics(files) : "candidates:" + list));
}

}  // namespace beautymap
