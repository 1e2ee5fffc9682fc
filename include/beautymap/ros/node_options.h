// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include <string>
#include <utility>
#include <vector>

#include "beautymap/config/config.h"

namespace beautymap {

/// What the node needs beyond the method's parameters. describe() declares each once: name, value,
/// (smallest, largest, unit,) meaning.
struct NodeOptions {
  std::vector<std::string> cloud_topics{"cloud"};
  std::string pose_source = "tf";
  std::string odom_topic = "odom";
  std::string map_frame = "map";
  std::string sensor_frame;
  double tf_timeout = 1.0;
  int queue_size = 50;
  std::string output_folder = "beautymap";
  bool save_on_exit = false;
  bool reset_on_time_jump = true;
  double publish_period = 2.0;
  double publish_voxel = 0.2;
  double matrix_size = 60.0;
  bool loop_closure = false;
  std::string path_topic = "corrected_path";
  double loop_closure_tolerance = 0.05;
  double loop_closure_min_move = 0.1;

  template <typename Visitor>
  void describe(Visitor& v) {
    v("cloud_topics", cloud_topics,
      "topics with clouds; several LiDARs may be on one or on several");
    v("pose_source", pose_source,
      "`tf`: poses from tf at the clouds' stamps; `odometry`: interpolated from odom_topic");
    v("odom_topic", odom_topic, "nav_msgs/Odometry that gives the poses with pose_source odometry");
    v("map_frame", map_frame, "frame of the map; with odometry it is that of the odometry");
    v("sensor_frame", sensor_frame,
      "frame in which the beams start; needed for clouds that are registered in the map frame; "
      "empty: the clouds' own frame");
    v("tf_timeout", tf_timeout, 0.0, 600.0, "s", "warn when a pose is later than that");
    v("queue_size", queue_size, 1, 10000, "scans",
      "how many scans wait, for their pose and again for being added; the oldest is dropped");
    v("output_folder", output_folder,
      "where the services may read and write; relative to the working directory");
    v("save_on_exit", save_on_exit, false, true, "",
      "save the map as exit.pcd, with its session, at shutdown");
    v("reset_on_time_jump", reset_on_time_jump, false, true, "",
      "when time jumps back (a bag that loops): forget the map; otherwise go on with it");
    v("publish_period", publish_period, 0.1, 3600.0, "s",
      "time between two publications of the map");
    v("publish_voxel", publish_voxel, 0.0, 10.0, "m",
      "the published map has one point per cube of this side; 0: every point");
    v("matrix_size", matrix_size, 1.0, 400.0, "m", "side of the square that ~matrix shows");
    v("loop_closure", loop_closure, false, true, "",
      "keep all scans on disk and make the map again when path_topic moves them");
    v("path_topic", path_topic, "nav_msgs/Path with corrected poses of the sensor");
    v("loop_closure_tolerance", loop_closure_tolerance, 0.0, 10.0, "s",
      "a pose of the path belongs to the scan whose stamp differs by less");
    v("loop_closure_min_move", loop_closure_min_move, 0.0, 100.0, "m",
      "the map is made again when a scan, or what is 10 m away from it, moves farther");
  }
};

/// Reads both from a node's private parameters, nested as in the YAML files of the offline tools.
/// @throws ConfigError for an unknown name or a value of another type or outside its range.
std::pair<NodeOptions, Config> loadParameters(const ros::NodeHandle& private_nh);

/// All parameters of the node with their defaults, for tables.
std::vector<ParameterInfo> listNodeParameters();

/// @throws ConfigError where values contradict each other.
void checkNodeOptions(const NodeOptions& options);

}  // namespace beautymap
