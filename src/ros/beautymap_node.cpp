// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <malloc.h>
#include <ros/ros.h>

#include <exception>

#include "beautymap/ros/beautymap_ros.h"

namespace {

/// Every scan needs some ten arrays of megabytes for a moment. By default each is given back to the
/// system at once, and a good part of a scan's time goes into getting and clearing its pages again.
void keepFreedMemory() {
#ifdef __GLIBC__
  constexpr int kMegabyte = 1 << 20;
  mallopt(M_MMAP_THRESHOLD, 32 * kMegabyte);
  mallopt(M_TRIM_THRESHOLD, 128 * kMegabyte);
#endif
}

}  // namespace

int main(int argc, char** argv) {
  keepFreedMemory();
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
