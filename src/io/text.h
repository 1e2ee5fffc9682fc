// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace beautymap {

/// a, b, c; `none` without any.
inline std::string join(const std::vector<std::string>& words, const std::string& between = ", ") {
  std::string line;
  for (const std::string& word : words) line += (line.empty() ? "" : between) + word;
  return line.empty() ? "none" : line;
}

inline std::string inSeconds(std::uint64_t stamp_ns) {
  char text[40];
  std::snprintf(text, sizeof(text), "%llu.%03llu s",
                static_cast<unsigned long long>(stamp_ns / 1'000'000'000),
                static_cast<unsigned long long>(stamp_ns / 1'000'000 % 1000));
  return text;
}

}  // namespace beautymap
