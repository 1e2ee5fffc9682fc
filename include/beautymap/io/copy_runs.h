// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace beautymap {

/// Bytes that are copied from one point record to another.
struct CopyRun {
  std::size_t from;
  std::size_t to;
  std::size_t size;
};

/// Appends a run, or lengthens the last one when both lie side by side in both records.
inline void appendRun(std::vector<CopyRun>& runs, const CopyRun& run) {
  if (!runs.empty()) {
    CopyRun& last = runs.back();
    if (last.from + last.size == run.from && last.to + last.size == run.to) {
      last.size += run.size;
      return;
    }
  }
  runs.push_back(run);
}

inline void copyRuns(const std::vector<CopyRun>& runs, const std::uint8_t* from, std::uint8_t* to) {
  for (const CopyRun& run : runs) std::memcpy(to + run.to, from + run.from, run.size);
}

}  // namespace beautymap
