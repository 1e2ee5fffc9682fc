// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/io/tool_support.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <iostream>

#include "beautymap/config/config.h"

namespace beautymap {
namespace {

constexpr int kExitUnexpected = 1;
constexpr int kExitInput = 2;
constexpr int kExitInterrupted = 130;
constexpr auto kBarPeriod = std::chrono::milliseconds(200);
constexpr auto kLinePeriod = std::chrono::seconds(5);

volatile std::sig_atomic_t interrupted = 0;

/// Deliberately no std::exception: nothing in between handles it.
struct Interrupted {};

void interrupt(int signal) {
  interrupted = 1;
  // A second Ctrl-C ends the process at once.
  std::signal(signal, SIG_DFL);
}

/// Catches signals while a tool runs.
class SignalGuard {
 public:
  SignalGuard() {
    interrupted = 0;
    std::signal(SIGINT, interrupt);
    std::signal(SIGTERM, interrupt);
  }
  ~SignalGuard() {
    interrupted = 0;
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
  }
  SignalGuard(const SignalGuard&) = delete;
  SignalGuard& operator=(const SignalGuard&) = delete;
};

std::string duration(double seconds) {
  char text[48];
  if (seconds < 60.0) {
    std::snprintf(text, sizeof(text), "%.1f s", seconds);
  } else {
    const auto whole = static_cast<long>(seconds);
    std::snprintf(text, sizeof(text), "%ld:%02ld min", whole / 60, whole % 60);
  }
  return text;
}

int fail(const CLI::App& app, const std::string& kind, const std::string& what, int code) {
  std::cout.flush();
  std::cerr << app.get_name() << ": " << kind << what << '\n';
  return code;
}

}  // namespace

void addSourceOptions(CLI::App& app, std::vector<std::string>& inputs, SourceOptions& options) {
  app.add_option("INPUT", inputs,
                 "Bags (several are read as one), a PCD folder (pcd/*.pcd in the map frame, sensor "
                 "pose in VIEWPOINT) or a SemanticKITTI sequence")
      ->required();
  const std::string group = "Input";
  app.add_option("--map-frame", options.map_frame,
                 "Frame of the map (default: 'map' where tf has it, otherwise the only root of tf)")
      ->group(group);
  app.add_option("--cloud-topic", options.cloud_topic,
                 "PointCloud2 topic (default: the only one in the bag)")
      ->group(group);
  app.add_option("--sensor-frame", options.sensor_frame,
                 "Frame in which the beams start; needed for clouds that are registered in the map "
                 "frame (default: the clouds' frame)")
      ->group(group);
  app.add_option("--odom-topic", options.odom_topic,
                 "nav_msgs/Odometry topic that gives the poses (default: tf)")
      ->group(group);
  app.add_option("--start", options.start_s, "Skip that much of the beginning [s] (default: 0)")
      ->check(CLI::Range(0.0, 1e9))
      ->group(group);
  app.add_option("--duration", options.duration_s, "Use that much [s] (default: 0, all)")
      ->check(CLI::Range(0.0, 1e9))
      ->group(group);
  app.add_option("--stride", options.stride, "Use every n-th scan (default: 1)")
      ->check(CLI::Range(1, 1000000))
      ->group(group);
  app.add_option(
         "--moving-labels", options.moving_labels,
         "Values of the field `label` in bags and PCD folders that mean moving, e.g. 1,2; 0 "
         "means static, points with other values are not scored (default: 1)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->group(group);
}

int runTool(CLI::App& app, int argc, char** argv, const std::function<void()>& run) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kExitInput;
  }
  const SignalGuard guard;
  try {
    run();
    return 0;
  } catch (const Interrupted&) {
    return fail(app, "", "interrupted; unfinished output was removed", kExitInterrupted);
  } catch (const InputError& error) {
    return fail(app, "", error.what(), kExitInput);
  } catch (const ConfigError& error) {
    return fail(app, "", error.what(), kExitInput);
  } catch (const std::exception& error) {
    return fail(app, "unexpected error: ", error.what(), kExitUnexpected);
  }
}

Progress::Progress(std::string what, std::size_t total)
    : what_(std::move(what)),
      total_(total),
      is_terminal_(::isatty(STDERR_FILENO) == 1),
      begin_(Clock::now()),
      next_print_(begin_ + (is_terminal_ ? Clock::duration(kBarPeriod) : kLinePeriod)) {}

Progress::~Progress() {
  if (!finished_ && is_terminal_) std::cerr << '\n';
}

void Progress::step() {
  if (interrupted != 0) throw Interrupted();
  ++done_;
  const auto now = Clock::now();
  if (now < next_print_) return;
  next_print_ = now + (is_terminal_ ? Clock::duration(kBarPeriod) : kLinePeriod);
  print(now);
}

void Progress::print(Clock::time_point now) {
  const double seconds = std::max(1e-9, std::chrono::duration<double>(now - begin_).count());
  const double rate = static_cast<double>(done_) / seconds;
  char text[96];
  std::snprintf(text, sizeof(text), "%zu%s%s, %.1f scans/s", done_, total_ > 0 ? "/" : "",
                total_ > 0 ? std::to_string(total_).c_str() : "", rate);
  std::string line = what_ + " ";
  if (total_ > 0 && is_terminal_) {
    constexpr std::size_t kWidth = 30;
    const std::size_t filled = std::min(kWidth, kWidth * done_ / total_);
    line += "[" + std::string(filled, '#') + std::string(kWidth - filled, '.') + "] ";
  }
  line += text;
  if (finished_) {
    line += ", " + duration(seconds);
  } else if (total_ > done_) {
    line += ", " + duration(static_cast<double>(total_ - done_) / rate) + " left";
  }
  // \033[K: the last line may have been longer.
  std::cerr << (is_terminal_ ? "\r" : "") << line << (is_terminal_ ? "\033[K" : "\n");
  if (finished_ && is_terminal_) std::cerr << '\n';
  std::cerr.flush();
}

void Progress::finish() {
  if (finished_) return;
  finished_ = true;
  print(Clock::now());
}

void printDescription(const ScanSource& source) {
  for (const std::string& line : source.describe()) std::cout << "  " << line << '\n';
  std::cout.flush();
}

void printSkipped(const ScanSource& source) {
  const std::size_t count = countSkipped(source);
  if (count == 0) return;
  std::cout.flush();
  std::cerr << "skipped " << count << " of " << source.size() << " scans:\n";
  for (const auto& [reason, skipped] : source.skipped()) {
    std::cerr << "  " << skipped.count << " x " << reason << "\n      e.g. " << skipped.example
              << '\n';
  }
}

std::size_t countSkipped(const ScanSource& source) {
  std::size_t count = 0;
  for (const auto& [reason, skipped] : source.skipped()) count += skipped.count;
  return count;
}

}  // namespace beautymap
