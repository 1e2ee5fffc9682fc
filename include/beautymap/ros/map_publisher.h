// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/ros.h>

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "beautymap/online/online_cleaner.h"
#include "beautymap/ros/serialized_cloud.h"

namespace beautymap {

/// Publishes the map now and then from a thread of its own, so that a large one delays no scan:
/// ~cleaned_map, ~removed_points and ~matrix, each only while somebody listens. Tiles that did not
/// change are not looked at again.
class MapPublisher {
 public:
  /// The map at the moment, and its frame; without a map nothing is published.
  using Source = std::function<std::pair<std::shared_ptr<const OnlineCleaner>, std::string>()>;

  MapPublisher(ros::NodeHandle& private_nh, Source source, double matrix_size_m);
  ~MapPublisher();
  MapPublisher(const MapPublisher&) = delete;
  MapPublisher& operator=(const MapPublisher&) = delete;

  void configure(double period_s, double voxel_m);

 private:
  struct CloudTopic {
    ros::Publisher publisher;
    std::vector<std::uint8_t> OnlineCleaner::TileView::*records;
    CloudSerializer serializer;
  };

  void run();
  void publish();
  void update(const OnlineCleaner& cleaner, double voxel_m);
  void publishCloud(CloudTopic& topic, const OnlineCleaner& cleaner, const std::string& frame);
  void publishMatrix(const OnlineCleaner& cleaner, const std::string& frame);

  Source source_;
  double matrix_size_m_;
  CloudTopic cleaned_, removed_;
  ros::Publisher matrix_;
  std::weak_ptr<const OnlineCleaner> shown_;  ///< whose tiles are in views_
  std::map<std::pair<std::int32_t, std::int32_t>, OnlineCleaner::TileView> views_;
  double shown_voxel_m_ = -1.0;

  std::mutex mutex_;
  std::condition_variable changed_;
  double period_s_ = 2.0;
  double voxel_m_ = 0.2;
  bool stopped_ = false;
  std::thread thread_;
};

}  // namespace beautymap
