// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/ros/map_publisher.h"

#include <nav_msgs/OccupancyGrid.h>
#include <pcl_conversions/pcl_conversions.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>

#include "beautymap/online/save_points.h"

namespace beautymap {
namespace {

// Values of ~matrix, as rviz colours them.
constexpr std::int8_t kUnknown = -1;
constexpr std::int8_t kGround = 0;
constexpr std::int8_t kDynamic = 50;
constexpr std::int8_t kStatic = 100;

}  // namespace

MapPublisher::MapPublisher(ros::NodeHandle& private_nh, Source source, double matrix_size_m)
    : source_(std::move(source)),
      matrix_size_m_(matrix_size_m),
      cleaned_{private_nh.advertise<sensor_msgs::PointCloud2>("cleaned_map", 1, true),
               &OnlineCleaner::TileView::cleaned,
               {}},
      removed_{private_nh.advertise<sensor_msgs::PointCloud2>("removed_points", 1, true),
               &OnlineCleaner::TileView::removed,
               {}},
      matrix_(private_nh.advertise<nav_msgs::OccupancyGrid>("matrix", 1, true)),
      thread_([this] { run(); }) {}

MapPublisher::~MapPublisher() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopped_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void MapPublisher::configure(double period_s, double voxel_m) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    period_s_ = period_s;
    voxel_m_ = voxel_m;
  }
  changed_.notify_all();
}

void MapPublisher::run() {
  // Of this thread only. It holds a lock of the map for moments, so that no scan waits for it.
  ::setpriority(PRIO_PROCESS, 0, 10);
  auto last = std::chrono::steady_clock::now();
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stopped_) {
    // Wall time: with /use_sim_time a clock that stands still must not keep the map back.
    const auto next = last + std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                                 std::chrono::duration<double>(period_s_));
    if (std::chrono::steady_clock::now() < next) {
      changed_.wait_until(lock, next);
      continue;
    }
    lock.unlock();
    try {
      publish();
    } catch (const std::exception& error) {
      ROS_WARN_THROTTLE(5.0, "the map cannot be published: %s", error.what());
    }
    last = std::chrono::steady_clock::now();
    lock.lock();
  }
}

void MapPublisher::publish() {
  const bool wants_cleaned = cleaned_.publisher.getNumSubscribers() > 0;
  const bool wants_removed = removed_.publisher.getNumSubscribers() > 0;
  const auto [cleaner, frame] = source_();
  if (!cleaner) return;
  if (wants_cleaned || wants_removed) {
    double voxel_m = 0.0;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      voxel_m = voxel_m_;
    }
    if (shown_.lock() != cleaner || shown_voxel_m_ != voxel_m) views_.clear();
    shown_ = cleaner;
    shown_voxel_m_ = voxel_m;
    update(*cleaner, voxel_m);
  } else {
    views_.clear();
    for (CloudTopic* topic : {&cleaned_, &removed_}) topic->serializer.release();
  }
  if (wants_cleaned) publishCloud(cleaned_, *cleaner, frame);
  if (wants_removed) publishCloud(removed_, *cleaner, frame);
  if (matrix_.getNumSubscribers() > 0) publishMatrix(*cleaner, frame);
}

void MapPublisher::update(const OnlineCleaner& cleaner, double voxel_m) {
  const pcl::PCLPointCloud2 layout = cleaner.layout();
  for (const ColumnIndex index : cleaner.tiles()) {
    OnlineCleaner::TileView& view = views_[{index.x, index.y}];
    if (!cleaner.look(index, view)) continue;
    thinRecords(view.cleaned, layout, voxel_m);
    thinRecords(view.removed, layout, voxel_m);
  }
}

void MapPublisher::publishCloud(CloudTopic& topic, const OnlineCleaner& cleaner,
                                const std::string& frame) {
  const pcl::PCLPointCloud2 layout = cleaner.layout();
  sensor_msgs::PointCloud2 head;
  head.header.frame_id = frame;
  head.header.stamp = ros::Time::now();
  pcl_conversions::fromPCL(layout.fields, head.fields);
  head.point_step = layout.point_step;
  head.is_dense = true;
  std::vector<const std::vector<std::uint8_t>*> parts;
  for (const auto& view : views_) parts.push_back(&(view.second.*topic.records));
  try {
    topic.publisher.publish(topic.serializer.serialize(head, parts));
  } catch (const std::length_error& error) {
    ROS_WARN_THROTTLE(5.0, "%s is not published: %s; raise ~publish_voxel (%g m)",
                      topic.publisher.getTopic().c_str(), error.what(), shown_voxel_m_);
  }
}

void MapPublisher::publishMatrix(const OnlineCleaner& cleaner, const std::string& frame) {
  const auto [matrix, occupied, dynamic, T_map_level] = cleaner.matrixAround(0.5 * matrix_size_m_);
  const ColumnWindow& window = occupied.window();
  nav_msgs::OccupancyGrid grid;
  grid.header.frame_id = frame;
  grid.header.stamp = ros::Time::now();
  grid.info.map_load_time = grid.header.stamp;
  grid.info.resolution = static_cast<float>(matrix.res_g);
  grid.info.width = grid.info.height = static_cast<std::uint32_t>(window.size);
  const Eigen::Vector3d corner = T_map_level * Eigen::Vector3d(window.corner.x * matrix.res_g,
                                                               window.corner.y * matrix.res_g, 0.0);
  const Eigen::Quaterniond turn(T_map_level.linear());
  grid.info.origin.position.x = corner.x();
  grid.info.origin.position.y = corner.y();
  grid.info.origin.position.z = corner.z();
  grid.info.origin.orientation.x = turn.x();
  grid.info.origin.orientation.y = turn.y();
  grid.info.origin.orientation.z = turn.z();
  grid.info.origin.orientation.w = turn.w();
  const Bits above_ground = ~lowBits(matrix.bits_below + 1);
  for (int y = 0; y < window.size; ++y) {
    for (int x = 0; x < window.size; ++x) {
      const Bits of_column = occupied.at(x, y), removed = dynamic.at(x, y);
      grid.data.push_back(of_column == 0                               ? kUnknown
                          : (of_column & ~removed & above_ground) != 0 ? kStatic
                          : removed != 0                               ? kDynamic
                                                                       : kGround);
    }
  }
  matrix_.publish(grid);
}

}  // namespace beautymap
