// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "beautymap/simulation/path.h"

namespace beautymap::simulation {

/// Where somebody is at an instant. The height only chooses the level: bodies are put on the
/// surface that they find there.
struct Placement {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  double yaw_rad = 0.0;
  double travelled_m = 0.0;  ///< turns wheels and swings legs
  bool present = true;
  /// Label of the body's points. Who ever stands where others have seen free space before or see it
  /// after is moving all the time; see arriveAndStay() for the one case in which it changes.
  bool moving = true;
};

using Motion = std::function<Placement(double time_s)>;

/// Goes along the path for ever and starts again at its beginning.
Motion loopAlong(Path path, double speed_m_s, double start_m);

/// Goes along the path, at `start_m + speed * t + sway`: the sway changes the distance to others at
/// the same speed.
Motion swayAlong(Path path, double speed_m_s, double start_m, double sway_m);

/// Stands at `stand_m` until `leave_s`, then accelerates to the speed and is gone at the path's
/// end. Moving all the time: its place is free in the finished map.
Motion standAndLeave(Path path, double stand_m, double leave_s, double speed_m_s);

/// Comes at the speed, brakes and stands at `stop_m` from `stop_s` on. Moving before that instant,
/// static from it on, because it stays until the end.
Motion arriveAndStay(Path path, double stop_m, double stop_s, double speed_m_s);

/// A motion that was computed before: positions and directions of travel each `period_s`.
struct Track {
  std::vector<Eigen::Vector3d> positions;
  std::vector<double> yaws_rad;
  double period_s = 0.1;
};
Motion alongTrack(Track track);

}  // namespace beautymap::simulation
