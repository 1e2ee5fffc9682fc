// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/evidence/beam_visibility.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "test_scenes.h"

namespace beautymap {
namespace {

using test::Random;

constexpr double kPi = 3.14159265358979323846;
constexpr double kDegree = kPi / 180.0;

TEST(BeamImage, AzimuthGrowsAroundTheCircle) {
  for (const double pixel_deg : {0.05, 0.2, 0.33, 2.0}) {
    VisibilityConfig config;
    config.pixel_deg = pixel_deg;
    const BeamImage beams(config);
    EXPECT_GE(beams.azimuthPixels(), 360.0 / pixel_deg);
    EXPECT_LT(beams.azimuthPixels(), 360.0 / pixel_deg + 5.0);
    float last = 0.0F;
    for (int i = 0; i < 100000; ++i) {
      const double angle = 2.0 * kPi * i / 100000;
      const double radius = 0.5 + i % 7 * 20.0;
      const float azimuth =
          beams.scale().azimuthPixel(static_cast<float>(radius * std::cos(angle)),
                                     static_cast<float>(radius * std::sin(angle)));
      ASSERT_GE(azimuth, 0.0F);
      ASSERT_LE(azimuth, static_cast<float>(beams.azimuthPixels()));
      ASSERT_GE(azimuth, last) << "at " << angle;
      last = azimuth;
    }
  }
}

TEST(BeamImage, TheQuartersOfTheCircleAreAlike) {
  const BeamImage beams((VisibilityConfig()));
  const float quarter = 0.25F * static_cast<float>(beams.azimuthPixels());
  EXPECT_EQ(beams.scale().azimuthPixel(3.0F, 0.0F), 0.0F);
  EXPECT_EQ(beams.scale().azimuthPixel(0.0F, 3.0F), quarter);
  EXPECT_EQ(beams.scale().azimuthPixel(-3.0F, 0.0F), 2.0F * quarter);
  EXPECT_EQ(beams.scale().azimuthPixel(0.0F, -3.0F), 3.0F * quarter);
  EXPECT_EQ(beams.scale().azimuthPixel(2.0F, 2.0F), 0.5F * quarter);
}

TEST(BeamImage, ADirectionJustBelowTheFirstLiesInAPixel) {
  BeamImage beams((VisibilityConfig()));
  beams.fill(test::placedScan({0, 0}, {0, 0, 0}, {{20.0, -1e-9, 0.0}, {20.0, 1e-9, 0.0}}));
  int all = 0;
  for (const int u : {0, beams.azimuthPixels() - 1}) {
    for (int v = beams.firstSlope(); v <= beams.lastSlope(); ++v) {
      all += BeamImage::countOf(beams.row(u)[v - beams.firstSlope()]);
    }
  }
  EXPECT_EQ(all, 2);
}

void expectEqual(const BeamImage& a, const BeamImage& b) {
  ASSERT_EQ(a.azimuthPixels(), b.azimuthPixels());
  ASSERT_EQ(a.slopePixels(), b.slopePixels());
  ASSERT_EQ(a.firstSlope(), b.firstSlope());
  ASSERT_EQ(a.lastSlope(), b.lastSlope());
  for (int u = 0; u < a.azimuthPixels(); ++u) {
    for (int v = 0; v <= a.lastSlope() - a.firstSlope(); ++v) {
      ASSERT_EQ(a.row(u)[v], b.row(u)[v]) << u << ", " << v;
    }
    ASSERT_EQ(a.farthest(u), b.farthest(u));
  }
}

PlacedScan scatteredScan(std::uint32_t seed, int points) {
  Random random(seed);
  std::vector<Eigen::Vector3d> scattered;
  for (int i = 0; i < points; ++i) {
    scattered.emplace_back(random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(-9, 9));
  }
  return test::placedScan({3, -4}, {0.2, 0.1, 1.5}, scattered);
}

TEST(BeamImage, FillingAgainClearsTheScanBefore) {
  VisibilityConfig config;
  config.pixel_deg = 1.0;
  BeamImage beams(config);
  for (std::uint32_t seed = 0; seed < 5; ++seed) {
    beams.fill(scatteredScan(seed, 5000));
    BeamImage fresh(config);
    fresh.fill(scatteredScan(seed, 5000));
    ASSERT_NO_FATAL_FAILURE(expectEqual(beams, fresh));
  }
  beams.fill(scatteredScan(0, 0));
  ASSERT_NO_FATAL_FAILURE(expectEqual(beams, BeamImage(config)));
}

TEST(BeamImage, APixelHoldsItsBeamsAndTheNearestReturn) {
  BeamImage beams((VisibilityConfig()));
  const std::vector<Eigen::Vector3d> points{
      {8, 0.01, 0}, {4, 0.005, 0}, {16, 0.02, 0}, {0.3, 0, 0}};
  beams.fill(test::placedScan({0, 0}, {0, 0, 0}, points));
  const int v = floorToInt(beams.scale().slopePixel(0.0F));
  const BeamImage::Pixel pixel = beams.row(0)[v - beams.firstSlope()];
  EXPECT_EQ(BeamImage::countOf(pixel), 3);
  EXPECT_GT(pixel, BeamImage::limitFor(3.998F));
  EXPECT_LT(pixel, BeamImage::limitFor(4.002F));
  EXPECT_GT(beams.farthest(0), BeamImage::limitFor(15.998F));
  EXPECT_LT(beams.farthest(0), BeamImage::limitFor(16.002F));
  EXPECT_EQ(beams.firstSlope(), v);
  EXPECT_EQ(beams.lastSlope(), v);
}

/// A sensor in the middle of its column, so that the columns along x are at multiples of half a
/// metre, and what it measures.
struct View {
  /// Returns of a dense scanner at a distance, in a sector and between two slopes.
  void addWall(double distance, double low_deg, double high_deg, double low_slope,
               double high_slope) {
    for (double azimuth = low_deg; azimuth < high_deg; azimuth += 0.07) {
      for (double slope = low_slope; slope < high_slope; slope += 0.0013) {
        addReturn(distance, azimuth, slope);
      }
    }
  }
  void addReturn(double distance, double azimuth_deg, double slope) {
    points.push_back(sensor + Eigen::Vector3d(distance * std::cos(azimuth_deg * kDegree),
                                              distance * std::sin(azimuth_deg * kDegree),
                                              distance * slope));
  }

