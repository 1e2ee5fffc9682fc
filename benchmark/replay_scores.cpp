// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause

// beautymap_replay_scores INPUT [moving_labels=1,2] [scans=40] [stride=5]
// [group.parameter=value...]: reads a labelled input once, and then scores a replay for each line
// of stdin, which holds parameters (none: the default). Answers each with a line `SA DA HA`, or
// `refused: why`. Each point counts with the class it got: no neighbour within 0.05 m saves it.
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <iterator>
#include <sstream>
#include <string>

#include "labelled_scans.h"

namespace beautymap {
namespace {

Score replay(const std::vector<LabelledScan>& scans, const Config& config) {
  MapCleaner cleaner(withCellSize(scans, config));
  judge(scans, cleaner);
  Score score;
  for (const LabelledScan& scan : scans) count(scan, cleaner.classify(scan.scan), score);
  return score;
}

void run(const std::vector<LabelledScan>& scans, const Config& defaults) {
  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream words(line);
    try {
      Config config = defaults;
      for (std::string word; words >> word;) setParameter(config, word);
      checkConfig(config);
      const Score score = replay(scans, config);
      std::printf("%.4f %.4f %.4f\n", score.SA(), score.DA(), score.HA());
    } catch (const ConfigError& error) {
      std::printf("refused: %s\n", error.what());
    }
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace beautymap

int main(int argc, char** argv) {
  return beautymap::runOnLabelledScans("beautymap_replay_scores", argc, argv, beautymap::run);
}
