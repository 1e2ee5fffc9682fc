// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <nodelet/nodelet.h>

#include <memory>
#include <pluginlib/class_list_macros.hpp>

#include "beautymap/ros/beautymap_ros.h"

namespace beautymap {

class BeautyMapNodelet : public nodelet::Nodelet {
  void onInit() override {
    node_ = std::make_unique<BeautyMapRos>(getNodeHandle(), getPrivateNodeHandle());
  }
  std::unique_ptr<BeautyMapRos> node_;
};

}  // namespace beautymap

PLUGINLIB_EXPORT_CLASS(beautymap::BeautyMapNodelet, nodelet::Nodelet)