  /// Whether the cell at these multiples of half a metre from the sensor is seen free.
  bool seesFree(int x, int y, double height_above_sensor) const {
    const ColumnIndex anchor{-40, 70};
    const PlacedScan scan = test::placedScan(anchor, sensor, points);
    BeamImage beams(config);
    beams.fill(scan);
    const ColumnWindow window{{anchor.x - 90, anchor.y - 90}, 181};
    BitGrid candidates(window, 0);
    constexpr int kBit = 8;
    candidates.at(90 + x, 90 + y) = Bits{1} << kBit;
    const double ground = sensor.z() + height_above_sensor - (kBit + 0.5) * matrix.res_h;
    const HeightGrid heights(window, static_cast<float>(ground));
    const BitGrid free = cellsSeenFree(beams, candidates, heights, scan, matrix, config);
    Bits any = 0;
    for (int i = 0; i < free.size(); ++i) {
      for (int j = 0; j < free.size(); ++j) {
        any |= free.at(i, j);
        EXPECT_EQ(free.at(i, j) & ~candidates.at(i, j), Bits{0});
      }
    }
    return any != 0;
  }

  Eigen::Vector3d sensor{0.25, 0.25, 1.5};
  std::vector<Eigen::Vector3d> points;
  MatrixConfig matrix;
  VisibilityConfig config;
};

TEST(CellsSeenFree, InFrontOfAWallNotBehindItAndNotInItsMargin) {
  View view;
  view.config.margin = 0.3;
  view.addWall(10.0, -15.0, 15.0, -0.1, 0.1);
  EXPECT_TRUE(view.seesFree(10, 0, 0.0));
  EXPECT_TRUE(view.seesFree(18, 0, 0.0));
  // The margin begins at the cell's far side: 9.5 + 0.25 + 0.3.
  EXPECT_FALSE(view.seesFree(19, 0, 0.0));
  EXPECT_FALSE(view.seesFree(20, 0, 0.0));
  EXPECT_FALSE(view.seesFree(21, 0, 0.0));
  EXPECT_FALSE(view.seesFree(30, 0, 0.0));
  view.config.margin = 0.2;
  EXPECT_TRUE(view.seesFree(19, 0, 0.0));
}

TEST(CellsSeenFree, AllAroundTheSensor) {
  View view;
  view.addWall(15.0, 0.0, 360.0, -0.02, 0.02);
  for (const int x : {-16, -1, 0, 1, 16}) {
    for (const int y : {-16, -1, 0, 1, 16}) {
      if (std::max(std::abs(x), std::abs(y)) < 16) continue;
      EXPECT_TRUE(view.seesFree(x, y, 0.0)) << x << ", " << y;
      EXPECT_FALSE(view.seesFree(2 * x, 2 * y, 0.0)) << x << ", " << y;
    }
  }
}

TEST(CellsSeenFree, NotOutsideTheRangesJudged) {
  View view;
  view.addWall(100.0, -35.0, 35.0, -0.2, 0.2);
  view.config.max_range = 30.0;
  view.config.blind_radius = 3.0;
  EXPECT_FALSE(view.seesFree(5, 0, 0.0));
  EXPECT_TRUE(view.seesFree(7, 0, 0.0));
  EXPECT_TRUE(view.seesFree(59, 0, 0.0));
  EXPECT_FALSE(view.seesFree(61, 0, 0.0));
}

TEST(CellsSeenFree, NotBetweenTwoRings) {
  View view;
  for (int ring = -15; ring <= 15; ring += 2) {
    for (double azimuth = -10.0; azimuth < 10.0; azimuth += 0.2) {
      view.addReturn(50.0, azimuth, std::tan(ring * kDegree));
    }
  }
  const double ring_height = 20.0 * std::tan(1.0 * kDegree);
  EXPECT_TRUE(view.seesFree(40, 0, ring_height));
  EXPECT_TRUE(view.seesFree(40, 0, -ring_height));
  EXPECT_FALSE(view.seesFree(40, 0, 0.0));
  EXPECT_FALSE(view.seesFree(40, 0, 2.0 * ring_height));
  // Nearby the same cell is so large that a ring passes through it.
  EXPECT_TRUE(view.seesFree(8, 0, 0.0));
}

TEST(CellsSeenFree, NotWhereNothingReturned) {
  View view;
  EXPECT_FALSE(view.seesFree(10, 0, 0.0));
  view.addWall(30.0, -20.0, -3.0, -0.1, 0.1);
  view.addWall(30.0, 3.0, 20.0, -0.1, 0.1);
  EXPECT_FALSE(view.seesFree(30, 0, 0.0));
  EXPECT_TRUE(view.seesFree(30, 4, 0.0));
  EXPECT_TRUE(view.seesFree(30, -4, 0.0));
  EXPECT_FALSE(view.seesFree(30, 4, 3.0));
}

TEST(CellsSeenFree, NotWhereHalfOfTheBeamsAreBlocked) {
  View view;
  view.addWall(8.0, -20.0, 0.0, -0.1, 0.1);
  view.addWall(40.0, 0.0, 20.0, -0.1, 0.1);
  EXPECT_FALSE(view.seesFree(40, 0, 0.0));
  EXPECT_TRUE(view.seesFree(40, 2, 0.0));
  EXPECT_FALSE(view.seesFree(40, -2, 0.0));
  // In front of both walls all have passed.
  EXPECT_TRUE(view.seesFree(12, 0, 0.0));
}

TEST(CellsSeenFree, NeedsAsManyBeamsAsConfigured) {
  View view;
  for (const double azimuth : {-0.35, 0.05, 0.45}) view.addReturn(30.0, azimuth, 0.0005);
  view.config.min_beams = 3;
  EXPECT_TRUE(view.seesFree(20, 0, 0.0));
  view.config.min_beams = 4;
  EXPECT_FALSE(view.seesFree(20, 0, 0.0));
}

TEST(CellsSeenFree, OneBeamThatEndsInTheCellIsOutvotedByMany) {
  View view;
  view.addWall(30.0, -5.0, 5.0, -0.05, 0.05);
  view.addReturn(10.0, 0.1, 0.001);
  EXPECT_TRUE(view.seesFree(20, 0, 0.0));
  view.config.min_share = 1.0;
  EXPECT_FALSE(view.seesFree(20, 0, 0.0));
}

TEST(CellsSeenFree, AStatedPositionErrorWidensTheCell) {
  View view;
  view.addWall(40.0, -20.0, 20.0, -0.1, 0.1);
  view.addWall(10.0, 1.2, 20.0, -0.1, 0.1);  // a wall's end 0.2 m beside the cell at 20 m
  EXPECT_TRUE(view.seesFree(40, 0, 0.0));
  view.config.pose_position = 0.1;
  EXPECT_TRUE(view.seesFree(40, 0, 0.0));
  view.config.pose_position = 0.6;
  EXPECT_FALSE(view.seesFree(40, 0, 0.0));
  // Upwards, too.
  view.points.clear();
  view.addWall(40.0, -20.0, 20.0, -0.1, 0.01);
  view.addWall(10.0, -20.0, 20.0, 0.01, 0.1);
  view.config.pose_position = 0.0;
  EXPECT_TRUE(view.seesFree(40, 0, 0.0));
  view.config.pose_position = 0.3;
  EXPECT_FALSE(view.seesFree(40, 0, 0.0));
}

TEST(CellsSeenFree, AStatedPoseErrorWidensTheMargin) {
  View view;
  view.config.margin = 0.3;
  view.addWall(10.0, -25.0, 25.0, -0.2, 0.2);
  EXPECT_TRUE(view.seesFree(18, 0, 0.0));
  view.config.pose_position = 0.5;
  EXPECT_TRUE(view.seesFree(17, 0, 0.0));
  EXPECT_FALSE(view.seesFree(18, 0, 0.0));
}

TEST(CellsSeenFree, AStatedRotationErrorGrowsWithTheRange) {
  // A roof edge: beams pass right above it, 0.1 m above the cell's bottom.
  const auto sees = [](int x, double rotation_deg) {
    View view;
    const double distance = 0.5 * x, bottom = -0.1 / distance;
    view.addWall(distance, -20.0, 20.0, -0.2, bottom - 0.004);
    view.addWall(90.0, -20.0, 20.0, bottom - 0.004, 0.2);
    view.config.pose_rotation = rotation_deg;
    return view.seesFree(x, 0, 0.0);
  };
  EXPECT_TRUE(sees(10, 0.0));
  EXPECT_TRUE(sees(10, 0.25));  // 2 cm
  EXPECT_TRUE(sees(80, 0.0));
  EXPECT_FALSE(sees(80, 0.25));  // 17 cm
}

TEST(CellsSeenFree, AStatedPoseErrorOnlyTakesCellsAway) {
  for (std::uint32_t seed = 0; seed < 5; ++seed) {
    const PlacedScan scan = scatteredScan(seed, 20000);
    MatrixConfig matrix;
    VisibilityConfig config;
    config.pixel_deg = 1.0;
    BeamImage beams(config);
    beams.fill(scan);
    const ColumnWindow window{{3 - 40, -4 - 40}, 81};
    const BitGrid candidates(window, ~Bits{0});
    const HeightGrid ground(window, -3.0F);
    const auto seen = [&](double position, double rotation_deg) {
      config.pose_position = position;
      config.pose_rotation = rotation_deg;
      return cellsSeenFree(beams, candidates, ground, scan, matrix, config);
    };
    const BitGrid exact = seen(0.0, 0.0);
    for (const double rotation : {0.0, 0.2, 2.0}) {
      const BitGrid uncertain = seen(0.05, rotation);
      int taken = 0;
      for (int x = 0; x < exact.size(); ++x) {
        for (int y = 0; y < exact.size(); ++y) {
          ASSERT_EQ(uncertain.at(x, y) & ~exact.at(x, y), Bits{0});
          taken += __builtin_popcountll(exact.at(x, y) & ~uncertain.at(x, y));
        }
      }
      EXPECT_GT(taken, 0);
    }
  }
}

/// Rounding to float moves a position in the image by far less: there are a few hundred pixels, all
/// coordinates are dyadic, and a handful of operations are rounded.
constexpr double kRounding = 1e-4;  // [pixels] and [m]

bool nearInteger(double value) { return std::abs(value - std::round(value)) < kRounding; }

/// The image's geometry in double.
struct Geometry {
  explicit Geometry(const VisibilityConfig& config)
      : azimuths(4 * static_cast<int>(std::ceil(std::ceil(360.0 / config.pixel_deg) / 4.0))),
        slope_size(std::tan(config.pixel_deg * kDegree)),
        slopes(static_cast<int>(std::floor(3.0 / slope_size)) + 1) {}

