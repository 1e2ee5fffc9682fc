// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "beautymap/simulation/sensor.h"
#include "beautymap/simulation/world.h"

namespace beautymap::simulation {

/// One measured point.
struct Return {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< sensor frame [m]
  float intensity = 0.0F;                              ///< 0 to 255
  float time_s = 0.0F;                                 ///< from the scan's start
  std::uint16_t ring = 0;
  bool moving = false;
};

struct ScanRequest {
  const SensorModel& sensor;
  Eigen::Isometry3d T_scene_sensor;
  std::uint64_t seed = 0;
  int scan = 0;
  int threads = 1;
};

/// Casts all beams of a scan and keeps what comes back, in firing order. The result does not depend
/// on the number of threads. A moving surface that is seen in a mirror gives no return: a ghost's
/// label would be a matter of taste; ghosts of fixed surfaces stand still and are labelled static.
std::vector<Return> takeScan(const World& world, const ScanRequest& request);

}  // namespace beautymap::simulation
