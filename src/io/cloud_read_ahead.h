// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <rosbag/view.h>
#include <sensor_msgs/PointCloud2.h>

#include <cstddef>
#include <deque>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include "rosbag_files.h"

namespace beautymap {

/// A cloud as it was recorded.
struct RecordedCloud {
  ros::Time recorded;
  sensor_msgs::PointCloud2::Ptr cloud;  ///< null where it cannot be read
  std::string error;                    ///< why, if there is a reason
};

RecordedCloud readCloud(const rosbag::MessageInstance& message);

/// Clouds of bags in the order of time; those of bz2 bags are read in threads ahead of their use,
/// as decompressing them takes longer than all that follows. A bag reads one message at a time, so
/// each thread has opened the bags for itself and reads its share of short stretches.
class CloudReadAhead {
 public:
  /// @param files   nobody else may read them while this does, from the first next() on
  /// @param stride  every n-th message is read
  CloudReadAhead(const RosbagFiles& files, const RosbagFiles::Query& query, const ros::Time& begin,
                 const ros::Time& end, std::size_t stride);
  CloudReadAhead(CloudReadAhead&&) = delete;  // its threads know where it is

  /// The next cloud, also where it cannot be read; false at the end.
  bool next(RecordedCloud& cloud);
  void rewind();

 private:
  using Clouds = std::deque<RecordedCloud>;

  /// Bags that one thread at a time reads, and how many of their messages lie behind it.
  struct Reader {
    std::unique_ptr<RosbagFiles> files;  ///< null: those that were given
    std::unique_ptr<rosbag::View> view;
    rosbag::View::iterator at;
    std::size_t position = 0;
  };

  Clouds read(Reader& reader, std::size_t stretch) const;
  void start();

  std::size_t stride_;
  std::vector<Reader> readers_;
  std::size_t stretch_;  ///< messages of one
  std::launch policy_;
  std::size_t next_stretch_ = 0;
  Clouds clouds_;
  std::deque<std::future<Clouds>> stretches_;  ///< the last member: threads use those above
};

}  // namespace beautymap
