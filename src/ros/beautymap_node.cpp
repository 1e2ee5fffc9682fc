// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <ros/ros.h>

#include <exception>

#include "beautymap/ros/beautymap_ros.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "beautymap");
  const ros::NodeHandle nh, private_nh("~");  // without one, ROS_FATAL would say nothing
  try {
    const beautymap::BeautyMapRos node(nh, private_nh);
    ros::spin();
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return 1;
  }
  return 0;
}
