// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "beautymap/io/scan_source.h"

// What every command line tool needs: the same options, messages, progress and exit codes.

namespace CLI {  // NOLINT(readability-identifier-naming): theirs
class App;
}

namespace beautymap {

/// Declares INPUT... and one option per member of SourceOptions (--map-frame, --cloud-topic, ...).
void addSourceOptions(CLI::App& app, std::vector<std::string>& inputs, SourceOptions& options);

/// Parses the command line, runs the tool and turns its errors into one line on stderr.
/// @return the exit code: 0, or 2 for a wrong command line, an InputError or a ConfigError, 1 for
/// anything unexpected, 130 after Ctrl-C or SIGTERM (which make Progress::step throw, so that
/// destructors remove unfinished output).
int runTool(CLI::App& app, int argc, char** argv, const std::function<void()>& run);

/// Progress with rate and time left on stderr: a bar on a terminal, otherwise a line every few
/// seconds.
class Progress {
 public:
  /// @param what   what is being done, e.g. "comparing"
  /// @param total  number of steps; 0 where it is not known
  Progress(std::string what, std::size_t total);
  /// Ends an unfinished bar's line.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// One scan is done.
  void step();
  /// Prints the final line: steps, time and rate.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  void print(Clock::time_point now);

  std::string what_;
  std::size_t total_;
  std::size_t done_ = 0;
  bool is_terminal_;
  bool finished_ = false;
  Clock::time_point begin_;
  Clock::time_point next_print_;
};

/// Prints source.describe() to stdout, a line each, indented.
void printDescription(const ScanSource& source);

/// Prints to stderr what was skipped since the last rewind and why; nothing when nothing was.
void printSkipped(const ScanSource& source);

/// How many scans were skipped since the last rewind, whatever the reason.
std::size_t countSkipped(const ScanSource& source);

}  // namespace beautymap
