// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/simulation/scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "beautymap/simulation/simulated_source.h"

namespace beautymap::simulation {
namespace {

using Eigen::Vector3d;

bool isSolid(const Shape& shape) { return shape.material.foliage == 0.0; }

class EveryScene : public testing::TestWithParam<std::string> {};

TEST_P(EveryScene, KeepsTheSensorOutOfAllThings) {
  SimulationOptions options;
  options.scene = GetParam();
  options.sensor = "vlp16";
  options.scans = 600;
  const SimulatedSource source(options);
  for (int scan = 0; scan < options.scans; scan += 5) {
    const Vector3d place = source.sensorInScene(scan).translation();
    ASSERT_TRUE(place.allFinite());
    for (const Shape& shape : source.world().fixedShapes()) {
      ASSERT_GT(signedDistance(shape, place), 0.2) << "scan " << scan;
    }
  }
}

TEST_P(EveryScene, NobodyWalksOrDrivesThroughSolidThings) {
  const Scene scene = makeScene(GetParam(), 20.0, 3);
  const World world(scene.fixed, scene.ground);
  for (double time_s = 0.0; time_s < 20.0; time_s += 1.3) {
    for (const Actor& actor : scene.actors) {
      const Placement place = actor.motion(time_s);
      if (!place.present) continue;
      Shapes body;
      actor.body(place, world, body);
      for (const Shape& part : body) {
        for (const Shape& shape : world.fixedShapes()) {
          if (!isSolid(shape) || !boundsOf(shape).intersects(boundsOf(part))) continue;
          // Feet on stairs cut the noses of the steps; the middle of no part may be deep in
          // anything.
          ASSERT_GT(signedDistance(shape, part.center), -0.08)
              << "at " << part.center.transpose() << " in the thing at " << shape.center.transpose()
              << ", time " << time_s;
        }
      }
    }
  }
}

TEST_P(EveryScene, IsTheSameForTheSameSeed) {
  const Scene one = makeScene(GetParam(), 10.0, 5);
  const Scene two = makeScene(GetParam(), 10.0, 5);
  ASSERT_EQ(one.fixed.size(), two.fixed.size());
  for (std::size_t i = 0; i < one.fixed.size(); ++i) {
    ASSERT_EQ(one.fixed[i].center, two.fixed[i].center);
  }
  ASSERT_EQ(one.actors.size(), two.actors.size());
  for (std::size_t i = 0; i < one.actors.size(); ++i) {
    ASSERT_EQ(one.actors[i].motion(6.0).position, two.actors[i].motion(6.0).position);
  }
}

INSTANTIATE_TEST_SUITE_P(All, EveryScene, testing::ValuesIn(sceneNames()),
                         [](const auto& test) { return test.param; });

TEST(SceneTest, FarScenesActorsAreFiftyToEightyMetresAway) {
  const Scene scene = makeScene("far", 60.0, 1);
  for (double time_s = 0.0; time_s < 60.0; time_s += 0.5) {
    const Vector3d sensor = scene.sensor(time_s).position;
    for (const Actor& actor : scene.actors) {
      const double distance = (actor.motion(time_s).position - sensor).norm();
      EXPECT_GE(distance, 49.0);
      EXPECT_LE(distance, 81.0);
    }
  }
}

TEST(SceneTest, SomebodyFollowsTheRobotInTheCrowd) {
  const Scene scene = makeScene("crowd", 60.0, 1);
  for (double time_s = 0.0; time_s < 60.0; time_s += 0.5) {
    const Vector3d robot = scene.sensor(time_s).position;
    const Vector3d follower = scene.actors.back().motion(time_s).position;
    EXPECT_NEAR((robot - follower).norm(), 1.75, 0.25);
  }
}

TEST(SceneTest, WaitingCarsLeaveAndOthersArriveAndStay) {
  constexpr double kDuration_s = 20.0;
  const Scene scene = makeScene("waiting", kDuration_s, 1);
  int leave = 0;
  int stay = 0;
  for (const Actor& actor : scene.actors) {
    const Placement begin = actor.motion(0.0);
    const Placement early = actor.motion(0.3 * kDuration_s);
    const Placement end = actor.motion(kDuration_s);
    const bool stood = begin.present && begin.position == early.position;
    if (stood && (!end.present || (end.position - begin.position).norm() > 5.0)) {
      EXPECT_TRUE(begin.moving);
      ++leave;
    }
    if (begin.moving && !end.moving) ++stay;
  }
  EXPECT_GE(leave, 6);
  EXPECT_EQ(stay, 3);
}

TEST(SceneTest, RefusesAnUnknownName) {
  EXPECT_THROW(makeScene("moon", 1.0, 1), std::invalid_argument);
}

}  // namespace
}  // namespace beautymap::simulation
