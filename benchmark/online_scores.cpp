// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause

// beautymap_online_scores INPUT [moving_labels=1,2] [group.parameter=value...]: what the labels of
// an input say about the online mode, beside the replay of the same scans. Each point counts with
// the class it got: no neighbour within 0.05 m saves it.
#include <algorithm>
#include <chrono>
#include <cstdio>

#include "beautymap/cleaner/map_cleaner.h"
#include "beautymap/cleaner/online_map.h"
#include "beautymap/evaluation/evaluation.h"
#include "labelled_scans.h"

namespace beautymap {
namespace {

using Classes = std::vector<PointClass>;

void print(const char* name, const Score& score) {
  std::printf("%-14s SA %.2f DA %.2f AA %.2f HA %.2f\n", name, score.SA(), score.DA(), score.AA(),
              score.HA());
}

void printTimes(const char* name, std::vector<double> ms) {
  std::sort(ms.begin(), ms.end());
  std::printf("%-14s median %.1f ms, 99th percentile %.1f ms\n", name, ms[ms.size() / 2],
              ms[ms.size() * 99 / 100]);
}

void run(const std::vector<LabelledScan>& scans, const Config& given) {
  const Config config = withCellSize(scans, given);
  Score live, finished, offline;
  std::vector<double> hits_ms, free_ms;
  OnlineMap map(config);
  for (const LabelledScan& scan : scans) {
    using Clock = std::chrono::steady_clock;
    using Milliseconds = std::chrono::duration<double, std::milli>;
    const auto begin = Clock::now();
    const Classes& classes = map.addHits(scan.scan);
    hits_ms.push_back(Milliseconds(Clock::now() - begin).count());
    count(scan, classes, live);
    const auto published = Clock::now();
    map.addSeenFree();
    map.settle();
    free_ms.push_back(Milliseconds(Clock::now() - published).count());
  }
  MapCleaner cleaner(config);
  judge(scans, cleaner);
  std::size_t points = 0, agreeing = 0;
  for (const LabelledScan& scan : scans) {
    const Classes replayed = cleaner.classify(scan.scan);
    const Classes online = map.classify(scan.scan);
    count(scan, replayed, offline);
    count(scan, online, finished);
    points += online.size();
    for (std::size_t i = 0; i < online.size(); ++i) agreeing += online[i] == replayed[i] ? 1 : 0;
  }
  print("replay", offline);
  print("finished map", finished);
  print("live split", live);
  std::printf("%-14s %.3f %% of the points\n", "same class",
              100.0 * static_cast<double>(agreeing) / static_cast<double>(points));
  printTimes("until classes", hits_ms);
  printTimes("after them", free_ms);
}

}  // namespace
}  // namespace beautymap

int main(int argc, char** argv) {
  return beautymap::runOnLabelledScans("beautymap_online_scores", argc, argv, beautymap::run);
}
