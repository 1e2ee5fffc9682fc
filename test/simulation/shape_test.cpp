// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/simulation/shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "beautymap/simulation/bvh.h"
#include "beautymap/simulation/random.h"

namespace beautymap::simulation {
namespace {

using Eigen::Vector3d;

constexpr double kTolerance_m = 1e-9;  // rounding of a few double operations at 10 m

Ray rayFromTo(const Vector3d& from, const Vector3d& to) {
  return Ray(from, (to - from).normalized(), 1);
}

Vector3d randomPoint(Random& random, double reach) {
  const double x = random.uniform(-reach, reach);
  const double y = random.uniform(-reach, reach);
  return {x, y, random.uniform(-reach, reach)};
}

Shape randomShape(Random& random) {
  const Vector3d center = randomPoint(random, 10.0);
  const Vector3d other = center + randomPoint(random, 2.0);
  const double size = random.uniform(0.2, 1.5);
  const double kind = random.uniform();
  if (kind < 0.25)
    return makeBox(center, {size, 2.0 * size, 0.7}, random.uniform(0.0, 6.0), kPaint);
  if (kind < 0.5) return makeCylinder(center, other, size, kPaint);
  if (kind < 0.75) return makeCapsule(center, other, size, kPaint);
  return makeEllipsoid(center, Vector3d(size, 2.0 * size, 0.6), kPaint);
}

TEST(ShapeTest, HitsTheFaceOfATurnedBox) {
  const Shape box = makeBox({10.0, 0.0, 0.0}, {2.0, 2.0, 2.0}, M_PI / 4.0, kPaint);
  const auto distance = enterDistance(box, rayFromTo({0, 0, 0}, {1, 0, 0}));
  ASSERT_TRUE(distance);
  EXPECT_NEAR(*distance, 10.0 - std::sqrt(2.0), kTolerance_m);
}

TEST(ShapeTest, HitsACylinderWhereTheCircleIs) {
  const Shape pole = makeCylinder({5.0, 0.3, -1.0}, {5.0, 0.3, 3.0}, 0.5, kPaint);
  const auto distance = enterDistance(pole, rayFromTo({0, 0, 0}, {1, 0, 0}));
  ASSERT_TRUE(distance);
  EXPECT_NEAR(*distance, 5.0 - std::sqrt(0.5 * 0.5 - 0.3 * 0.3), kTolerance_m);
  const auto from_above = enterDistance(pole, rayFromTo({5.1, 0.3, 9.0}, {5.1, 0.3, 0.0}));
  ASSERT_TRUE(from_above);
  EXPECT_NEAR(*from_above, 6.0, kTolerance_m);
  EXPECT_FALSE(enterDistance(pole, rayFromTo({0, 0, 3.1}, {1, 0, 3.1})));
}

TEST(ShapeTest, HitsTheRoundEndOfACapsule) {
  const Shape leg = makeCapsule({5.0, 0.0, 0.0}, {5.0, 0.0, 1.0}, 0.5, kPaint);
  const auto distance = enterDistance(leg, rayFromTo({0, 0, 1.3}, {1, 0, 1.3}));
  ASSERT_TRUE(distance);
  EXPECT_NEAR(*distance, 5.0 - 0.4, kTolerance_m);
  const auto from_above = enterDistance(leg, rayFromTo({5, 0, 4}, {5, 0, 0}));
  ASSERT_TRUE(from_above);
  EXPECT_NEAR(*from_above, 2.5, kTolerance_m);
}

TEST(ShapeTest, HitsAnEllipsoidOnItsLongAxis) {
  const Shape crown = makeEllipsoid({8.0, 0.0, 0.0}, {3.0, 1.0, 1.0}, kPaint);
  const auto distance = enterDistance(crown, rayFromTo({0, 0, 0}, {1, 0, 0}));
  ASSERT_TRUE(distance);
  EXPECT_NEAR(*distance, 5.0, kTolerance_m);
}

TEST(ShapeTest, IgnoresWhatIsBehindOrAround) {
  const Shape box = makeBox({-5.0, 0.0, 0.0}, {2.0, 2.0, 2.0}, 0.0, kPaint);
  EXPECT_FALSE(enterDistance(box, rayFromTo({0, 0, 0}, {1, 0, 0})));
  EXPECT_FALSE(enterDistance(box, rayFromTo({-5, 0, 0}, {1, 0, 0})));
}

TEST(ShapeTest, PutsTheHitOnTheSurfaceWithANormalTowardsTheRay) {
  Random random(7);
  int hits = 0;
  for (int i = 0; i < 3000; ++i) {
    const Shape shape = randomShape(random);
    const Ray ray = rayFromTo(randomPoint(random, 20.0), shape.center + randomPoint(random, 1.0));
    const auto distance = enterDistance(shape, ray);
    if (!distance) continue;
    ++hits;
    EXPECT_NEAR(signedDistance(shape, ray.at(*distance)), 0.0, 1e-6);
    EXPECT_LE(surfaceNormal(shape, ray.at(*distance)).dot(ray.direction), 1e-6);
    EXPECT_TRUE(boundsOf(shape).exteriorDistance(ray.at(*distance)) < 1e-6);
  }
  EXPECT_GT(hits, 1000);
}

TEST(ShapeTest, LetsTheStatedShareOfBeamsThroughAPane) {
  const Shape pane = makeBox({5.0, 0.0, 0.0}, {0.02, 4.0, 4.0}, 0.0, kGlass);
  int stopped = 0;
  constexpr int kBeams = 20000;
  for (int i = 0; i < kBeams; ++i) {
    const Ray ray({0, 0, 0}, Vector3d::UnitX(), hashOf(3, i));
    stopped += stopDistance(pane, ray, 100.0) ? 1 : 0;
  }
  // Five standard deviations of the binomial distribution.
  EXPECT_NEAR(stopped, 0.15 * kBeams, 5.0 * std::sqrt(0.15 * 0.85 * kBeams));
}

TEST(ShapeTest, StopsBeamsInsideOfATreesCrownAndLetsSomePass) {
  const Shape crown = makeEllipsoid({8.0, 0.0, 0.0}, {1.5, 1.5, 1.5}, kLeaves);
  int stopped = 0;
  for (int i = 0; i < 2000; ++i) {
    const Ray ray =
        Ray({0, 0, 0}, Vector3d(8.0, (i % 50) * 0.02, (i / 50) * 0.02).normalized(), hashOf(i));
    const auto distance = stopDistance(crown, ray, 100.0);
    if (!distance) continue;
    ++stopped;
    EXPECT_LE(signedDistance(crown, ray.at(*distance)), 1e-9);
  }
  EXPECT_GT(stopped, 1000);
  EXPECT_LT(stopped, 2000);
}

TEST(BvhTest, FindsTheSameHitAsALoopOverAllShapes) {
  Random random(11);
  Shapes shapes;
  for (int i = 0; i < 200; ++i) shapes.push_back(randomShape(random));
  const Bvh bvh(shapes);
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const Ray ray = rayFromTo(randomPoint(random, 20.0), randomPoint(random, 10.0));
    double nearest = 30.0;
    for (const Shape& shape : shapes) {
      if (const auto distance = stopDistance(shape, ray, nearest))
        nearest = std::min(nearest, *distance);
    }
    double found = 30.0;
    const Shape* shape = bvh.firstOn(ray, found);
    EXPECT_EQ(found, nearest);
    EXPECT_EQ(shape != nullptr, nearest < 30.0);
    hits += shape != nullptr ? 1 : 0;
  }
  EXPECT_GT(hits, 500);
}

TEST(BvhTest, IsEmptyWithoutShapes) {
  double distance = 10.0;
  EXPECT_EQ(Bvh().firstOn(rayFromTo({0, 0, 0}, {1, 0, 0}), distance), nullptr);
  EXPECT_EQ(distance, 10.0);
}

}  // namespace
}  // namespace beautymap::simulation
