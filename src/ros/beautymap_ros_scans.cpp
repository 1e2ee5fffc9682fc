// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
// What BeautyMapRos does with each scan.
#include <beautymap/ScanReport.h>
#include <pcl_conversions/pcl_conversions.h>

#include <algorithm>
#include <chrono>

#include "beautymap/io/cloud_fields.h"
#include "beautymap/ros/beautymap_ros.h"

namespace beautymap {
namespace {

using SteadyClock = std::chrono::steady_clock;
constexpr std::size_t kBehind = 3;  // scans that wait

double millisecondsSince(SteadyClock::time_point begin) {
  return std::chrono::duration<double, std::milli>(SteadyClock::now() - begin).count();
}

/// The points of one class with the header and all fields of the scan.
sensor_msgs::PointCloud2Ptr pointsOf(PointClass wanted, const pcl::PCLPointCloud2& cloud,
                                     const std::vector<PointClass>& classes,
                                     const sensor_msgs::PointCloud2& input) {
  auto message = boost::make_shared<sensor_msgs::PointCloud2>();
  message->header = input.header;
  message->fields = input.fields;
  message->point_step = cloud.point_step;
  message->height = 1;
  message->is_dense = input.is_dense;
  const auto count = std::count(classes.begin(), classes.end(), wanted);
  message->data.reserve(static_cast<std::size_t>(count) * cloud.point_step);
  for (std::size_t i = 0; i < classes.size(); ++i) {
    if (classes[i] != wanted) continue;
    const std::uint8_t* record = cloud.data.data() + i * cloud.point_step;
    message->data.insert(message->data.end(), record, record + cloud.point_step);
  }
  message->width = static_cast<std::uint32_t>(count);
  message->row_step = message->width * message->point_step;
  return message;
}

}  // namespace

void BeautyMapRos::skip(const std::string& why) {
  ROS_WARN_THROTTLE(kWarningPeriod, "a scan is skipped: %s", why.c_str());
  const std::lock_guard<std::mutex> lock(totals_mutex_);
  ++totals_.skipped;
  totals_.last_problem = why;
}

void BeautyMapRos::work() {
  while (const auto posed = queue_.pop()) {
    if (paused_) {
      const std::lock_guard<std::mutex> lock(totals_mutex_);
      ++totals_.skipped;
      continue;
    }
    const std::lock_guard<std::mutex> lock(process_mutex_);
    try {
      process(*posed);
    } catch (const std::exception& error) {
      skip(error.what());
    }
  }
}

void BeautyMapRos::process(const PosedCloud& posed) {
  const sensor_msgs::PointCloud2& message = *posed.message;
  SourceScan scan;
  pcl_conversions::toPCL(message, scan.cloud);
  if (message.width == 0 || message.height == 0) return skip("the cloud is empty");
  if (const auto wrong = normalizeCloud(scan.cloud)) return skip("malformed cloud: " + *wrong);
  scan.T_map_cloud = posed.T_map_cloud;
  scan.T_map_sensor = posed.T_map_sensor;
  scan.stamp_ns = message.header.stamp.toNSec();

  const std::shared_ptr<OnlineCleaner> map = cleaner();
  {
    const std::lock_guard<std::mutex> lock(map_mutex_);
    map_frame_ = posed.map_frame;
  }
  const StageTimes before = map->times();
  const std::vector<PointClass>& classes = map->add(scan);
  publishSplit(posed, scan.cloud, classes);
  sayUp(map);
  const double latency_ms = millisecondsSince(posed.received);
  // What a scan saw free takes most of the time: better to leave it out than to fall behind.
  const bool see_free = queue_.size() < kBehind;
  map->finish(scan, see_free);
  if (log_ && !log_->append(scan)) {
    ROS_WARN_THROTTLE(kWarningPeriod,
                      "a cloud with other fields than the first one is not kept for loop closures");
  }
  {
    const std::lock_guard<std::mutex> lock(totals_mutex_);
    ++totals_.scans;
    ++totals_.since_diagnostics;
    totals_.thinned += see_free ? 0 : 1;
    totals_.latency_ms = std::max(totals_.latency_ms, latency_ms);
  }
  report(posed, classes, latency_ms, before);
}

void BeautyMapRos::sayUp(const std::shared_ptr<OnlineCleaner>& map) {
  if (said_up_.lock() == map) return;
  const std::optional<UpDirection> up = map->up();
  if (!up) return;
  said_up_ = map;
  ROS_LOG_STREAM(up->isCertain() ? ros::console::levels::Info : ros::console::levels::Warn,
                 ROSCONSOLE_DEFAULT_NAME, up->describe());
}

void BeautyMapRos::publishSplit(const PosedCloud& posed, const pcl::PCLPointCloud2& cloud,
                                const std::vector<PointClass>& classes) {
  // The dynamic ones first: who avoids them waits for them.
  dynamic_points_.publish(pointsOf(PointClass::kDynamic, cloud, classes, *posed.message));
  if (static_points_.getNumSubscribers() == 0) return;
  static_points_.publish(pointsOf(PointClass::kStatic, cloud, classes, *posed.message));
}

void BeautyMapRos::report(const PosedCloud& posed, const std::vector<PointClass>& classes,
                          double latency_ms, const StageTimes& before) {
  if (report_publisher_.getNumSubscribers() == 0) return;
  auto report = boost::make_shared<ScanReport>();
  report->header = posed.message->header;
  const auto count = [&](PointClass wanted) {
    return static_cast<std::uint32_t>(std::count(classes.begin(), classes.end(), wanted));
  };
  report->points = static_cast<std::uint32_t>(classes.size());
  report->static_points = count(PointClass::kStatic);
  report->dynamic_points = count(PointClass::kDynamic);
  report->dropped_points = count(PointClass::kDropped);
  report->latency_ms = static_cast<float>(latency_ms);
  const std::shared_ptr<OnlineCleaner> map = cleaner();
  double processing_ms = 0.0;
  const StageTimes times = map->times();
  for (const auto& stage : times.stages()) {
    double ms = stage.second;
    for (const auto& earlier : before.stages())
      ms -= earlier.first == stage.first ? earlier.second : 0.0;
    report->stages.push_back(stage.first);
    report->stage_ms.push_back(static_cast<float>(ms));
    processing_ms += ms;
  }
  report->processing_ms = static_cast<float>(processing_ms);
  report->queue_length = static_cast<std::uint32_t>(queue_.size());
  report->dropped_scans = queue_.dropped();
  const CloudInput::Counts input = input_ ? input_->counts() : CloudInput::Counts();
  report->tf_failures = input.no_pose;
  const OnlineCleaner::Size size = map->size();
  report->map_points = size.points;
  report->tiles = static_cast<std::uint32_t>(size.tiles);
  report->tiles_on_disk = static_cast<std::uint32_t>(size.tiles_on_disk);
  report->memory_mb = static_cast<float>(size.memory_mb);
  const std::lock_guard<std::mutex> lock(totals_mutex_);
  report->scans = totals_.scans;
  report->skipped_scans = totals_.skipped + input.out_of_order + input.unusable;
  report->thinned_scans = totals_.thinned;
  report_publisher_.publish(report);
}

}  // namespace beautymap
