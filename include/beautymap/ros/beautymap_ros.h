// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <beautymap/BeautyMapConfig.h>
#include <beautymap/LoadMap.h>
#include <beautymap/SaveMap.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <dynamic_reconfigure/server.h>
#include <nav_msgs/Path.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <std_srvs/Empty.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "beautymap/online/online_cleaner.h"
#include "beautymap/online/scan_log.h"
#include "beautymap/online/scan_queue.h"
#include "beautymap/ros/cloud_input.h"
#include "beautymap/ros/map_publisher.h"
#include "beautymap/ros/node_options.h"

namespace beautymap {

/// The online mode as a ROS node or nodelet: clouds and their poses in, the split of each scan and
/// the cleaned map out. Threads: the callbacks only queue clouds; one worker adds them to the map;
/// one publishes the map; one serves the services, so that saving a large map delays no scan; one
/// makes the map again after a loop closure.
class BeautyMapRos {
 public:
  /// @throws ConfigError for bad parameters, InputError when a folder cannot be used.
  BeautyMapRos(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh);
  /// Saves the map when ~save_on_exit is set.
  ~BeautyMapRos();
  BeautyMapRos(const BeautyMapRos&) = delete;
  BeautyMapRos& operator=(const BeautyMapRos&) = delete;

 private:
  static constexpr double kWarningPeriod = 5.0;  ///< [s] of warnings that come again and again

  struct Totals {
    std::uint64_t scans = 0;
    std::uint64_t skipped = 0;
    std::uint64_t thinned = 0;
    std::uint64_t since_diagnostics = 0;
    double latency_ms = 0.0;  ///< the largest since the last diagnostics
    std::string last_problem;
  };

  std::shared_ptr<OnlineCleaner> newCleaner() const;
  std::shared_ptr<OnlineCleaner> cleaner() const;
  void startMap(std::shared_ptr<OnlineCleaner> cleaner);
  void reconfigure(BeautyMapConfig& config, std::uint32_t);
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  // beautymap_ros_scans.cpp
  void work();
  void skip(const std::string& why);
  void process(const PosedCloud& posed);
  /// Once for each map.
  void sayUp(const std::shared_ptr<OnlineCleaner>& map);
  void publishSplit(const PosedCloud& posed, const pcl::PCLPointCloud2& cloud,
                    const std::vector<PointClass>& classes);
  void report(const PosedCloud& posed, const std::vector<PointClass>& classes, double latency_ms,
              const StageTimes& before);

  // beautymap_ros_loop_closure.cpp
  void takePath(const nav_msgs::Path::ConstPtr& path);
  void rebuild(const PoseCorrection& correction);
  void stopRebuilding();

  // beautymap_ros_services.cpp
  bool save(SaveMap::Request& request, SaveMap::Response& response);
  bool load(LoadMap::Request& request, LoadMap::Response& response);
  bool reset(std_srvs::Empty::Request&, std_srvs::Empty::Response&);
  void saveTo(const std::string& path, double voxel_m, bool session, SaveMap::Response& response);

  ros::NodeHandle nh_, private_nh_;
  NodeOptions options_;
  Config config_;

  mutable std::mutex map_mutex_;  ///< of the pointers, not of the map
  std::shared_ptr<OnlineCleaner> cleaner_;
  std::string map_frame_;
  std::weak_ptr<const OnlineCleaner> said_up_;  ///< of this map
  std::mutex process_mutex_;  ///< held while a scan is added, and while another map takes over
  std::unique_ptr<ScanLog> log_;
  ScanQueue<PosedCloud> queue_;
  std::atomic<bool> paused_{false};

  mutable std::mutex totals_mutex_;
  Totals totals_;

  ros::Publisher static_points_, dynamic_points_, report_publisher_;
  ros::CallbackQueue service_callbacks_;
  std::unique_ptr<ros::AsyncSpinner> service_spinner_;
  std::vector<ros::ServiceServer> services_;
  std::unique_ptr<dynamic_reconfigure::Server<BeautyMapConfig>> reconfigure_server_;
  diagnostic_updater::Updater diagnostics_;
  ros::WallTimer diagnostics_timer_;
  ros::Subscriber path_subscriber_;
  std::thread rebuild_thread_;
  std::atomic<bool> rebuilding_{false};
  std::atomic<bool> stop_rebuilding_{false};
  std::unique_ptr<MapPublisher> map_publisher_;
  std::thread worker_;
  std::unique_ptr<CloudInput> input_;
};

}  // namespace beautymap
