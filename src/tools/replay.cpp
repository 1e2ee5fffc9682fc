// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "beautymap/config/config.h"
#include "beautymap/io/tool_support.h"
#include "beautymap/offline/offline_cleaner.h"

using namespace beautymap;

namespace {

void printReport(const OfflineReport& report, double res_g, const std::string& output) {
  const DroppedPoints& dropped = report.dropped_points;
  std::printf("%zu scans, %llu points: %llu static, %llu dynamic, %llu dropped\n", report.scans,
              static_cast<unsigned long long>(report.points),
              static_cast<unsigned long long>(report.static_points),
              static_cast<unsigned long long>(report.dynamic_points),
              static_cast<unsigned long long>(dropped.total()));
  if (dropped.total() > 0) {
    std::printf(
        "dropped points: %llu not finite, %llu zero, %llu nearer than scan.min_range, %llu "
        "farther than scan.max_range\n",
        static_cast<unsigned long long>(dropped.non_finite),
        static_cast<unsigned long long>(dropped.zero),
        static_cast<unsigned long long>(dropped.too_near),
        static_cast<unsigned long long>(dropped.too_far));
  }
  if (report.float64_coordinates) {
    std::printf("the coordinates are too large for float32: x, y, z are written as float64\n");
  }
  std::printf("%s%s\n", report.up.isCertain() ? "" : "WARNING: ", report.up.describe().c_str());
  if (report.cell_size_m < res_g) {
    std::printf("the first scan shows a room: cells of %g m (matrix.room_res_g)\n",
                report.cell_size_m);
  }
  if (report.score) {
    std::printf("SA %.2f DA %.2f AA %.2f HA %.2f\n", report.score->SA(), report.score->DA(),
                report.score->AA(), report.score->HA());
  }
  std::printf("%.1f s, %.1f scans/s, peak memory %.0f MB\n", report.seconds,
              static_cast<double>(report.scans) / report.seconds, report.peak_memory_mb);
  std::printf(
      "written to %s: cleaned.pcd dynamic.pcd report.json before.png after.png matrix.png%s\n",
      output.c_str(), report.score ? " mistakes.png" : "");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Removes what moved from the map that registered LiDAR scans make.\n"
      "INPUT is one or several rosbags, a folder of PCD files (map frame, pose in VIEWPOINT), or a "
      "SemanticKITTI sequence.");
  std::vector<std::string> inputs, assignments;
  SourceOptions source_options;
  OfflineOptions options;
  std::string config_file;
  addSourceOptions(app, inputs, source_options);
  app.add_option("--output,-o", options.output, "folder for the cleaned map, report and pictures")
      ->required();
  app.add_option("--config,-c", config_file,
                 "YAML file with parameters; the default set otherwise");
  app.add_option("--set", assignments, "one parameter, e.g. --set matrix.res_g=0.5; repeatable")
      ->type_name("key=value");
  app.add_option("--voxel", options.voxel_m,
                 "keep one point per cube of this side [m]; 0: all points as they came")
      ->check(CLI::IsMember({0.0}) | CLI::Range(0.001, 100.0));
  std::string users = "Parameters for --set and YAML files (default, range):\n";
  std::string experts = "For experts:\n";
  for (const ParameterInfo& p : listParameters(Config())) {
    const std::string line =
        "  " + p.name + " = " + p.value + " (" + p.range() + "): " + p.meaning + "\n";
    (p.symptom.empty() ? experts : users) +=
        p.symptom.empty() ? line : line + "      " + p.symptom + "\n";
  }
  app.footer(users + experts);

  return runTool(app, argc, argv, [&] {
    Config config = config_file.empty() ? Config() : loadConfig(config_file);
    for (const std::string& assignment : assignments) setParameter(config, assignment);
    checkConfig(config);
    const auto source = openScanSource(inputs, source_options);
    printDescription(*source);
    std::printf("configuration:\n%s", toYaml(config).c_str());
    std::fflush(stdout);

    std::unique_ptr<Progress> progress;
    const ProgressListener listener{[&](const std::string& pass, std::size_t scans) {
                                      progress = std::make_unique<Progress>(pass, scans);
                                    },
                                    [&] { progress->step(); }};
    const OfflineReport report = cleanOffline(*source, config, options, listener);
    progress.reset();
    printSkipped(*source);
    printReport(report, config.matrix.res_g, options.output);
  });
}
