// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
// Each stage, and the whole scan, for one scan of a simulated street in the map of all of them.
#include <benchmark/benchmark.h>

#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "beautymap/cleaner/map_cleaner.h"
#include "beautymap/config/config.h"
#include "beautymap/evidence/beam_visibility.h"
#include "beautymap/matrix/binary_encoding.h"
#include "beautymap/matrix/scan.h"
#include "beautymap/published/matrix_comparison.h"
#include "beautymap/published/reverse_ray_casting.h"
#include "beautymap/published/sight_mask.h"
#include "simulated_drive.h"

namespace beautymap::benchmarks {
namespace {

using benchmark::DoNotOptimize;
using benchmark::State;

Config configFrom(const std::string& name, const State& state) {
  Config config = loadConfig(BEAUTYMAP_SOURCE_DIR "/config/" + name + ".yaml");
  config.matrix.res_g = static_cast<double>(state.range(1)) / 100.0;
  return config;
}

/// A finished map, and what the stages take of one scan.
struct Prepared {
  Prepared(const std::vector<Scan>& scans, const Config& c)
      : config(c), scan(scans[scans.size() / 2]), cleaner(c) {
    cleanMap(cleaner, [&](const auto& f) {
      for (const Scan& s : scans) f(s);
    });
    DroppedPoints dropped;
    placed = placeScan(scan, cleaner.zOrigin(), c.matrix.res_g, c.scan, dropped);
    window = mapWindow();
    scan_bits = encodeScan(placed, window.ground, c.matrix);
    candidates = compareMatrices(window.occupied, scan_bits);
  }

  MapWindow mapWindow() const {
    const int half = static_cast<int>(0.5 * config.matrix.roi_size / config.matrix.res_g);
    const ColumnWindow columns{{placed.anchor.x - half, placed.anchor.y - half}, 2 * half + 1};
    return {cleaner.map().extract(columns, &Tile::occupied, Bits{0}),
            cleaner.map().extract(columns, &Tile::ground, Tile::kNoHeight),
            cleaner.map().extract(columns, &Tile::below_ground, std::uint8_t{0})};
  }

