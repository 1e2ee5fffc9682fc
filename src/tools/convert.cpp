// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>

#include "beautymap/io/scan_sink.h"
#include "beautymap/io/scan_source.h"
#include "beautymap/io/tool_support.h"

namespace {

struct Options {
  std::vector<std::string> inputs;
  std::string output;
  beautymap::SourceOptions source;
  beautymap::SinkOptions sink;
};

void declareOptions(CLI::App& app, Options& options) {
  beautymap::addSourceOptions(app, options.inputs, options.source);
  app.add_option("-o,--output", options.output,
                 "X.bag: clouds in the sensor frame, /tf and /odom; any other name: a PCD folder "
                 "(pcd/NNNNNN.pcd in the map frame with the pose in VIEWPOINT, and gt_cloud.pcd "
                 "where the scans have a label field)")
      ->required();
  const std::string group = "Output (bags)";
  app.add_option("--output-topic", options.sink.cloud_topic,
                 "Topic of the clouds (default: " + options.sink.cloud_topic + ")")
      ->group(group);
  app.add_option("--output-map-frame", options.sink.map_frame,
                 "Frame of the map (default: " + options.sink.map_frame + ")")
      ->group(group);
  app.add_option("--output-sensor-frame", options.sink.sensor_frame,
                 "Frame of the sensor and the clouds (default: " + options.sink.sensor_frame + ")")
      ->group(group);
}

void refuseToOverwriteInput(const Options& options) {
  for (const std::string& input : options.inputs) {
    std::error_code error;
    if (std::filesystem::equivalent(input, options.output, error)) {
      throw beautymap::InputError(options.output + ": is the input as well as the output");
    }
  }
}

void convert(const Options& options) {
  refuseToOverwriteInput(options);
  const auto source = beautymap::openScanSource(options.inputs, options.source);
  beautymap::printDescription(*source);
  const auto sink = beautymap::openScanSink(options.output, options.sink, *source);

  beautymap::SourceScan scan;
  std::size_t scans = 0;
  std::uint64_t points = 0;
  beautymap::Progress progress("converting", source->size());
  while (source->next(scan)) {
    sink->write(scan);
    ++scans;
    points += scan.cloud.width;
    progress.step();
  }
  progress.finish();
  beautymap::printSkipped(*source);
  if (scans == 0) {
    throw beautymap::InputError("no scan of the input could be used; nothing was written");
  }
  sink->close();
  std::cout << "wrote " << scans << " scans with " << points << " points to " << options.output
            << '\n';
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Converts between bags, PCD folders and SemanticKITTI sequences.",
               "beautymap_convert");
  Options options;
  declareOptions(app, options);
  return beautymap::runTool(app, argc, argv, [&] { convert(options); });
}
