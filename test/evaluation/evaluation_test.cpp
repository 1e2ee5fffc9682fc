// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/evaluation/evaluation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <thread>
#include <vector>

#include "test_scenes.h"

namespace beautymap {
namespace {

using test::Random;

struct Labelled {
  Eigen::Vector3d point;
  bool moving;
};

/// Every ground-truth point against every point of the cleaned map.
Score bruteForce(const std::vector<Labelled>& truth, const std::vector<Eigen::Vector3d>& cleaned,
                 double radius) {
  Score score;
  for (const Labelled& t : truth) {
    bool kept = false;
    for (const Eigen::Vector3d& c : cleaned) kept = kept || (t.point - c).norm() < radius;
    ++(t.moving ? score.dynamic_points : score.static_points);
    if (kept) ++(t.moving ? score.kept_dynamic : score.kept_static);
  }
  return score;
}

Score evaluate(const std::vector<Labelled>& truth, const std::vector<Eigen::Vector3d>& cleaned,
               double radius) {
  Evaluator evaluator(radius);
  for (const Labelled& t : truth) evaluator.addUnmatched(t.point, t.moving);
  evaluator.finishTruth();
  evaluator.showCleaned(cleaned);
  return evaluator.score();
}

void expectEqual(const Score& a, const Score& b) {
  EXPECT_EQ(a.static_points, b.static_points);
  EXPECT_EQ(a.dynamic_points, b.dynamic_points);
  EXPECT_EQ(a.kept_static, b.kept_static);
  EXPECT_EQ(a.kept_dynamic, b.kept_dynamic);
}

TEST(Evaluation, AgreesWithComparingAllPairs) {
  for (std::uint32_t seed = 0; seed < 30; ++seed) {
    Random random(seed);
    const double radius = random.pick<double>({0.01, 0.05, 0.2, 1.0});
    const Eigen::Vector3d place =
        random.pick<Eigen::Vector3d>({{0, 0, 0}, {-40, 7, -2}, {500000, 5800000, 300}});
    // As dense as a few points per radius, so that many are kept and many are not.
    const auto point = [&] {
      return Eigen::Vector3d(place + radius * Eigen::Vector3d(random.uniform(-6, 6),
                                                              random.uniform(-6, 6),
                                                              random.uniform(-3, 3)));
    };
    std::vector<Labelled> truth;
    for (int i = 0; i < 400; ++i) {
      truth.push_back({point(), random.chance(0.3)});
      if (random.chance(0.2)) truth.push_back({truth.back().point, random.chance(0.5)});
    }
    std::vector<Eigen::Vector3d> cleaned;
    for (int i = 0; i < 250; ++i) {
      cleaned.push_back(random.chance(0.3) ? random.pick(truth).point : point());
    }
    const Score expected = bruteForce(truth, cleaned, radius);
    ASSERT_GT(expected.kept_static, 0U);
    ASSERT_LT(expected.kept_static, expected.static_points);
    expectEqual(evaluate(truth, cleaned, radius), expected);
    random.shuffle(cleaned);
    random.shuffle(truth);
    expectEqual(evaluate(truth, cleaned, radius), expected);
  }
}

TEST(Evaluation, ThreadsAndRepeatedPointsChangeNothing) {
  Random random(7);
  const auto point = [&] {
    return Eigen::Vector3d(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-1, 1));
  };
  std::vector<Labelled> truth;
  for (int i = 0; i < 5000; ++i) truth.push_back({point(), random.chance(0.3)});
  std::vector<Eigen::Vector3d> cleaned;
  for (int i = 0; i < 5000; ++i) cleaned.push_back(point());
  const Score once = evaluate(truth, cleaned, 0.05);
  ASSERT_GT(once.kept_static, 0U);

