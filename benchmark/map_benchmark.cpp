// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
// How the cost of a scan depends on the map: on new ground, with more of it elsewhere, and along a
// long road; and what that road takes of memory.
#include <benchmark/benchmark.h>

#include <memory>
#include <string>
#include <vector>

#include "beautymap/cleaner/map_cleaner.h"
#include "beautymap/config/config.h"
#include "beautymap/matrix/scan.h"
#include "simulated_drive.h"

namespace beautymap::benchmarks {
namespace {

using benchmark::State;

// Scans of this range do not overlap at this distance.
constexpr double kRange_m = 60.0;
constexpr double kDistance_m = 128.0;

Config configNamed(const char* name) {
  Config config = loadConfig(BEAUTYMAP_SOURCE_DIR "/config/" + std::string(name) + ".yaml");
  config.scan.max_range = kRange_m;
  return config;
}

constexpr char kPaper[] = "paper_kitti";
constexpr char kDefault[] = "default";

/// Every scan comes to where the map has nothing yet.
template <const char* kConfig>
void growth(State& state) {
  const Config config = configNamed(kConfig);
  const Scan& scan = simulatedDrive(64).front();
  std::vector<Scan> scans;
  for (int i = 0; i < 32; ++i) scans.push_back(shifted(scan, i * kDistance_m, 0.0));
  auto cleaner = std::make_unique<MapCleaner>(config);
  std::size_t next = 0;
  for (auto _ : state) {
    if (next == scans.size()) {
      state.PauseTiming();
      cleaner = std::make_unique<MapCleaner>(config);
      next = 0;
      state.ResumeTiming();
    }
    cleaner->observe(scans[next++]);
  }
}

/// A scan in a map of 1, 10 or 100 times the area.
template <const char* kConfig>
void scan_in_map(State& state) {
  const Scan& scan = simulatedDrive(64).front();
  MapCleaner cleaner(configNamed(kConfig));
  const auto areas = static_cast<int>(state.range(0));
  const auto forEachArea = [&](auto f) {
    for (int i = 0; i < areas; ++i) f(shifted(scan, i % 10 * kDistance_m, i / 10 * kDistance_m));
  };
  cleanMap(cleaner, forEachArea);
  for (auto _ : state) {
    cleaner.observe(scan);
    for (const JudgementPass& pass : cleaner.passes()) cleaner.add(pass, scan);
    benchmark::DoNotOptimize(cleaner.classify(scan));
  }
  state.counters["tiles"] = static_cast<double>(cleaner.map().tileCount());
}

/// A drive of some kilometres, of the same scans one after the other; per scan of it.
template <const char* kConfig>
void road(State& state) {
  constexpr double kStep_m = 4.0;
  const std::vector<Scan>& drive = simulatedDrive(64);
  const auto length_km = static_cast<int>(state.range(0));
  const auto scans = static_cast<std::size_t>(length_km * 1000 / kStep_m);
  std::unique_ptr<MapCleaner> cleaner;
  for (auto _ : state) {
    cleaner = std::make_unique<MapCleaner>(configNamed(kConfig));
    const auto forEachScan = [&](auto f) {
      for (std::size_t i = 0; i < scans; ++i) {
        state.PauseTiming();
        const Scan scan = shifted(drive[i % drive.size()], static_cast<double>(i) * kStep_m, 0.0);
        state.ResumeTiming();
        f(scan);
      }
    };
    cleanMap(*cleaner, forEachScan);
    forEachScan([&](const Scan& scan) { benchmark::DoNotOptimize(cleaner->classify(scan)); });
  }
  using benchmark::Counter;
  state.counters["s_per_scan"] =
      Counter(static_cast<double>(scans), Counter::kIsRate | Counter::kInvert);
  state.counters["map_MB"] = static_cast<double>(cleaner->map().memoryBytes()) / 1e6;
}

void areas(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgName("areas")->Arg(1)->Arg(10)->Arg(100)->Unit(benchmark::kMillisecond);
}
void kilometres(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgName("km")->Arg(1)->Arg(10)->Iterations(1)->Unit(benchmark::kSecond);
}

BENCHMARK_TEMPLATE(growth, kPaper)->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(growth, kDefault)->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(scan_in_map, kPaper)->Apply(areas);
BENCHMARK_TEMPLATE(scan_in_map, kDefault)->Apply(areas);
BENCHMARK_TEMPLATE(road, kPaper)->Apply(kilometres);
BENCHMARK_TEMPLATE(road, kDefault)->Apply(kilometres);

}  // namespace
}  // namespace beautymap::benchmarks
