// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace beautymap {

/// Several bags, read as one recording in the order of time.
class RosbagFiles {
 public:
  struct Topic {
    std::string name;
    std::string type;
    std::size_t messages;
  };
  using Query = std::function<bool(const rosbag::ConnectionInfo&)>;

  /// @throws InputError when a file does not exist, is no bag, has no index or is broken.
  explicit RosbagFiles(const std::vector<std::string>& paths);

  const std::vector<Topic>& topics() const { return topics_; }
  const std::vector<std::string>& paths() const { return paths_; }
  /// Record times of the first and the last message of all.
  ros::Time begin() const { return begin_; }
  ros::Time end() const { return end_; }
  /// Whether any of them is compressed so, which takes long to read.
  bool areBz2() const { return bz2_; }

  /// The messages of the connections that `query` wants, by record time, merged over the bags.
  std::unique_ptr<rosbag::View> view(const Query& query, const ros::Time& begin = ros::TIME_MIN,
                                     const ros::Time& end = ros::TIME_MAX) const;

 private:
  void listTopics();

  std::vector<std::string> paths_;
  std::vector<std::unique_ptr<rosbag::Bag>> bags_;
  std::vector<Topic> topics_;
  ros::Time begin_;
  ros::Time end_;
  bool bz2_ = false;
};

}  // namespace beautymap
