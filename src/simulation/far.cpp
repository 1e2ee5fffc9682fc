// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <utility>
#include <vector>

#include "beautymap/simulation/houses.h"
#include "beautymap/simulation/props.h"
#include "beautymap/simulation/random.h"
#include "beautymap/simulation/scene.h"
#include "beautymap/simulation/streetside.h"
#include "beautymap/simulation/traffic.h"

namespace beautymap::simulation {
namespace {

using Eigen::Vector3d;

// The sensor goes round the middle of the square; whoever moves does so on a much wider ring, 50 to
// 80 m from the sensor.
constexpr double kSensorRing_m = 12.0;

Path ring(double radius_m) {
  return PathPen({radius_m, 0.0, 0.0}, M_PI / 2.0).arc(radius_m, 2.0 * M_PI).closed();
}

Vector3d onRing(double radius_m, double angle_rad) {
  return {radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad), 0.0};
}

void furnish(const Ground& ground, Random& random, Shapes& shapes) {
  constexpr int kRow = 18;
  for (int i = 0; i < kRow; ++i) {
    const double angle = 2.0 * M_PI * (i + random.uniform(-0.25, 0.25)) / kRow;
    addTree(onRing(random.uniform(26.0, 40.0), angle), random, shapes);
    addTree(onRing(random.uniform(78.0, 88.0), angle + 0.1), random, shapes);
    if (i % 3 == 0) addLampPost(onRing(22.0, angle + 0.15), angle, shapes);
    if (i % 3 == 1) addBench(onRing(24.0, angle + 0.15), angle - M_PI / 2.0, shapes);
    if (i % 3 == 2) addBin(onRing(46.0, angle), shapes);
    if (i % 4 == 0) {
      const Vector3d from = onRing(48.0, angle);
      addWall(from, onRing(48.0, angle + 0.12), 0.5, 0.3, kConcrete, shapes);
    }
  }
  for (int i = 0; i < 8; ++i) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = Vector3d(-8.0 + 3.2 * i, 42.0, ground.height(-8.0 + 3.2 * i, 42.0));
    pose.linear() = Eigen::AngleAxisd(M_PI / 2.0, Vector3d::UnitZ()).toRotationMatrix();
    addParkedCar(pose, i % 4 == 3 ? CarKind::kVan : CarKind::kSedan, shapes);
  }
  for (const double side : {-1.0, 1.0}) {
    addHouseRow({92.0, side}, -90.0, 90.0, ground, random, shapes);
  }
}

}  // namespace

/// A wide square in which little moves, and all of it far away.
Scene makeFar(std::uint64_t seed) {
  Random random(hashOf(seed, 0xfa4));
  Scene scene;
  const std::uint64_t bumps = random.bits();
  scene.ground = Ground(withBumps(Profile(), -150.0, 150.0, bumps),
                        withBumps(Profile(), -150.0, 150.0, bumps + 1), {}, kAsphalt);
  furnish(scene.ground, random, scene.fixed);
  scene.sensor = loopAlong(ring(kSensorRing_m), 4.0, 0.0);
  scene.actors.push_back(makeCar(CarKind::kSedan, loopAlong(ring(68.0), 7.0, 20.0)));
  scene.actors.push_back(makeCar(CarKind::kVan, loopAlong(ring(68.0), 7.0, 250.0)));
  scene.actors.push_back(makeCyclist(loopAlong(ring(64.5), 4.5, 120.0)));
  for (const double start : {30.0, 33.0, 150.0, 210.0, 330.0}) {
    const double radius = random.uniform(61.5, 63.5);
    scene.actors.push_back(
        makePedestrian(randomHeight(random.bits()), loopAlong(ring(radius), 1.4, start)));
  }
  return scene;
}

}  // namespace beautymap::simulation
