// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdio>
#include <exception>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "beautymap/cleaner/map_cleaner.h"
#include "beautymap/config/config.h"
#include "beautymap/evaluation/evaluation.h"
#include "beautymap/io/cloud_fields.h"
#include "beautymap/io/moving_labels.h"
#include "beautymap/io/scan_conversion.h"
#include "beautymap/io/scan_source.h"
#include "beautymap/matrix/cell_size.h"
#include "beautymap/matrix/up_direction.h"

namespace beautymap {

struct LabelledScan {
  Scan scan;
  std::vector<PointLabel> labels;
  Eigen::Vector3d sensor_z;  ///< in the map frame
};

/// All scans of a bag or folder; see SourceOptions for the options.
/// @throws InputError when there are none, or one has no labels.
inline std::vector<LabelledScan> readLabelledScans(const std::string& input,
                                                   const SourceOptions& options,
                                                   std::size_t most_scans) {
  const auto source = openScanSource({input}, options);
  std::vector<LabelledScan> scans;
  SourceScan read;
  while (scans.size() < most_scans && source->next(read)) {
    scans.emplace_back();
    convertScan(read, scans.back().scan);
    scans.back().sensor_z = read.T_map_sensor.linear().col(2);
    scans.back().labels = labelsOf(read.cloud, *source);
    if (scans.back().labels.size() != scans.back().scan.cloud.size()) {
      throw InputError(input + ": there are scans without a field `label`");
    }
  }
  if (scans.empty()) throw InputError(input + ": there are no scans");
  return scans;
}

/// Adds what became of a scan's points. Each counts with the class it got, dropped ones as removed.
inline void count(const LabelledScan& scan, const std::vector<PointClass>& classes, Score& score) {
  for (std::size_t i = 0; i < classes.size(); ++i) {
    if (scan.labels[i] == PointLabel::kIgnored) continue;
    const bool moving = scan.labels[i] == PointLabel::kMoving;
    ++(moving ? score.dynamic_points : score.static_points);
    if (classes[i] == PointClass::kStatic) ++(moving ? score.kept_dynamic : score.kept_static);
  }
}

/// With the cell size of a room where the first scan shows one.
inline Config withCellSize(const std::vector<LabelledScan>& scans, Config config) {
  config.matrix.res_g = cellSizeFor(scans.front().scan, config).value_or(config.matrix.res_g);
  return config;
}

/// Shows the scans to the cleaner, pass by pass, as a replay does.
inline void judge(const std::vector<LabelledScan>& scans, MapCleaner& cleaner) {
  cleanMap(cleaner, [&](const auto& f) {
    for (const LabelledScan& labelled : scans) f(labelled.scan);
  });
}

/// The numbers of `1,2`.
/// @throws InputError for anything else.
inline std::vector<std::uint32_t> parseNumbers(const std::string& text) {
  std::vector<std::uint32_t> numbers;
  std::istringstream stream(text);
  for (std::string word; std::getline(stream, word, ',');) {
    std::istringstream number(word);
    std::uint32_t value = 0;
    if (!(number >> value) || !number.eof()) throw InputError("not a number: " + text);
    numbers.push_back(value);
  }
  if (numbers.empty()) throw InputError("a number is missing");
  return numbers;
}

/// What main() of `NAME INPUT [moving_labels=1,2] [scans=40] [stride=5] [CONFIG.yaml]
/// [group.parameter=value...]` returns after run(scans, config).
template <typename F>
int runOnLabelledScans(const char* name, int argc, char** argv, F run) {
  if (argc < 2) {
    std::fprintf(stderr,
                 "usage: %s INPUT [moving_labels=1,2] [scans=40] [stride=5] "
                 "[CONFIG.yaml] [group.parameter=value...]\n",
                 name);
    return 2;
  }
  try {
    Config config;
    SourceOptions options;
    std::size_t scans_wanted = std::numeric_limits<std::size_t>::max();
    for (int i = 2; i < argc; ++i) {
      const std::string argument = argv[i];
      const std::size_t equals = std::min(argument.find('='), argument.size());
      const std::string key = argument.substr(0, equals);
      const std::string value = argument.substr(std::min(equals + 1, argument.size()));
      if (equals == argument.size()) {
        config = loadConfig(argument);
      } else if (key == "moving_labels") {
        options.moving_labels = parseNumbers(value);
      } else if (key == "stride") {
        options.stride = static_cast<int>(parseNumbers(value).at(0));
      } else if (key == "scans") {
        scans_wanted = parseNumbers(value).at(0);
      } else {
        setParameter(config, argument);
      }
    }
    std::vector<LabelledScan> scans = readLabelledScans(argv[1], options, scans_wanted);
    UpFinder finder;
    finder.add(scans.front().scan, scans.front().sensor_z);
    const UpDirection up = finder.find(config);
    for (LabelledScan& scan : scans) up.level(scan.scan);
    std::fprintf(stderr, "%s\n", up.describe().c_str());
    run(scans, config);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", name, error.what());
    return 2;
  }
  return 0;
}

}  // namespace beautymap
