// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <thread>

#include "beautymap/io/scan_sink.h"
#include "beautymap/io/tool_support.h"
#include "beautymap/simulation/scene.h"
#include "beautymap/simulation/sensor.h"
#include "beautymap/simulation/simulated_source.h"

namespace {

using beautymap::simulation::SimulationOptions;

void addOptions(CLI::App& app, SimulationOptions& options, std::string& output) {
  app.add_option("--scene", options.scene, "Which scene")
      ->check(CLI::IsMember(beautymap::simulation::sceneNames()))
      ->required();
  app.add_option("--sensor", options.sensor, "Which sensor")
      ->check(CLI::IsMember(beautymap::simulation::sensorNames()))
      ->capture_default_str();
  app.add_option("--scans", options.scans, "Number of scans, 10 per second")
      ->check(CLI::Range(1, beautymap::simulation::kMaxScans))
      ->capture_default_str();
  app.add_option("--seed", options.seed, "The same seed gives the same bytes")
      ->capture_default_str();
  app.add_option("--output", output, "Bag (X.bag) or PCD folder to write")->required();
  app.add_option("--pose-noise", options.pose_noise_m,
                 "Standard deviation of each scan's position, per axis [m]")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
  app.add_option("--pose-noise-deg", options.pose_noise_deg,
                 "Standard deviation of each scan's rotation, per axis [deg]")
      ->check(CLI::Range(0.0, 45.0))
      ->capture_default_str();
  app.add_option("--drift", options.drift_m,
                 "Random walk of the position: standard deviation per axis after 10 s [m]")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
  app.add_option("--drift-deg", options.drift_deg,
                 "Random walk of the yaw: standard deviation after 10 s [deg]")
      ->check(CLI::Range(0.0, 45.0))
      ->capture_default_str();
  app.add_option("--threads", options.threads, "Threads that cast beams; no effect on the result")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
}

void simulate(const SimulationOptions& options, const std::string& output) {
  beautymap::simulation::SimulatedSource source(options);
  beautymap::printDescription(source);
  const auto sink = beautymap::openScanSink(output, beautymap::SinkOptions{}, source);
  beautymap::Progress progress("simulating", source.size());
  beautymap::SourceScan scan;
  std::size_t points = 0;
  while (source.next(scan)) {
    points += scan.cloud.width;
    sink->write(scan);
    progress.step();
  }
  progress.finish();
  sink->close();
  std::cout << output << ": " << source.size() << " scans, " << points << " points\n";
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Ray-casts labelled LiDAR scans of a scene in which cars and people move.\n"
      "Points have the fields x y z intensity ring time label (1: moving, 0: static).");
  SimulationOptions options;
  options.threads = static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, 256U));
  std::string output;
  addOptions(app, options, output);
  return beautymap::runTool(app, argc, argv, [&] { simulate(options, output); });
}
