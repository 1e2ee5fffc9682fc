// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <string>
#include <vector>

#include "beautymap/evaluation/evaluation.h"
#include "beautymap/io/cloud_fields.h"
#include "beautymap/io/pcd_stream.h"
#include "beautymap/io/scan_conversion.h"
#include "beautymap/io/tool_support.h"

using namespace beautymap;

namespace {

// Intensity of ground truth: 0 static, 1 moving, 2 and more ignored.
constexpr double kMovingAbove = 0.5;
constexpr double kIgnoredAbove = 1.5;

/// f(position, intensity) for each point; the intensity is 0 where the file has none.
template <typename F>
void forEachPoint(const std::string& path, F f) {
  readPcdBlocks(path, [&](const pcl::PCLPointCloud2& block) {
    const PositionReader position(block);
    const bool labelled = FieldReader::has(block, "intensity");
    const FieldReader intensity(block, labelled ? "intensity" : "x");
    for (std::size_t i = 0; i < block.width; ++i) {
      f(position(i), labelled ? intensity(i) : 0.0);
    }
  });
}

Score evaluate(const std::string& ground_truth, const std::string& cleaned, double radius_m,
               std::size_t& cleaned_size) {
  std::vector<Eigen::Vector3d> map;
  forEachPoint(cleaned, [&](const Eigen::Vector3d& point, double) {
    if (point.allFinite()) map.push_back(point);
  });
  cleaned_size = map.size();
  // A cleaned map in the order of the ground truth, as ours is, needs no search for what it kept.
  Evaluator evaluator(radius_m);
  // It may hold ignored points, which the ground truth need not have.
  constexpr std::ptrdiff_t kMostIgnored = 1000;
  auto next = map.begin();
  forEachPoint(ground_truth, [&](const Eigen::Vector3d& point, double intensity) {
    if (!point.allFinite() || intensity > kIgnoredAbove) return;
    const bool moving = intensity > kMovingAbove;
    const auto last = next + std::min<std::ptrdiff_t>(kMostIgnored, map.end() - next);
    const auto same = std::find(next, last, point);
    if (same != last) {
      evaluator.addKept(moving);
      next = same + 1;
    } else {
      evaluator.addUnmatched(point, moving);
    }
  });
  evaluator.finishTruth();
  evaluator.showCleaned(map);
  return evaluator.score();
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Scores a cleaned map: SA, DA, AA, HA at point level, as the dynamic-map benchmark defines "
      "them. A ground-truth point is kept when the cleaned map has a point nearer than the "
      "radius.");
  std::string ground_truth, cleaned;
  double radius_m = 0.05;
  app.add_option("GT", ground_truth,
                 "PCD file with x y z intensity; 0: static, 1: moving, others: not scored, like "
                 "points without a position")
      ->required();
  app.add_option("CLEANED", cleaned, "PCD file with x y z")->required();
  app.add_option("--radius", radius_m, "[m]")->check(CLI::Range(1e-4, 10.0))->capture_default_str();
  return runTool(app, argc, argv, [&] {
    std::size_t cleaned_size = 0;
    const Score s = evaluate(ground_truth, cleaned, radius_m, cleaned_size);
    std::printf("static %llu dynamic %llu cleaned %zu SA %.2f DA %.2f AA %.2f HA %.2f\n",
                static_cast<unsigned long long>(s.static_points),
                static_cast<unsigned long long>(s.dynamic_points), cleaned_size, s.SA(), s.DA(),
                s.AA(), s.HA());
  });
}
