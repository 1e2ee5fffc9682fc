// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/evidence/polar_cap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "beautymap/evidence/beam_visibility.h"
#include "test_scenes.h"

namespace beautymap {
namespace {

/// A sensor in the middle of its column, so that columns are at multiples of half a metre from it,
/// and what it measures.
struct SteepView {
  /// Returns from a level square above or below the sensor, dense enough for every cell.
  void addLevel(double height, double half_width) {
    const double step = 0.004 * std::abs(height);
    for (double x = -half_width; x < half_width; x += step) {
      for (double y = -half_width; y < half_width; y += step) addReturn(x, y, height);
    }
  }
  void addReturn(double x, double y, double z) {
    points.push_back(sensor + Eigen::Vector3d(x, y, z));
  }

  /// Whether the cell is seen free whose middle is at so many columns and so high from the sensor.
  bool seesFree(int x, int y, double height) const {
    const ColumnIndex anchor{-40, 70};
    const PlacedScan scan = test::placedScan(anchor, sensor, points);
    BeamImage beams(config);
    beams.fill(scan);
    const ColumnWindow window{{anchor.x - 60, anchor.y - 60}, 121};
    BitGrid candidates(window, 0);
    constexpr int kBit = 8;
    candidates.at(60 + x, 60 + y) = Bits{1} << kBit;
    const double ground = sensor.z() + height - (kBit + 0.5) * matrix.res_h;
    const HeightGrid heights(window, static_cast<float>(ground));
    const BitGrid free = cellsSeenFree(beams, candidates, heights, scan, matrix, config);
    return free.at(60 + x, 60 + y) != 0;
  }