  constexpr std::uint64_t kTimes = 100;
  Evaluator evaluator(0.05);
  for (std::uint64_t i = 0; i < kTimes; ++i) {
    for (const Labelled& t : truth) evaluator.addUnmatched(t.point, t.moving);
  }
  evaluator.finishTruth();
  std::vector<std::thread> threads;
  for (const auto offset : {0, 1250, 2500, 3750}) {
    const std::vector<Eigen::Vector3d> share(cleaned.begin() + offset,
                                             cleaned.begin() + offset + 1250);
    threads.emplace_back([&evaluator, share] { evaluator.showCleaned(share); });
  }
  for (std::thread& thread : threads) thread.join();
  expectEqual(evaluator.score(), {once.static_points * kTimes, once.dynamic_points * kTimes,
                                  once.kept_static * kTimes, once.kept_dynamic * kTimes});
}

TEST(Evaluation, PlacesFarApartAreNotMixedUp) {
  // 1024 x 1024 x 32 cells of twice the radius are told apart at the first look.
  const double radius = 0.05;
  const Eigen::Vector3d period(102.4, 102.4, 3.2);
  Random random(3);
  const auto point = [&] {
    const Eigen::Vector3d far(random.pick<double>({-2, 0, 3}), random.pick<double>({-1, 0, 1}),
                              random.pick<double>({-3, 0, 1}));
    return Eigen::Vector3d(far.cwiseProduct(period) + Eigen::Vector3d(random.uniform(-0.3, 0.3),
                                                                      random.uniform(-0.3, 0.3),
                                                                      random.uniform(-0.1, 0.1)));
  };
  std::vector<Labelled> truth;
  std::vector<Eigen::Vector3d> cleaned;
  for (int i = 0; i < 2000; ++i) {
    truth.push_back({point(), random.chance(0.3)});
    cleaned.push_back(point());
  }
  const Score expected = bruteForce(truth, cleaned, radius);
  ASSERT_GT(expected.kept_static, 0U);
  expectEqual(evaluate(truth, cleaned, radius), expected);
}

TEST(Evaluation, APointAtExactlyTheRadiusIsNotKept) {
  EXPECT_EQ(evaluate({{{1.0, 2.0, 3.0}, false}}, {{1.25, 2.0, 3.0}}, 0.25).kept_static, 0U);
  EXPECT_EQ(evaluate({{{1.0, 2.0, 3.0}, false}}, {{1.249, 2.0, 3.0}}, 0.25).kept_static, 1U);
}

TEST(Evaluation, WhatTheCleanedMapHoldsItselfIsKept) {
  Evaluator evaluator;
  for (int i = 0; i < 3; ++i) evaluator.addKept(false);
  evaluator.addKept(true);
  evaluator.addUnmatched({0, 0, 0}, true);
  evaluator.addUnmatched({9, 0, 0}, false);
  evaluator.finishTruth();
  evaluator.showCleaned({{0.04, 0, 0}});
  expectEqual(evaluator.score(), {4, 2, 3, 2});
}

TEST(Evaluation, APointIsKeptOnceHoweverManyPointsAreNear) {
  const Eigen::Vector3d p(1.0, 1.0, 1.0);
  EXPECT_EQ(evaluate({{p, false}}, {p, p, p + Eigen::Vector3d(0.01, 0, 0)}, 0.05).kept_static, 1U);
}

TEST(Evaluation, PointsWithoutAPositionAreNotScored) {
  const double nan = test::kNan, infinity = test::kInfinity;
  const std::vector<Labelled> truth{
      {{nan, 0, 0}, false}, {{0, infinity, 0}, true}, {{0, 0, 0}, true}};
  const Score score = evaluate(truth, {{nan, 0, 0}, {0, infinity, 0}, {0, 0, -infinity}}, 0.05);
  expectEqual(score, {0, 1, 0, 0});
}

TEST(Evaluation, HugeCoordinatesAreHandled) {
  for (const double huge : {1e12, 1e19, 3e38, -3e38, 1e300}) {
    const Score score =
        evaluate({{{huge, 1, 1}, true}, {{1, 1, 1}, false}}, {{1, huge, 1}, {1, 1, 1}}, 0.05);
    expectEqual(score, {1, 1, 1, 0});
  }
}

TEST(Evaluation, ScoresFollowTheirFormulas) {
  const Score score{200, 50, 190, 10};
  EXPECT_DOUBLE_EQ(score.SA(), 95.0);
  EXPECT_DOUBLE_EQ(score.DA(), 80.0);
  EXPECT_DOUBLE_EQ(score.AA(), std::sqrt(95.0 * 80.0));
  EXPECT_DOUBLE_EQ(score.HA(), 2.0 * 95.0 * 80.0 / 175.0);
}

TEST(Evaluation, WithoutPointsScoresAreZeroAndNotNan) {
  const Score score;
  EXPECT_EQ(score.SA(), 0.0);
  EXPECT_EQ(score.DA(), 0.0);
  EXPECT_EQ(score.AA(), 0.0);
  EXPECT_EQ(score.HA(), 0.0);
}

TEST(Evaluation, TheRadiusMustBePositive) {
  const double nan = test::kNan, infinity = test::kInfinity;
  for (const double radius : {0.0, -0.05, nan, infinity}) {
    EXPECT_THROW(Evaluator evaluator(radius), std::invalid_argument) << radius;
  }
}

}  // namespace
}  // namespace beautymap