  double azimuth(double x, double y) const {
    double quarters = 0.0;
    if (x >= 0.0 && y >= 0.0) quarters = y / (x + y);
    if (x < 0.0 && y >= 0.0) quarters = 1.0 - x / (y - x);
    if (x < 0.0 && y < 0.0) quarters = 2.0 + y / (x + y);
    if (x >= 0.0 && y < 0.0) quarters = 3.0 + x / (x - y);
    return quarters * azimuths / 4.0;
  }
  double slope(double value) const { return (value + 1.5) / slope_size; }
  /// Of a position on a plane one metre above or below the sensor.
  double tangent(double value) const { return (value + 1.0) / slope_size; }
  bool inBand(const Eigen::Vector3d& ray) const {
    const double length = std::hypot(ray.x(), ray.y());
    const double pixel = std::floor(slope(ray.z() / length));
    return length >= 0.5 && pixel >= 0.0 && pixel < slopes;
  }

  int azimuths;
  double slope_size;
  int slopes;
};

/// A random scan, and random columns around a random sensor.
struct Case {
  explicit Case(std::uint32_t seed) {
    Random random(seed);
    matrix.res_g = random.pick<double>({0.25, 0.5, 1.0, 1.5});
    matrix.res_h = dyadic(random.uniform(0.1, 0.6));
    config.pixel_deg = random.pick<double>({1.0, 1.7, 2.0});
    config.min_beams = random.integer(1, 4);
    config.min_share = random.pick<double>({0.5, 0.8, 1.0});
    config.margin = dyadic(random.uniform(0.0, 1.0));
    config.blind_radius = random.uniform(0.0, 4.0);
    config.max_range = random.uniform(5.0, 25.0);
    anchor = {random.integer(-5000, 5000), random.integer(-5000, 5000)};
    sensor = {dyadic(random.uniform(-2.0, 2.0)), dyadic(random.uniform(-2.0, 2.0)),
              dyadic(random.uniform(-2.0, 4.0))};
    addPoints(random);
    const ColumnWindow window{{anchor.x - random.integer(5, 20), anchor.y - random.integer(5, 20)},
                              26};
    candidates = BitGrid(window, 0);
    ground = HeightGrid(window, 0.0F);
    for (int x = 0; x < window.size; ++x) {
      for (int y = 0; y < window.size; ++y) {
        ground.at(x, y) = static_cast<float>(dyadic(random.uniform(-4.0, 1.0)));
        if (random.chance(0.4)) {
          candidates.at(x, y) =
              random.bits() & random.bits() & lowBits(random.pick<int>({16, 16, 64}));
        }
      }
    }
  }

