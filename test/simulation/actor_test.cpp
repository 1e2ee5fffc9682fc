// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/simulation/actor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "beautymap/simulation/path.h"

namespace beautymap::simulation {
namespace {

using Eigen::Vector3d;

Path alongX(double length_m) { return Path({{0, 0, 0}, {length_m, 0, 0}}); }

double lowestOf(const Shapes& shapes) {
  double lowest = 1e9;
  for (const Shape& shape : shapes) lowest = std::min(lowest, boundsOf(shape).min().z());
  return lowest;
}

TEST(PathTest, MeasuresAnArcByItsRadius) {
  const Path path = PathPen({0, 0, 0}, 0.0).line(5.0).arc(10.0, M_PI / 2.0).open();
  EXPECT_NEAR(path.length(), 5.0 + 5.0 * M_PI, 0.01);  // chords of 3 deg are that much shorter
  EXPECT_NEAR((path.at(path.length()) - Vector3d(15.0, 10.0, 0.0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR(path.yawAt(2.0), 0.0, 1e-9);
}

TEST(PathTest, GoesOnAtItsBeginningWhenClosed) {
  const Path path({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}}, true);
  EXPECT_NEAR(path.length(), 16.0, 1e-12);
  EXPECT_NEAR((path.at(17.0) - Vector3d(1, 0, 0)).norm(), 0.0, 1e-12);
}

TEST(MotionTest, CarThatLeavesIsMovingAlsoWhileItStands) {
  const Motion motion = standAndLeave(alongX(100.0), 20.0, 5.0, 8.0);
  EXPECT_EQ(motion(0.0).position.x(), 20.0);
  EXPECT_EQ(motion(5.0).position.x(), 20.0);
  EXPECT_TRUE(motion(0.0).moving);
  EXPECT_GT(motion(8.0).position.x(), 25.0);
  EXPECT_FALSE(motion(60.0).present);
}

TEST(MotionTest, CarThatArrivesIsStaticFromItsStopOn) {
  const Motion motion = arriveAndStay(alongX(100.0), 80.0, 6.0, 8.0);
  EXPECT_TRUE(motion(0.0).moving);
  EXPECT_TRUE(motion(5.9).moving);
  EXPECT_LT(motion(5.9).position.x(), 80.0);
  for (const double time_s : {6.0, 6.1, 100.0}) {
    EXPECT_FALSE(motion(time_s).moving);
    EXPECT_EQ(motion(time_s).position.x(), 80.0);
  }
}

TEST(MotionTest, LoopStartsAgain) {
  const Motion motion = loopAlong(alongX(50.0), 10.0, 0.0);
  EXPECT_NEAR(motion(6.0).position.x(), 10.0, 1e-9);
  EXPECT_NEAR(motion(6.0).travelled_m, 60.0, 1e-9);
}

TEST(ActorTest, PedestriansFeetTouchTheGround) {
  const World world({}, Ground(Profile({{0.0, 0.0}, {100.0, 8.0}}), Profile(), {}, kAsphalt));
  const Actor actor = makePedestrian(1.75, loopAlong(Path({{10, 0, 0.8}, {90, 0, 7.2}}), 1.3, 0.0));
  for (double time_s = 0.0; time_s < 3.0; time_s += 0.05) {
    Shapes shapes;
    const Placement place = actor.motion(time_s);
    actor.body(place, world, shapes);
    // One sole stands level on ground that rises by 8 % over half a foot's length.
    double gap = 1e9;
    for (const Shape& shape : shapes) {
      const double below = 0.08 * boundsOf(shape).center().x();
      gap = std::min(gap, boundsOf(shape).min().z() - below);
    }
    EXPECT_NEAR(gap, 0.0, 0.02);
  }
}

TEST(ActorTest, PlantedFootStaysWhereItIs) {
  const World world({}, Ground());
  const Actor actor = makePedestrian(1.75, loopAlong(alongX(50.0), 1.4, 0.0));
  // A step of 0.4 body heights takes half a second; the first foot stands for that time.
  std::vector<double> planted_x;
  for (const double time_s : {0.02, 0.1, 0.2, 0.3, 0.4, 0.48}) {
    Shapes shapes;
    actor.body(actor.motion(time_s), world, shapes);
    planted_x.push_back(boundsOf(shapes[2]).center().x());
  }
  for (const double x : planted_x) EXPECT_NEAR(x, planted_x.front(), 1e-9);
}

TEST(ActorTest, WheelsTouchASlope) {
  const World world({}, Ground(Profile({{0.0, 0.0}, {100.0, 10.0}}), Profile(), {}, kAsphalt));
  const Actor actor =
      makeCar(CarKind::kSedan, loopAlong(Path({{10, 0, 1}, {90, 0, 9}}), 8.0, 20.0));
  Shapes shapes;
  actor.body(actor.motion(0.0), world, shapes);
  int touching = 0;
  for (const Shape& shape : shapes) {
    EXPECT_TRUE(shape.moving);
    if (shape.kind != Shape::Kind::kCylinder) continue;
    const double over_plane = (shape.center.z() - 0.1 * shape.center.x()) / std::sqrt(1.01);
    touching += std::abs(over_plane - shape.half.x()) < 1e-6 ? 1 : 0;
  }
  EXPECT_EQ(touching, 4);
}

TEST(ActorTest, StandsOnTheLevelThatItWalksOn) {
  const World world({makeBlock({-10, -10, 3.5}, {10, 10, 4.0}, kConcrete)}, Ground());
  EXPECT_NEAR(world.supportHeight({0, 0, 4.0}), 4.0, 1e-9);
  EXPECT_NEAR(world.supportHeight({0, 0, 0.0}), 0.0, 1e-9);
  Shapes shapes;
  const Actor actor = makePedestrian(1.7, loopAlong(Path({{-5, 0, 4}, {5, 0, 4}}), 1.0, 2.0));
  actor.body(actor.motion(0.0), world, shapes);
  EXPECT_NEAR(lowestOf(shapes), 4.0, 0.01);
}

}  // namespace
}  // namespace beautymap::simulation
