// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
// How the cost of a scan depends on the map: on new ground, and with more of it elsewhere.
#include <benchmark/benchmark.h>

#include <memory>
#include <vector>

#include "beautymap/config.h"
#include "beautymap/map_cleaner.h"
#include "beautymap/scan.h"
#include "simulated_drive.h"

namespace beautymap::benchmarks {
namespace {

using benchmark::State;

// Scans of this range do not overlap at this distance.
constexpr double kRange_m = 60.0;
constexpr double kDistance_m = 128.0;

Config paperConfig() {
  Config config = loadConfig(BEAUTYMAP_SOURCE_DIR "/config/paper_kitti.yaml");
  config.scan.max_range = kRange_m;
  return config;
}

/// Every scan comes to where the map has nothing yet.
void growth(State& state) {
  const Scan& scan = simulatedDrive(64).front();
  std::vector<Scan> scans;
  for (int i = 0; i < 32; ++i) scans.push_back(shifted(scan, i * kDistance_m, 0.0));
  auto cleaner = std::make_unique<MapCleaner>(paperConfig());
  std::size_t next = 0;
  for (auto _ : state) {
    if (next == scans.size()) {
      state.PauseTiming();
      cleaner = std::make_unique<MapCleaner>(paperConfig());
      next = 0;
      state.ResumeTiming();
    }
    cleaner->observe(scans[next++]);
  }
}

/// A scan in a map of 1, 10 or 100 times the area.
void scan_in_map(State& state) {
  const Scan& scan = simulatedDrive(64).front();
  MapCleaner cleaner(paperConfig());
  const auto areas = static_cast<int>(state.range(0));
  const auto forEachArea = [&](auto f) {
    for (int i = 0; i < areas; ++i) f(shifted(scan, i % 10 * kDistance_m, i / 10 * kDistance_m));
  };
  forEachArea([&](const Scan& s) { cleaner.observe(s); });
  cleaner.estimateGround();
  forEachArea([&](const Scan& s) { cleaner.encode(s); });
  for (auto _ : state) {
    cleaner.observe(scan);
    cleaner.encode(scan);
    cleaner.compare(scan);
    benchmark::DoNotOptimize(cleaner.classify(scan));
  }
  state.counters["tiles"] = static_cast<double>(cleaner.map().tileCount());
}

BENCHMARK(growth)->Unit(benchmark::kMillisecond);
BENCHMARK(scan_in_map)->ArgName("areas")->Arg(1)->Arg(10)->Arg(100)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace beautymap::benchmarks