  Eigen::Vector3d sensor{0.25, 0.25, 1.5};
  std::vector<Eigen::Vector3d> points;
  MatrixConfig matrix;
  VisibilityConfig config;
};

TEST(PolarCap, WhatIsStraightBelowOrAboveIsSeenFreeInFrontOfWhereBeamsEnd) {
  for (const double side : {-1.0, 1.0}) {
    SteepView view;
    view.config.margin = 0.05;
    view.addLevel(side * 20.0, 15.0);
    for (const int x : {-6, 0, 1, 20}) {
      for (const int y : {-20, 0, 3}) {
        EXPECT_TRUE(view.seesFree(x, y, side * 15.0)) << x << ", " << y;
        // The cell's far face with the margin is at 19.99 m, and then at 20.01 m.
        EXPECT_TRUE(view.seesFree(x, y, side * 19.84)) << x << ", " << y;
        EXPECT_FALSE(view.seesFree(x, y, side * 19.86)) << x << ", " << y;
        EXPECT_FALSE(view.seesFree(x, y, side * 21.0)) << x << ", " << y;
        EXPECT_FALSE(view.seesFree(x, y, side * -15.0)) << x << ", " << y;
      }
    }
    EXPECT_TRUE(view.seesFree(0, 0, side * 1.0));
    view.config.blind_radius = 2.0;
    EXPECT_FALSE(view.seesFree(0, 0, side * 1.0));
    EXPECT_TRUE(view.seesFree(0, 0, side * 2.2));
  }
}

TEST(PolarCap, NothingIsSeenFreeWithoutBeams) {
  SteepView view;
  EXPECT_FALSE(view.seesFree(0, 0, -5.0));
  view.addLevel(-20.0, 2.0);
  EXPECT_TRUE(view.seesFree(0, 0, -5.0));
  EXPECT_FALSE(view.seesFree(6, 0, -5.0));
  EXPECT_FALSE(view.seesFree(0, -6, -5.0));
  EXPECT_FALSE(view.seesFree(0, 0, 5.0));
}

TEST(PolarCap, IsEmptyWhereTheImageHasAllBeams) {
  SteepView view;
  const auto capsWith = [&](double slope) {
    view.addReturn(10.0, 0.0, 10.0 * slope);
    BeamImage beams(view.config);
    beams.fill(test::placedScan({0, 0}, view.sensor, view.points));
    return std::count_if(beams.caps().begin(), beams.caps().end(),
                         [](const PolarCap& cap) { return !cap.empty(); });
  };
  EXPECT_EQ(capsWith(1.4), 0);
  EXPECT_EQ(capsWith(2.0), 1);
  EXPECT_EQ(capsWith(-2.0), 2);
}

TEST(PolarCap, AStatedPoseErrorWidensTheCell) {
  SteepView view;
  view.addLevel(-20.0, 8.0);
  view.points.erase(
      std::remove_if(view.points.begin(), view.points.end(),
                     [&](const Eigen::Vector3d& p) { return p.x() - view.sensor.x() > 1.0; }),
      view.points.end());
  // Something high that ends beams from 0.5 m beside the middle of the cell at 10 m.
  for (double x = 0.1; x < 1.0; x += 0.005) {
    for (double y = -0.5; y < 0.5; y += 0.005) view.addReturn(x, y, -2.0);
  }
  EXPECT_TRUE(view.seesFree(0, 0, -10.0));
  view.config.pose_position = 0.1;
  EXPECT_TRUE(view.seesFree(0, 0, -10.0));
  view.config.pose_position = 0.5;
  EXPECT_FALSE(view.seesFree(0, 0, -10.0));
  view.config.pose_position = 0.0;
  view.config.pose_rotation = 3.0;  // 0.5 m at 10 m
  EXPECT_FALSE(view.seesFree(0, 0, -10.0));
  EXPECT_TRUE(view.seesFree(-8, 0, -10.0));
}

/// How beams went that the straight lines of which meet a box.
struct Cast {
  int beams = 0;
  int ended = 0;  ///< in the box or before it, or too little below it
};

/// @param limit_z  beams that end lower have passed
Cast castAgainst(const test::Box& box, double limit_z, const Eigen::Vector3d& sensor,
                 const std::vector<Eigen::Vector3d>& points) {
  Cast cast;
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Array3d ray = (point - sensor).array();
    const Eigen::Array3d a = (box.low - sensor).array() / ray;
    const Eigen::Array3d b = (box.high - sensor).array() / ray;
    if (a.min(b).maxCoeff() >= a.max(b).minCoeff()) continue;
    ++cast.beams;
    cast.ended += point.z() < limit_z ? 0 : 1;
  }
  return cast;
}

/// With a share of 1, no beam through a cell that is seen free may have ended there; and a cell is
/// seen free if all beams in it and closely around it passed.
TEST(PolarCap, AgreesWithBeamsCastAgainstBoxes) {
  constexpr double kMillimetre = 0.002;  // ends are whole millimetres
  int free = 0, not_free = 0, undecided = 0;
  for (std::uint32_t seed = 0; seed < 6; ++seed) {
    test::Random random(seed);
    test::BoxWorld world;
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector3d low(random.uniform(-9, 9), random.uniform(-9, 9),
                                random.chance(0.3) ? random.uniform(0.0, 4.0) : 0.0);
      const Eigen::Vector3d size(random.uniform(0.2, 4), random.uniform(0.2, 4),
                                 random.uniform(0.2, 4));
      world.boxes.push_back({low, low + size});
    }
    const Eigen::Vector3d sensor(random.uniform(0, 0.5), random.uniform(0, 0.5),
                                 random.uniform(12, 25));
    const test::LabelledScan cast = test::castScan(world, sensor, 90, -89.8, -50.0, 400);
    std::vector<Eigen::Vector3d> points;
    for (const auto& p : cast.scan.cloud) points.push_back(p.getVector3fMap().cast<double>());
    const PlacedScan scan = test::placedScan({0, 0}, sensor, points);
    MatrixConfig matrix;
    VisibilityConfig config;
    config.min_share = 1.0;
    PolarCap cap(PolarCap::Side::kBelow, config);
    cap.fill(scan);
    const ColumnWindow window{{-20, -20}, 40};
    const HeightGrid ground(window, 0.0F);
    BitGrid seen(window, 0);
    cap.addSeenFree(BitGrid(window, lowBits(40)), ground, scan, matrix, config, seen, nullptr);
    const double pixel = std::tan(config.pixel_deg * M_PI / 180.0);
    for (int i = 0; i < 1000; ++i) {
      const int x = random.integer(0, 39), y = random.integer(0, 39), bit = random.integer(0, 30);
      const Eigen::Vector3d low((x - 20) * matrix.res_g, (y - 20) * matrix.res_g,
                                bit * matrix.res_h);
      const Eigen::Vector3d high = low + Eigen::Vector3d(matrix.res_g, matrix.res_g, matrix.res_h);
      const double depth = sensor.z() - low.z(), limit = low.z() - config.margin;
      const bool result = (seen.at(x, y) >> bit & 1) != 0;
      const Cast exact = castAgainst({low, high}, limit + kMillimetre, sensor, points);
      // The rectangle around the eight corners, and the pixels that it begins and ends in.
      const double more = matrix.res_h + 2.0 * pixel * depth;
      const Eigen::Vector3d around(more, more, 0.0);
      const Cast wide =
          castAgainst({low - around, high + around}, limit - kMillimetre, sensor, points);
      if (exact.ended > 0) {
        ++not_free;
        ASSERT_FALSE(result) << "seed " << seed << ": " << low.transpose();
      } else if (wide.ended == 0 && exact.beams >= config.min_beams) {
        ++free;
        ASSERT_TRUE(result) << "seed " << seed << ": " << low.transpose();
      } else {
        ++undecided;
      }
    }
  }
  EXPECT_GT(free, 1000);
  EXPECT_GT(not_free, 1000);
  EXPECT_LT(undecided, (free + not_free) / 2);
}

}  // namespace
}  // namespace beautymap
