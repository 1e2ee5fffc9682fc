// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/ros/beautymap_ros.h"

#include <beautymap/ScanReport.h>
#include <unistd.h>

#include <utility>

#include "beautymap/online/output_folder.h"
#include "io/tf_history.h"

namespace beautymap {

BeautyMapRos::BeautyMapRos(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh)
    : nh_(nh),
      private_nh_(private_nh),
      options_(loadParameters(private_nh).first),
      config_(loadParameters(private_nh).second),
      cleaner_(newCleaner()),
      map_frame_(options_.pose_source == "tf" ? stripSlash(options_.map_frame) : ""),
      queue_(static_cast<std::size_t>(options_.queue_size)),
      diagnostics_(nh, private_nh, private_nh.getNamespace()) {
  ROS_INFO_STREAM("configuration:\n" << toYaml(config_));
  if (options_.loop_closure) {
    makeParentFolder(options_.output_folder + "/x");
    log_ = std::make_unique<ScanLog>(options_.output_folder);
    path_subscriber_ = nh_.subscribe(options_.path_topic, 2, &BeautyMapRos::takePath, this);
  }
  static_points_ = private_nh_.advertise<sensor_msgs::PointCloud2>("static_points", 10);
  dynamic_points_ = private_nh_.advertise<sensor_msgs::PointCloud2>("dynamic_points", 10);
  report_publisher_ = private_nh_.advertise<ScanReport>("scan_report", 100);
  map_publisher_ = std::make_unique<MapPublisher>(
      private_nh_,
      [this] {
        const std::lock_guard<std::mutex> lock(map_mutex_);
        return std::make_pair(std::shared_ptr<const OnlineCleaner>(cleaner_), map_frame_);
      },
      options_.matrix_size);
  map_publisher_->configure(options_.publish_period, options_.publish_voxel);

  diagnostics_.setHardwareID("none");
  diagnostics_.add("map", this, &BeautyMapRos::diagnose);
  diagnostics_timer_ = nh_.createWallTimer(
      ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { diagnostics_.update(); });

  ros::NodeHandle service_nh(private_nh_);
  service_nh.setCallbackQueue(&service_callbacks_);
  reconfigure_server_ = std::make_unique<dynamic_reconfigure::Server<BeautyMapConfig>>(service_nh);
  reconfigure_server_->setCallback(
      [this](BeautyMapConfig& config, std::uint32_t level) { reconfigure(config, level); });
  services_.push_back(service_nh.advertiseService("save_map", &BeautyMapRos::save, this));
  services_.push_back(service_nh.advertiseService("load_map", &BeautyMapRos::load, this));
  services_.push_back(service_nh.advertiseService("reset", &BeautyMapRos::reset, this));
  for (const bool pause : {true, false}) {
    services_.push_back(
        service_nh.advertiseService<std_srvs::Empty::Request, std_srvs::Empty::Response>(
            pause ? "pause" : "resume", [this, pause](auto&, auto&) {
              paused_ = pause;
              return true;
            }));
  }
  service_spinner_ = std::make_unique<ros::AsyncSpinner>(1, &service_callbacks_);
  service_spinner_->start();
  worker_ = std::thread([this] { work(); });
  input_ = std::make_unique<CloudInput>(
      nh_, options_,
      CloudInput::Listener{[this](PosedCloud cloud) { queue_.push(std::move(cloud)); },
                           [this] {
                             if (!options_.reset_on_time_jump) return;
                             ROS_WARN("the map begins anew (~reset_on_time_jump)");
                             startMap(newCleaner());
                           }});
}

BeautyMapRos::~BeautyMapRos() {
  input_.reset();
  service_spinner_->stop();
  diagnostics_timer_.stop();
  path_subscriber_.shutdown();
  queue_.close();
  worker_.join();
  stopRebuilding();
  map_publisher_.reset();
  if (!options_.save_on_exit) return;
  try {
    SaveMap::Response response;
    saveTo("exit.pcd", 0.0, true, response);
    ROS_INFO("%s", response.message.c_str());
  } catch (const std::exception& error) {
    ROS_ERROR("the map is not saved: %s", error.what());
  }
}

std::shared_ptr<OnlineCleaner> BeautyMapRos::newCleaner() const {
  static std::atomic<int> number{0};
  return std::make_shared<OnlineCleaner>(config_, options_.output_folder + "/tiles_" +
                                                      std::to_string(::getpid()) + "_" +
                                                      std::to_string(number++));
}

std::shared_ptr<OnlineCleaner> BeautyMapRos::cleaner() const {
  const std::lock_guard<std::mutex> lock(map_mutex_);
  return cleaner_;
}

void BeautyMapRos::startMap(std::shared_ptr<OnlineCleaner> cleaner) {
  stopRebuilding();
  queue_.clear();
  const std::lock_guard<std::mutex> processing(process_mutex_);
  if (log_) log_ = std::make_unique<ScanLog>(options_.output_folder);
  const std::lock_guard<std::mutex> lock(map_mutex_);
  cleaner_ = std::move(cleaner);
}

void BeautyMapRos::reconfigure(BeautyMapConfig& config, std::uint32_t) {
  options_.publish_period = config.publish_period;
  options_.publish_voxel = config.publish_voxel;
  options_.save_on_exit = config.save_on_exit;
  options_.reset_on_time_jump = config.reset_on_time_jump;
  map_publisher_->configure(config.publish_period, config.publish_voxel);
}

void BeautyMapRos::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  const CloudInput::Counts input = input_ ? input_->counts() : CloudInput::Counts();
  const std::shared_ptr<const OnlineCleaner> map = cleaner();
  const OnlineCleaner::Size size = map->size();
  Totals totals;
  {
    const std::lock_guard<std::mutex> lock(totals_mutex_);
    totals = totals_;
    totals_.since_diagnostics = 0;
    totals_.latency_ms = 0.0;
  }
  if (input.received == 0) {
    status.summary(DiagnosticStatus::WARN, "no clouds yet");
  } else if (totals.scans == 0) {
    status.summary(DiagnosticStatus::ERROR,
                   input.last_problem.empty() ? "no cloud has a pose yet" : input.last_problem);
  } else if (queue_.dropped() > 0) {
    status.summary(DiagnosticStatus::WARN, "scans were dropped: slower than the sensor");
  } else {
    status.summary(DiagnosticStatus::OK, paused_ ? "paused" : "mapping");
  }
  status.add("clouds received", input.received);
  status.add("scans in the map", totals.scans);
  status.add("scans since last time", totals.since_diagnostics);
  status.add("largest latency [ms]", totals.latency_ms);
  status.add("scans waiting", queue_.size());
  status.add("scans dropped", queue_.dropped());
  status.add("scans skipped", totals.skipped + input.out_of_order + input.unusable);
  status.add("tf failures", input.no_pose);
  status.add("points in the map", size.points);
  status.add("size of the cells [m]", size.cell_m);
  if (const auto up = map->up()) status.add("up", up->describe());
  status.add("tiles", size.tiles);
  status.add("tiles on disk", size.tiles_on_disk);
  status.add("memory of the map [MB]", size.memory_mb);
  status.add("last problem",
             totals.last_problem.empty() ? input.last_problem : totals.last_problem);
}

}  // namespace beautymap
