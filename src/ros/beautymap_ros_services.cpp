// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
// The services of BeautyMapRos.
#include "beautymap/online/output_folder.h"
#include "beautymap/online/save_points.h"
#include "beautymap/ros/beautymap_ros.h"

namespace beautymap {

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

}  // namespace beautymap
