// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <utility>

#include "beautymap/simulation/actor.h"

namespace beautymap::simulation {
namespace {

using Eigen::Vector3d;

/// Offsets of a foot from the place below the hips.
struct Foot {
  double ahead_m;
  double lift_m;
};

/// Each foot stands for half of the cycle, in which the body passes over it by one step's length,
/// and swings ahead in the other half.
Foot footAt(double cycle, double step_m) {
  constexpr double kLift_m = 0.10;
  const double phase = cycle - std::floor(cycle);
  if (phase < 0.5) return {step_m * (0.5 - 2.0 * phase), 0.0};
  const double swing = 2.0 * phase - 1.0;
  return {step_m * (swing - 0.5), kLift_m * std::sin(M_PI * swing)};
}

class Figure {
 public:
  Figure(double height_m, const Placement& place, const World& world)
      : height_(height_m),
        place_(place),
        forward_(std::cos(place.yaw_rad), std::sin(place.yaw_rad), 0.0),
        left_(-forward_.y(), forward_.x(), 0.0) {
    const double step = 0.4 * height_m;
    for (int i = 0; i < 2; ++i) {
      const double side = i == 0 ? 0.1 : -0.1;
      const Foot foot = footAt(place.travelled_m / (2.0 * step) + 0.5 * i, step);
      soles_[i] = place.position + foot.ahead_m * forward_ + side * left_;
      const double support = world.supportHeight(soles_[i]);
      base_z_ += 0.5 * support;
      soles_[i].z() = support + foot.lift_m;
      reach_[i] = foot.ahead_m;
    }
  }

  void addTo(Shapes& shapes) const {
    const std::size_t first = shapes.size();
    for (int i = 0; i < 2; ++i) addLimbs(i, shapes);
    shapes.push_back(makeCapsule(body(0.0, 0.0, 0.50), body(0.02, 0.0, 0.76), 0.165, kCloth));
    shapes.push_back(makeCapsule(body(0.02, 0.0, 0.91), body(0.03, 0.0, 0.94), 0.10, kCloth));
    for (std::size_t i = first; i < shapes.size(); ++i) shapes[i].moving = place_.moving;
  }

 private:
  /// @param ahead, left [m]; up: share of the figure's height.
  Vector3d body(double ahead, double left, double up) const {
    Vector3d point = place_.position + ahead * forward_ + left * left_;
    point.z() = base_z_ + up * height_;
    return point;
  }

  void addLimbs(int i, Shapes& shapes) const {
    const double side = i == 0 ? 1.0 : -1.0;
    const Vector3d hip = body(0.0, 0.09 * side, 0.50);
    const Vector3d ankle = soles_[i] + Vector3d(0.0, 0.0, 0.09);
    const Vector3d knee = 0.5 * (hip + ankle) + 0.05 * forward_;
    const Vector3d toes(0.0, 0.0, 0.045);
    shapes.push_back(makeCapsule(hip, knee, 0.085, kCloth));
    shapes.push_back(makeCapsule(knee, ankle, 0.058, kCloth));
    shapes.push_back(makeCapsule(soles_[i] - 0.05 * forward_ + toes,
                                 soles_[i] + 0.16 * forward_ + toes, 0.045, kRubber));
    const Vector3d hand = body(-0.5 * reach_[i], 0.25 * side, 0.48);
    shapes.push_back(makeCapsule(body(0.0, 0.21 * side, 0.79), hand, 0.048, kCloth));
  }

  double height_;
  const Placement& place_;
  Vector3d forward_;
  Vector3d left_;
  Vector3d soles_[2];
  double reach_[2] = {0.0, 0.0};
  double base_z_ = 0.0;
};

}  // namespace

Actor makePedestrian(double height_m, Motion motion) {
  Actor actor;
  actor.motion = std::move(motion);
  actor.body = [height_m](const Placement& place, const World& world, Shapes& shapes) {
    Figure(height_m, place, world).addTo(shapes);
  };
  return actor;
}

}  // namespace beautymap::simulation
