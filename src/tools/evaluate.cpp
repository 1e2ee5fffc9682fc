// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>
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

template <typename F>
void forEachPoint(const std::string& path, F f) {
  readPcdBlocks(path, [&](const pcl::PCLPointCloud2& block) {
    const PositionReader position(block);
    const bool labelled = FieldReader::has(block, "intensity");
    const FieldReader intensity(block, labelled ? "intensity" : "x");
    for (std::size_t i = 0; i < block.width; ++i) {
      f(position(i), labelled && intensity(i) > 0.5);
    }
  });
}

Score evaluate(const std::string& ground_truth, const std::string& cleaned, double radius_m,
               std::size_t& cleaned_size) {
  std::vector<Eigen::Vector3d> map;
  forEachPoint(cleaned, [&](const Eigen::Vector3d& point, bool) {
    if (point.allFinite()) map.push_back(point);
  });
  cleaned_size = map.size();
  // A cleaned map in the order of the ground truth, as ours is, needs no search for what it kept.
  Evaluator evaluator(radius_m);
  auto next = map.begin();
  forEachPoint(ground_truth, [&](const Eigen::Vector3d& point, bool moving) {
    if (next != map.end() && point == *next) {
      evaluator.addKept(moving);
      ++next;
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
  app.add_option("GT", ground_truth, "PCD file with x y z intensity; intensity > 0.5 = moving")
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
