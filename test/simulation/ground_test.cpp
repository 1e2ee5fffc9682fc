// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/simulation/ground.h"

#include <gtest/gtest.h>

#include <cmath>

#include "beautymap/simulation/random.h"

namespace beautymap::simulation {
namespace {

using Eigen::Vector3d;

Ray lookingDown(const Vector3d& from, double depression_rad, double yaw_rad) {
  const Vector3d direction(std::cos(depression_rad) * std::cos(yaw_rad),
                           std::cos(depression_rad) * std::sin(yaw_rad), -std::sin(depression_rad));
  return Ray(from, direction, 1);
}

/// Hills along x, a kerb and a bank across.
Ground hillyGround() {
  return {Profile({{-20.0, 1.0}, {-5.0, 0.0}, {4.0, 0.2}, {15.0, 2.5}, {30.0, 0.5}}),
          Profile({{-8.0, 0.5}, {-4.02, 0.15}, {-4.0, 0.0}, {4.0, 0.0}, {4.02, 0.13}, {12.0, 0.9}}),
          {},
          kAsphalt};
}

TEST(GroundTest, IsHitAtHeightOverSineOnAFlat) {
  const Ground ground;
  for (const double depression : {0.05, 0.3, 1.2}) {
    const auto distance = ground.distance(lookingDown({3.0, -2.0, 1.73}, depression, 0.8), 200.0);
    ASSERT_TRUE(distance);
    EXPECT_NEAR(*distance, 1.73 / std::sin(depression), 1e-9);
  }
}

TEST(GroundTest, IsHitOnASlopeWhereThePlaneIs) {
  const Ground ground(Profile({{-100.0, -10.0}, {100.0, 10.0}}), Profile(), {}, kAsphalt);
  const auto distance = ground.distance(Ray({0, 0, 2}, Vector3d::UnitX(), 1), 100.0);
  ASSERT_TRUE(distance);
  EXPECT_NEAR(*distance, 20.0, 1e-9);
  EXPECT_NEAR(ground.normal(3.0, 0.0).z(), 1.0 / std::sqrt(1.01), 1e-9);
}

TEST(GroundTest, ShowsTheFaceOfAKerb) {
  const Ground ground(Profile(), Profile({{4.0, 0.0}, {4.02, 0.13}}), {}, kAsphalt);
  const auto distance = ground.distance(Ray({0, 0, 0.065}, Vector3d::UnitY(), 1), 100.0);
  ASSERT_TRUE(distance);
  EXPECT_NEAR(*distance, 4.01, 1e-9);
}

TEST(GroundTest, IsNotHitByRaysIntoTheSky) {
  EXPECT_FALSE(hillyGround().distance(lookingDown({0, 0, 2}, -0.5, 1.0), 100.0));
  EXPECT_FALSE(Ground().distance(Ray({0, 0, 2}, Vector3d::UnitX(), 1), 100.0));
  EXPECT_FALSE(Ground().distance(lookingDown({0, 0, 2}, 0.01, 0.0), 100.0));
}

TEST(GroundTest, AgreesWithSmallStepsAlongTheRay) {
  constexpr double kStep_m = 0.002;
  const Ground ground = hillyGround();
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    const double x = random.uniform(-15.0, 15.0);
    const double y = random.uniform(-8.0, 8.0);
    const Vector3d from(x, y, ground.height(x, y) + random.uniform(0.5, 3.0));
    const Ray ray = lookingDown(from, random.uniform(-0.1, 1.0), random.uniform(0.0, 6.28));
    double stepped = 0.0;
    while (stepped < 60.0 &&
           ray.at(stepped).z() > ground.height(ray.at(stepped).x(), ray.at(stepped).y())) {
      stepped += kStep_m;
    }
    const auto distance = ground.distance(ray, 60.0);
    ASSERT_EQ(distance.has_value(), stepped < 60.0);
    // The steps are up to one step late.
    if (distance) {
      EXPECT_NEAR(*distance, stepped - 0.5 * kStep_m, 0.5 * kStep_m + 1e-9);
    }
  }
}

TEST(GroundTest, MirrorsInPuddlesOnly) {
  const Ground ground(Profile(), Profile(), {{{5.0, 1.0}, {1.0, 0.5}}}, kAsphalt);
  EXPECT_GT(ground.materialAt(5.9, 1.0).mirror, 0.0);
  EXPECT_EQ(ground.materialAt(5.0, 1.6).mirror, 0.0);
}

}  // namespace
}  // namespace beautymap::simulation