  static double dyadic(double value) { return test::dyadic(value); }

  /// Each sector has a distance of its own, and some returns come from elsewhere.
  void addPoints(Random& random) {
    const Geometry geometry(config);
    std::array<double, 12> sectors{};
    for (double& sector : sectors) sector = random.uniform(1.0, 30.0);
    for (int i = random.integer(0, 3000); i > 0; --i) {
      const double turn = random.uniform(0.0, 1.0);
      double distance = sectors[static_cast<std::size_t>(turn * 12.0)] + random.uniform(0.0, 1.0);
      if (random.chance(0.05)) distance = random.uniform(0.1, 30.0);
      const double steepest = random.chance(0.4) ? 8.0 : 0.5;
      const double slope = random.uniform(-steepest, steepest);
      const Eigen::Vector3d ray(dyadic(distance * std::cos(2.0 * kPi * turn)),
                                dyadic(distance * std::sin(2.0 * kPi * turn)),
                                dyadic(distance * slope));
      const double length = std::hypot(ray.x(), ray.y());
      // Float may put a point near a border into either pixel.
      if (std::abs(length - 0.5) < kRounding) continue;
      if (nearInteger(geometry.azimuth(ray.x(), ray.y()))) continue;
      if (nearInteger(geometry.slope(ray.z() / length))) continue;
      const double height = std::abs(ray.z());
      if (std::abs(height - std::max(std::abs(ray.x()), std::abs(ray.y()))) < kRounding) continue;
      if (nearInteger(geometry.tangent(ray.x() / height))) continue;
      if (nearInteger(geometry.tangent(ray.y() / height))) continue;
      points.push_back(sensor + ray);
      if (!geometry.inBand(ray)) any_too_steep = true;
    }
  }

