// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <future>

namespace beautymap {

/// Calls f(i) for every i below a number, in this thread and in another one: each takes the next i
/// when it is done with one. What f writes for one i it may not read for others.
template <typename F>
void inTwoThreads(std::size_t count, F f) {
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) f(i);
  };
  auto other = std::async(count > 1 ? std::launch::async : std::launch::deferred, work);
  work();
  other.get();
}

}  // namespace beautymap
