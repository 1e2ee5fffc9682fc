// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/simulation/motion.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace beautymap::simulation {
namespace {

constexpr double kAcceleration_m_s2 = 2.2;
constexpr double kBraking_m_s2 = 3.0;

Placement placeOn(const Path& path, double distance_m) {
  Placement place;
  place.position = path.at(distance_m);
  place.yaw_rad = path.yawAt(distance_m);
  place.travelled_m = distance_m;
  return place;
}

/// Way from standstill after some time of accelerating to a speed.
double wayFromStart(double time_s, double speed_m_s) {
  const double ramp_s = std::min(time_s, speed_m_s / kAcceleration_m_s2);
  return 0.5 * kAcceleration_m_s2 * ramp_s * ramp_s + speed_m_s * (time_s - ramp_s);
}

}  // namespace

Motion loopAlong(Path path, double speed_m_s, double start_m) {
  return [path = std::move(path), speed_m_s, start_m](double time_s) {
    const double travelled = start_m + speed_m_s * time_s;
    const double rounds = std::floor(travelled / path.length());
    Placement place = placeOn(path, travelled - rounds * path.length());
    place.travelled_m = travelled;
    return place;
  };
}

Motion swayAlong(Path path, double speed_m_s, double start_m, double sway_m) {
  return [path = std::move(path), speed_m_s, start_m, sway_m](double time_s) {
    return placeOn(path, start_m + speed_m_s * time_s + sway_m * std::sin(0.4 * time_s + start_m));
  };
}

Motion standAndLeave(Path path, double stand_m, double leave_s, double speed_m_s) {
  return [path = std::move(path), stand_m, leave_s, speed_m_s](double time_s) {
    const double distance = stand_m + wayFromStart(std::max(0.0, time_s - leave_s), speed_m_s);
    Placement place = placeOn(path, distance);
    place.present = distance <= path.length();
    return place;
  };
}

Motion arriveAndStay(Path path, double stop_m, double stop_s, double speed_m_s) {
  return [path = std::move(path), stop_m, stop_s, speed_m_s](double time_s) {
    const double left_s = std::max(0.0, stop_s - time_s);
    const double ramp_s = std::min(left_s, speed_m_s / kBraking_m_s2);
    const double left_m = 0.5 * kBraking_m_s2 * ramp_s * ramp_s + speed_m_s * (left_s - ramp_s);
    Placement place = placeOn(path, stop_m - left_m);
    place.present = stop_m - left_m >= 0.0;
    place.moving = left_s > 0.0;
    return place;
  };
}

Motion alongTrack(Track track) {
  std::vector<double> travelled{0.0};
  for (std::size_t i = 1; i < track.positions.size(); ++i) {
    travelled.push_back(travelled.back() + (track.positions[i] - track.positions[i - 1]).norm());
  }
  const auto shared = std::make_shared<const Track>(std::move(track));
  return [shared, travelled = std::move(travelled)](double time_s) {
    const double last = static_cast<double>(shared->positions.size() - 1);
    const double index = std::clamp(time_s / shared->period_s, 0.0, last);
    const auto before = static_cast<std::size_t>(std::floor(index));
    const auto after = static_cast<std::size_t>(std::ceil(index));
    const double share = index - std::floor(index);
    Placement place;
    place.position = (1.0 - share) * shared->positions[before] + share * shared->positions[after];
    place.yaw_rad = shared->yaws_rad[before];
    place.travelled_m = (1.0 - share) * travelled[before] + share * travelled[after];
    return place;
  };
}

}  // namespace beautymap::simulation
