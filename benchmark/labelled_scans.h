// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "beautymap/config/config.h"
#include "beautymap/io/cloud_fields.h"
#include "beautymap/io/moving_labels.h"
#include "beautymap/io/scan_conversion.h"
#include "beautymap/io/scan_source.h"
#include "beautymap/matrix/cell_size.h"

namespace beautymap {

struct LabelledScan {
  Scan scan;
  std::vector<bool> moving;
};

/// All scans of a bag or folder.
/// @throws InputError when there are none, or one has no labels.
inline std::vector<LabelledScan> readLabelledScans(const std::string& input) {
  const auto source = openScanSource({input}, SourceOptions());
  std::vector<LabelledScan> scans;
  SourceScan read;
  while (source->next(read)) {
    scans.emplace_back();
    convertScan(read, scans.back().scan);
    scans.back().moving = movingPoints(read.cloud, *source);
    if (scans.back().moving.size() != scans.back().scan.cloud.size()) {
      throw InputError(input + ": there are scans without a field `label`");
    }
  }
  if (scans.empty()) throw InputError(input + ": there are no scans");
  return scans;
}

/// What main() of `NAME INPUT [CONFIG.yaml] [group.parameter=value...]` returns after
/// run(scans, config).
template <typename F>
int runOnLabelledScans(const char* name, int argc, char** argv, F run) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: %s INPUT [CONFIG.yaml] [group.parameter=value...]\n", name);
    return 2;
  }
  try {
    Config config;
    for (int i = 2; i < argc; ++i) {
      const std::string argument = argv[i];
      if (argument.find('=') == std::string::npos) {
        config = loadConfig(argument);
      } else {
        setParameter(config, argument);
      }
    }
    const std::vector<LabelledScan> scans = readLabelledScans(argv[1]);
    config.matrix.res_g = cellSizeFor(scans.front().scan, config).value_or(config.matrix.res_g);
    run(scans, config);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", name, error.what());
    return 2;
  }
  return 0;
}

}  // namespace beautymap
