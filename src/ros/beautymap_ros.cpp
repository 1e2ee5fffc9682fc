// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/ros/beautymap_ros.h"

#include <beautymap/ScanReport.h>
#include <pcl_conversions/pcl_conversions.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

#include "beautymap/io/cloud_fields.h"
#include "beautymap/online/output_folder.h"
#include "io/text.h"
#include "io/tf_history.h"

namespace beautymap {
namespace {

using SteadyClock = std::chrono::steady_clock;
constexpr double kWarningPeriod = 5.0;  // [s]
constexpr std::size_t kBehind = 3;      // scans that wait

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

void BeautyMapRos::takePath(const nav_msgs::Path::ConstPtr& path) {
  if (rebuilding_) return;  // the next path comes soon enough
  const std::string frame = stripSlash(path->header.frame_id);
  {
    const std::lock_guard<std::mutex> lock(map_mutex_);
    if (!frame.empty() && !map_frame_.empty() && frame != map_frame_) {
      ROS_WARN_THROTTLE(kWarningPeriod,
                        "the corrected path is in the frame '%s', the map in '%s': not used",
                        frame.c_str(), map_frame_.c_str());
      return;
    }
  }
  StampedPoses corrected;
  for (const auto& stamped : path->poses) {
    const auto& p = stamped.pose.position;
    const auto& q = stamped.pose.orientation;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    const Eigen::Quaterniond rotation(q.w, q.x, q.y, q.z);
    if (!rotation.coeffs().allFinite() || std::abs(rotation.norm() - 1.0) > 0.1) continue;
    pose.linear() = rotation.normalized().toRotationMatrix();
    pose.translation() = Eigen::Vector3d(p.x, p.y, p.z);
    if (pose.matrix().allFinite()) corrected[stamped.header.stamp.toNSec()] = pose;
  }
  const PoseCorrection correction(
      log_->poses(), corrected, static_cast<std::uint64_t>(options_.loop_closure_tolerance * 1e9));
  if (correction.matched() == 0) {
    if (corrected.empty() || log_->size() == 0) return;
    ROS_WARN_THROTTLE(kWarningPeriod,
                      "no pose of the corrected path has the stamp of a scan (within "
                      "~loop_closure_tolerance)");
    return;
  }
  constexpr double kLever = 10.0;  // [m]
  if (std::max(correction.largestMove(), kLever * correction.largestTurn()) <=
      options_.loop_closure_min_move) {
    return;
  }
  stopRebuilding();
  rebuilding_ = true;
  stop_rebuilding_ = false;
  ROS_INFO("the corrected path moves scans by up to %.2f m: the map is made again",
           correction.largestMove());
  rebuild_thread_ = std::thread([this, correction] {
    try {
      rebuild(correction);
    } catch (const std::exception& error) {
      ROS_ERROR("the map could not be made again: %s", error.what());
    }
    rebuilding_ = false;
  });
}

void BeautyMapRos::rebuild(const PoseCorrection& correction) {
  log_->correct(correction);
  log_->rewind();
  const std::shared_ptr<OnlineCleaner> corrected = newCleaner();
  SourceScan scan;
  std::size_t scans = 0;
  const auto addNext = [&] {
    if (stop_rebuilding_ || !log_->next(scan)) return false;
    corrected->add(scan);
    corrected->finish(scan);
    ++scans;
    return true;
  };
  while (addNext()) {
  }
  // The last ones, which came meanwhile, while no further one is added to the present map.
  const std::lock_guard<std::mutex> processing(process_mutex_);
  while (addNext()) {
  }
  if (stop_rebuilding_) return;
  const std::lock_guard<std::mutex> lock(map_mutex_);
  cleaner_ = corrected;
  ROS_INFO("the map was made again from %zu scans", scans);
}

void BeautyMapRos::stopRebuilding() {
  stop_rebuilding_ = true;
  if (rebuild_thread_.joinable()) rebuild_thread_.join();
}

void BeautyMapRos::saveTo(const std::string& path, double voxel_m, bool session,
                          SaveMap::Response& response) {
  const std::string file = pathInFolder(options_.output_folder, path, ".pcd");
  const std::string stem = file.substr(0, file.size() - 4);
  if (!(voxel_m >= 0.0 && voxel_m <= 1000.0)) throw InputError("voxel must be from 0 to 1000 [m]");
  makeParentFolder(file);
  const std::shared_ptr<OnlineCleaner> map = cleaner();
  const auto written = savePoints(*map, file, stem + "_dynamic.pcd", voxel_m);
  if (session) {
    std::string frame;
    {
      const std::lock_guard<std::mutex> lock(map_mutex_);
      frame = map_frame_;
    }
    map->saveSession(stem + ".session", frame);
  }
  response.cleaned_points = written.first;
  response.removed_points = written.second;
  response.success = true;
  response.message = "saved " + std::to_string(written.first) + " points to " + file + " and " +
                     std::to_string(written.second) + " removed ones beside it";
}

bool BeautyMapRos::save(SaveMap::Request& request, SaveMap::Response& response) {
  try {
    saveTo(request.path, static_cast<double>(request.voxel), request.session, response);
  } catch (const std::exception& error) {
    response = SaveMap::Response();
    response.message = error.what();
    ROS_WARN("save_map: %s", error.what());
  }
  return true;
}

bool BeautyMapRos::load(LoadMap::Request& request, LoadMap::Response& response) {
  try {
    const std::string file = pathInFolder(options_.output_folder, request.path, ".session");
    const std::shared_ptr<OnlineCleaner> map = newCleaner();
    const std::string frame = map->loadSession(file);
    std::string present;
    {
      const std::lock_guard<std::mutex> lock(map_mutex_);
      present = map_frame_;
    }
    if (!present.empty() && !frame.empty() && present != frame) {
      throw InputError("the session is in the frame '" + frame + "', the node's map is in '" +
                       present + "'");
    }
    startMap(map);
    response.success = true;
    response.message = "going on with " + std::to_string(map->size().points) + " points of " + file;
  } catch (const std::exception& error) {
    response.success = false;
    response.message = error.what();
    ROS_WARN("load_map: %s", error.what());
  }
  return true;
}

bool BeautyMapRos::reset(std_srvs::Empty::Request&, std_srvs::Empty::Response&) {
  startMap(newCleaner());
  return true;
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
  const OnlineCleaner::Size size = cleaner()->size();
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
  status.add("tiles", size.tiles);
  status.add("tiles on disk", size.tiles_on_disk);
  status.add("memory of the map [MB]", size.memory_mb);
  status.add("last problem",
             totals.last_problem.empty() ? input.last_problem : totals.last_problem);
}

}  // namespace beautymap