  MatrixConfig matrix;
  VisibilityConfig config;
  ColumnIndex anchor;
  Eigen::Vector3d sensor;
  std::vector<Eigen::Vector3d> points;
  bool any_too_steep = false;
  BitGrid candidates;
  HeightGrid ground;
};

/// A cell's angular footprint [pixels], not yet whole numbers.
struct Footprint {
  double azimuth_low, azimuth_high, slope_low, slope_high;
};

Footprint footprintOf(const Case& c, const Geometry& geometry, const Eigen::Vector2d& centre,
                      double bottom) {
  const double distance = centre.norm();
  const Eigen::Vector2d across(-centre.y() / distance, centre.x() / distance);
  const Eigen::Vector2d right = centre - 0.5 * c.matrix.res_g * across;
  const Eigen::Vector2d left = centre + 0.5 * c.matrix.res_g * across;
  Footprint f{geometry.azimuth(right.x(), right.y()), geometry.azimuth(left.x(), left.y()),
              geometry.slope(bottom / distance),
              geometry.slope((bottom + c.matrix.res_h) / distance)};
  if (f.azimuth_high < f.azimuth_low) f.azimuth_high += geometry.azimuths;
  return f;
}

/// The pixels that beams of a footprint ended in.
class Pixels {
 public:
  void add(int u, int v, double distance) {
    Pixel& pixel = pixels_[{u, v}];
    ++pixel.beams;
    pixel.nearest = std::min(pixel.nearest, distance);
  }
  /// Nothing where float may round a distance to the other side of the limit.
  std::optional<bool> seeFree(double behind, const VisibilityConfig& config) const {
    int passed = 0, all = 0;
    for (const auto& [position, pixel] : pixels_) {
      // Distances are whole millimetres.
      if (std::abs(pixel.nearest - behind) < 0.001 + kRounding) return std::nullopt;
      all += pixel.beams;
      if (pixel.nearest > behind) passed += pixel.beams;
    }
    return passed >= config.min_beams && passed >= config.min_share * all;
  }

