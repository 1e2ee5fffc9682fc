// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/simulation/walkers.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "beautymap/simulation/random.h"
#include "beautymap/simulation/traffic.h"

namespace beautymap::simulation {
namespace {

using Eigen::Vector2d;

constexpr double kBody_m = 0.35;     // nearest to walls
constexpr double kPersonal_m = 0.9;  // space that is kept from others
constexpr double kStep_s = 0.1;
constexpr double kTurn_per_s = 3.0;  // how fast the velocity follows the will

struct Walker {
  Vector2d position;
  Vector2d velocity = Vector2d::Zero();
  Vector2d goal;
  double speed_m_s = 1.2;
  double yaw_rad = 0.0;
  double stuck_s = 0.0;
  Random random{0};
  Track track;
};

class Room {
 public:
  explicit Room(const WalkerPlan& plan) : plan_(plan) {
    for (int i = 0; i < plan.people; ++i) {
      Walker walker;
      walker.random = Random(hashOf(plan.seed, 0x3a1, i));
      walker.speed_m_s = walker.random.uniform(0.7, 1.5);
      walker.position = freePlace(walker.random);
      walker.goal = freePlace(walker.random);
      walkers_.push_back(std::move(walker));
    }
  }

  /// One step of time for all; everybody decides by where the others were before it.
  void step(double time_s) {
    const std::vector<Walker> before = walkers_;
    for (std::size_t i = 0; i < walkers_.size(); ++i) {
      Walker& walker = walkers_[i];
      Vector2d will = walker.speed_m_s * (walker.goal - walker.position).normalized();
      for (std::size_t other = 0; other < before.size(); ++other) {
        if (other != i) will += push(walker.position - before[other].position, kPersonal_m);
      }
      for (const Avoided& avoided : plan_.avoided) {
        const Vector2d place = avoided.motion(time_s).position.head<2>();
        will += 2.0 * push(walker.position - place, avoided.radius_m + 0.5);
      }
      move(walker, will);
    }
  }

  void record() {
    for (Walker& walker : walkers_) {
      walker.track.positions.emplace_back(walker.position.x(), walker.position.y(),
                                          plan_.floor_z_m);
      walker.track.yaws_rad.push_back(walker.yaw_rad);
    }
  }

  std::vector<Walker>& walkers() { return walkers_; }

 private:
  static Vector2d push(const Vector2d& away, double reach_m) {
    const double distance = std::max(away.norm(), 0.05);
    if (distance >= reach_m) return Vector2d::Zero();
    return 2.5 * (reach_m - distance) / reach_m * away / distance;
  }

  bool isFree(const Vector2d& place) const {
    for (const auto& obstacle : plan_.obstacles) {
      if (obstacle.exteriorDistance(place) < kBody_m) return false;
    }
    for (const Avoided& avoided : plan_.avoided) {
      const Vector2d start = avoided.motion(0.0).position.head<2>();
      if ((start - place).norm() < avoided.radius_m) return false;
    }
    return true;
  }

  Vector2d freePlace(Random& random) const {
    const Vector2d low = plan_.area.min().array() + kBody_m;
    const Vector2d high = plan_.area.max().array() - kBody_m;
    Vector2d place;
    do {
      place.x() = random.uniform(low.x(), high.x());
      place.y() = random.uniform(low.y(), high.y());
    } while (!isFree(place));
    return place;
  }

  void move(Walker& walker, const Vector2d& will) const {
    walker.velocity += kTurn_per_s * kStep_s * (will - walker.velocity);
    const double speed = walker.velocity.norm();
    if (speed > 1.8) walker.velocity *= 1.8 / speed;
    const Vector2d before = walker.position;
    walker.position = outOfObstacles(before + kStep_s * walker.velocity);
    const Vector2d way = walker.position - before;
    walker.stuck_s = way.norm() < 0.03 ? walker.stuck_s + kStep_s : 0.0;
    if (way.norm() > 0.01) turnTowards(walker, std::atan2(way.y(), way.x()));
    if ((walker.goal - walker.position).norm() < 0.6 || walker.stuck_s > 0.8) {
      walker.goal = freePlace(walker.random);
    }
  }

  static void turnTowards(Walker& walker, double yaw_rad) {
    constexpr double kFastest_rad = 0.35;
    const double turn = std::remainder(yaw_rad - walker.yaw_rad, 2.0 * M_PI);
    walker.yaw_rad += std::clamp(turn, -kFastest_rad, kFastest_rad);
  }

  /// Slides along what is in the way.
  Vector2d outOfObstacles(Vector2d place) const {
    for (const auto& obstacle : plan_.obstacles) {
      const Vector2d low = obstacle.min().array() - kBody_m;
      const Vector2d high = obstacle.max().array() + kBody_m;
      if ((place.array() <= low.array()).any() || (place.array() >= high.array()).any()) continue;
      const double exits[] = {place.x() - low.x(), high.x() - place.x(), place.y() - low.y(),
                              high.y() - place.y()};
      const auto nearest = std::min_element(std::begin(exits), std::end(exits)) - std::begin(exits);
      if (nearest == 0) place.x() = low.x();
      if (nearest == 1) place.x() = high.x();
      if (nearest == 2) place.y() = low.y();
      if (nearest == 3) place.y() = high.y();
    }
    const Vector2d low = plan_.area.min().array() + kBody_m;
    const Vector2d high = plan_.area.max().array() - kBody_m;
    return place.cwiseMax(low).cwiseMin(high);
  }

  const WalkerPlan& plan_;
  std::vector<Walker> walkers_;
};

}  // namespace

std::vector<Actor> makeWalkers(const WalkerPlan& plan) {
  constexpr double kWarmUp_s = 3.0;  // until nobody stands inside of another's space
  Room room(plan);
  for (double time_s = 0.0; time_s < kWarmUp_s; time_s += kStep_s) room.step(0.0);
  const int steps = static_cast<int>(std::ceil(plan.duration_s / kStep_s)) + 1;
  for (int i = 0; i <= steps; ++i) {
    room.record();
    room.step(i * kStep_s);
  }
  std::vector<Actor> actors;
  for (Walker& walker : room.walkers()) {
    actors.push_back(
        makePedestrian(randomHeight(walker.random.bits()), alongTrack(std::move(walker.track))));
  }
  return actors;
}

}  // namespace beautymap::simulation
