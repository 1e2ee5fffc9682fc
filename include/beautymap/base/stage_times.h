// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace beautymap {

/// Time spent per stage [ms], in the order in which the stages first ran.
class StageTimes {
 public:
  void add(const std::string& stage, double ms) {
    for (auto& entry : stages_) {
      if (entry.first == stage) {
        entry.second += ms;
        return;
      }
    }
    stages_.emplace_back(stage, ms);
  }
  void add(const StageTimes& other) {
    for (const auto& entry : other.stages_) add(entry.first, entry.second);
  }
  const std::vector<std::pair<std::string, double>>& stages() const { return stages_; }

 private:
  std::vector<std::pair<std::string, double>> stages_;
};

/// Adds the time between lap() calls to stages.
class StageClock {
 public:
  explicit StageClock(StageTimes& times) : times_(times), last_(Clock::now()) {}
  /// The time since construction or the last lap belongs to this stage.
  void lap(const std::string& stage) {
    const Clock::time_point now = Clock::now();
    times_.add(stage, std::chrono::duration<double, std::milli>(now - last_).count());
    last_ = now;
  }

 private:
  using Clock = std::chrono::steady_clock;
  StageTimes& times_;
  Clock::time_point last_;
};

}  // namespace beautymap