 private:
  struct Pixel {
    int beams = 0;
    double nearest = 1e9;
  };
  std::map<std::pair<int, int>, Pixel> pixels_;
};

/// From the sensor to the centre of a column.
Eigen::Vector2d centreOf(const Case& c, int x, int y) {
  const ColumnIndex corner = c.candidates.window().corner;
  return {(corner.x - c.anchor.x + x + 0.5) * c.matrix.res_g - c.sensor.x(),
          (corner.y - c.anchor.y + y + 0.5) * c.matrix.res_g - c.sensor.y()};
}

/// Whether the beams between the slopes of the image see a cell free; nothing where float may round
/// a footprint's border into another pixel, or a distance to the other side of a limit.
std::optional<bool> seenFreeInBand(const Case& c, int x, int y, int bit) {
  const Geometry geometry(c.config);
  const Eigen::Vector2d centre = centreOf(c, x, y);
  const double distance = centre.norm();
  // So near that the column fills much of the view.
  const double nearest = std::max(0.5 + c.matrix.res_g, c.config.blind_radius);
  if (std::abs(distance - nearest) < kRounding) return std::nullopt;
  if (std::abs(distance - c.config.max_range) < kRounding) return std::nullopt;
  if (distance < nearest || distance > c.config.max_range) return false;

  const double ground = static_cast<double>(c.ground.at(x, y));
  const Footprint f =
      footprintOf(c, geometry, centre, ground + bit * c.matrix.res_h - c.sensor.z());
  for (const double border : {f.azimuth_low, f.azimuth_high, f.slope_low, f.slope_high}) {
    if (nearInteger(border)) return std::nullopt;
  }
  if (f.slope_low < 0.0 || f.slope_high >= geometry.slopes) return false;

  Pixels pixels;
  for (const Eigen::Vector3d& point : c.points) {
    const Eigen::Vector3d ray = point - c.sensor;
    const double length = std::hypot(ray.x(), ray.y());
    if (length < 0.5) continue;
    const int v = static_cast<int>(std::floor(geometry.slope(ray.z() / length)));
    if (v < std::floor(f.slope_low) || v > std::floor(f.slope_high)) continue;
    const int u = static_cast<int>(std::floor(geometry.azimuth(ray.x(), ray.y())));
    for (const int turned : {u, u + geometry.azimuths}) {
      if (turned < std::floor(f.azimuth_low) || turned > std::floor(f.azimuth_high)) continue;
      pixels.add(u, v, length);
    }
  }
  return pixels.seeFree(distance + 0.5 * c.matrix.res_g + c.config.margin, c.config);
}

/// The same for the beams above (side 1) or below (side -1), if any beam is too steep for the
/// image.
std::optional<bool> seenFreeInCap(const Case& c, int x, int y, int bit, double side) {
  const Geometry geometry(c.config);
  if (!c.any_too_steep) return false;
  const Eigen::Vector2d centre = centreOf(c, x, y);
  const double bottom =
      static_cast<double>(c.ground.at(x, y)) + bit * c.matrix.res_h - c.sensor.z();
  const double top = bottom + c.matrix.res_h;
  const double near = std::min(side * bottom, side * top);
  const double far = near + c.matrix.res_h;
  // The rectangle around the corners.
  Eigen::Array2d lowest(1e9, 1e9), highest(-1e9, -1e9);
  for (const double face : {near, far}) {
    for (const double half : {-0.5 * c.matrix.res_g, 0.5 * c.matrix.res_g}) {
      lowest = lowest.min((centre.array() + half) / face);
      highest = highest.max((centre.array() + half) / face);
    }
  }
  const double nearest = std::max(0.5, c.config.blind_radius);
  const double aside = centre.cwiseAbs().maxCoeff() + 0.5 * c.matrix.res_g;
  if (std::abs(near - std::max(nearest, aside)) < kRounding) return std::nullopt;
  if (std::abs(centre.norm() - c.config.max_range) < kRounding) return std::nullopt;
  if (near < nearest || near < aside || centre.norm() > c.config.max_range) return false;
  for (const double border : {lowest.x(), lowest.y(), highest.x(), highest.y()}) {
    if (nearInteger(geometry.tangent(border))) return std::nullopt;
  }
  const auto pixel = [&](double tangent) {
    return static_cast<int>(std::floor(geometry.tangent(tangent)));
  };
  Pixels pixels;
  for (const Eigen::Vector3d& point : c.points) {
    const Eigen::Vector3d ray = point - c.sensor;
    const double height = side * ray.z();
    if (std::max(std::abs(ray.x()), std::abs(ray.y())) > height) continue;
    const int u = pixel(ray.x() / height), v = pixel(ray.y() / height);
    if (u < pixel(lowest.x()) || u > pixel(highest.x())) continue;
    if (v < pixel(lowest.y()) || v > pixel(highest.y())) continue;
    pixels.add(u, v, height);
  }
  return pixels.seeFree(far + c.config.margin, c.config);
}

TEST(CellsSeenFree, AgreesWithALoopOverAllPoints) {
  int free = 0, not_free = 0, undecided = 0, steeply = 0;
  for (std::uint32_t seed = 0; seed < 30; ++seed) {
    const Case c(seed);
    const PlacedScan scan = test::placedScan(c.anchor, c.sensor, c.points);
    BeamImage beams(c.config);
    beams.fill(scan);
    const BitGrid result = cellsSeenFree(beams, c.candidates, c.ground, scan, c.matrix, c.config);
    ASSERT_EQ(result.window().corner, c.candidates.window().corner);
    for (int x = 0; x < result.size(); ++x) {
      for (int y = 0; y < result.size(); ++y) {
        ASSERT_EQ(result.at(x, y) & ~c.candidates.at(x, y), Bits{0});
        for (int bit = 0; bit < kMaxBits; ++bit) {
          if ((c.candidates.at(x, y) >> bit & 1) == 0) continue;
          const std::optional<bool> between = seenFreeInBand(c, x, y, bit);
          const std::optional<bool> below = seenFreeInCap(c, x, y, bit, -1.0);
          const std::optional<bool> above = seenFreeInCap(c, x, y, bit, 1.0);
          if (!between || !below || !above) {
            ++undecided;
            continue;
          }
          const bool expected = *between || *below || *above;
          ASSERT_EQ((result.at(x, y) >> bit & 1) != 0, expected)
              << "seed " << seed << " column " << x << ", " << y << " bit " << bit;
          ++(expected ? free : not_free);
          steeply += !*between && expected ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(free, 2000);
  EXPECT_GT(not_free, 2000);
  EXPECT_GT(steeply, 200);
  EXPECT_LT(undecided, (free + not_free) / 100);
}

TEST(CellsSeenFree, WhatTooFewBeamsPassedIsWhatOneBeamWouldAdd) {
  int many = 0;
  for (std::uint32_t seed = 0; seed < 30; ++seed) {
    const Case c(seed);
    const PlacedScan scan = test::placedScan(c.anchor, c.sensor, c.points);
    BeamImage beams(c.config);
    beams.fill(scan);
    BitGrid few;
    const BitGrid free = cellsSeenFree(beams, c.candidates, c.ground, scan, c.matrix, c.config,
                                       BitGrid(c.candidates.window(), ~Bits{0}), &few);
    VisibilityConfig one_beam = c.config;
    one_beam.min_beams = 1;
    const BitGrid any = cellsSeenFree(beams, c.candidates, c.ground, scan, c.matrix, one_beam);
    for (int x = 0; x < free.size(); ++x) {
      for (int y = 0; y < free.size(); ++y) {
        ASSERT_EQ(few.at(x, y), any.at(x, y) & ~free.at(x, y)) << "seed " << seed;
        many += few.at(x, y) != 0 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(many, 100);
}

}  // namespace
}  // namespace beautymap