  Config config;
  const Scan& scan;
  MapCleaner cleaner;
  PlacedScan placed;
  MapWindow window;
  BitGrid scan_bits, candidates;
};

Prepared& prepared(const std::string& config, const State& state) {
  static std::map<std::tuple<std::string, std::int64_t, std::int64_t>, std::unique_ptr<Prepared>>
      all;
  auto& one = all[{config, state.range(0), state.range(1)}];
  if (!one) {
    one = std::make_unique<Prepared>(simulatedDrive(static_cast<int>(state.range(0))),
                                     configFrom(config, state));
  }
  return *one;
}

/// Runs a stage with what a configuration gives it; counts the points.
template <typename Stage>
void run(State& state, const std::string& config, Stage stage) {
  Prepared& p = prepared(config, state);
  for (auto _ : state) stage(p);
  state.counters["points"] = static_cast<double>(p.scan.cloud.size());
}

/// What nothing that looks at every point can beat: transform it, and note its column.
void floor(State& state) {
  std::vector<std::int32_t> columns;
  run(state, "paper_kitti", [&](Prepared& p) {
    const Eigen::Isometry3f pose = p.scan.T_map_cloud.cast<float>();
    const float columns_per_metre = static_cast<float>(1.0 / p.config.matrix.res_g);
    columns.resize(p.scan.cloud.size());
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const Eigen::Vector3f moved = pose * p.scan.cloud[i].getVector3fMap();
      columns[i] = floorToInt(moved.x() * columns_per_metre) * 4096 +
                   floorToInt(moved.y() * columns_per_metre);
    }
    DoNotOptimize(columns.data());
    benchmark::ClobberMemory();
  });
}

void placing(State& state) {
  DroppedPoints dropped;
  PlacedScan placed;
  run(state, "paper_kitti", [&](Prepared& p) {
    placed = placeScan(p.scan, p.cleaner.zOrigin(), p.config.matrix.res_g, p.config.scan, dropped,
                       std::move(placed));
    DoNotOptimize(placed.z.data());
  });
}

void binary_encoding(State& state) {
  run(state, "paper_kitti",
      [](Prepared& p) { DoNotOptimize(encodeScan(p.placed, p.window.ground, p.config.matrix)); });
}

void map_window(State& state) {
  run(state, "paper_kitti", [](Prepared& p) { DoNotOptimize(p.mapWindow()); });
}

void matrix_comparison(State& state) {
  run(state, "paper_kitti",
      [](Prepared& p) { DoNotOptimize(compareMatrices(p.window.occupied, p.scan_bits)); });
}

void sight_mask(State& state) {
  run(state, "paper_kitti", [](Prepared& p) {
    p.placed.steepest_slope = steepestSlope(p.placed, p.config.restoration.steepest_share);
    DoNotOptimize(
        cellsInSight(p.placed, p.scan_bits, p.window, p.config.matrix, p.config.restoration));
  });
}

void reverse_ray_casting(State& state) {
  run(state, "paper_kitti", [](Prepared& p) {
    DoNotOptimize(
        cellsHidden(p.candidates, p.scan_bits, p.window.ground, p.placed, p.config.matrix));
  });
}

void beam_image(State& state) {
  BeamImage image(configFrom("default", state).visibility);
  run(state, "default", [&](Prepared& p) {
    image.fill(p.placed);
    benchmark::ClobberMemory();
  });
}

void beam_visibility(State& state) {
  Prepared& p = prepared("default", state);
  BeamImage image(p.config.visibility);
  image.fill(p.placed);
  run(state, "default", [&](Prepared&) {
    DoNotOptimize(cellsSeenFree(image, p.candidates, p.window.ground, p.placed, p.config.matrix,
                                p.config.visibility));
  });
}

// The passes, of which each places the scan. A whole scan is all of them, placed once as the replay
// does.
template <const char* kConfig>
void observe(State& state) {
  run(state, kConfig, [](Prepared& p) { p.cleaner.observe(p.scan); });
}
template <const char* kConfig>
void judge(State& state) {
  run(state, kConfig, [](Prepared& p) {
    for (const JudgementPass& pass : p.cleaner.passes()) p.cleaner.add(pass, p.scan);
  });
}
template <const char* kConfig>
void extraction(State& state) {
  run(state, kConfig, [](Prepared& p) { DoNotOptimize(p.cleaner.classify(p.scan)); });
}
template <const char* kConfig>
void whole_scan(State& state) {
  ScanView view;
  std::vector<PointClass> classes;
  run(state, kConfig, [&](Prepared& p) {
    p.cleaner.place(p.scan, view);
    p.cleaner.observe(view);
    for (const JudgementPass& pass : p.cleaner.passes()) {
      p.cleaner.look(pass, view);
      p.cleaner.add(pass, view);
    }
    p.cleaner.classify(view, classes);
    DoNotOptimize(classes.data());
  });
}

// Once for the whole map of the eight scans.
template <const char* kConfig>
void coarse_ground_of_map(State& state) {
  run(state, kConfig, [](Prepared& p) { p.cleaner.estimateGround(); });
}
template <const char* kConfig>
void judgement_of_map(State& state) {
  run(state, kConfig, [](Prepared& p) {
    for (const JudgementPass& pass : p.cleaner.passes()) p.cleaner.conclude(pass);
  });
}

constexpr char kPaper[] = "paper_kitti";
constexpr char kDefault[] = "default";

void beamsAndCells(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"beams", "res_g_cm"})->Unit(benchmark::kMillisecond);
  benchmark->MeasureProcessCPUTime();  // of both threads, where there are two
  for (const int beams : {16, 32, 64, 128}) {
    for (const int res_g_cm : {25, 50, 100, 200}) benchmark->Args({beams, res_g_cm});
  }
}

BENCHMARK(floor)->Apply(beamsAndCells);
BENCHMARK(placing)->Apply(beamsAndCells);
BENCHMARK(binary_encoding)->Apply(beamsAndCells);
BENCHMARK(map_window)->Apply(beamsAndCells);
BENCHMARK(matrix_comparison)->Apply(beamsAndCells);
BENCHMARK(sight_mask)->Apply(beamsAndCells);
BENCHMARK(reverse_ray_casting)->Apply(beamsAndCells);
BENCHMARK(beam_image)->Apply(beamsAndCells);
BENCHMARK(beam_visibility)->Apply(beamsAndCells);
BENCHMARK_TEMPLATE(observe, kPaper)->Apply(beamsAndCells);
BENCHMARK_TEMPLATE(judge, kPaper)->Apply(beamsAndCells);
BENCHMARK_TEMPLATE(extraction, kPaper)->Apply(beamsAndCells);
BENCHMARK_TEMPLATE(whole_scan, kPaper)->Apply(beamsAndCells);
BENCHMARK_TEMPLATE(coarse_ground_of_map, kPaper)->Apply(beamsAndCells);
BENCHMARK_TEMPLATE(judgement_of_map, kPaper)->Apply(beamsAndCells);
BENCHMARK_TEMPLATE(observe, kDefault)->Apply(beamsAndCells);
BENCHMARK_TEMPLATE(judge, kDefault)->Apply(beamsAndCells);
BENCHMARK_TEMPLATE(extraction, kDefault)->Apply(beamsAndCells);
BENCHMARK_TEMPLATE(whole_scan, kDefault)->Apply(beamsAndCells);
BENCHMARK_TEMPLATE(coarse_ground_of_map, kDefault)->Apply(beamsAndCells);
BENCHMARK_TEMPLATE(judgement_of_map, kDefault)->Apply(beamsAndCells);

}  // namespace
}  // namespace beautymap::benchmarks

BENCHMARK_MAIN();
