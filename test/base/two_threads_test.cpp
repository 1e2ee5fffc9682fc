// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/base/two_threads.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace beautymap {
namespace {

TEST(TwoThreads, CallEachIndexOnce) {
  for (const std::size_t count : {0, 1, 2, 1000}) {
    std::vector<int> calls(count, 0);
    inTwoThreads(count, [&](std::size_t i) { ++calls[i]; });
    EXPECT_EQ(calls, std::vector<int>(count, 1));
  }
}

TEST(TwoThreads, WorkAtTheSameTime) {
  std::atomic<int> begun{0};
  inTwoThreads(2, [&](std::size_t) {
    ++begun;
    while (begun < 2) {  // for ever, if one call had to wait for the other
    }
  });
  EXPECT_EQ(begun, 2);
}

TEST(TwoThreads, PassOnWhatIsThrownInEither) {
  for (std::size_t thrower = 0; thrower < 20; ++thrower) {
    const auto throw_at = [&](std::size_t i) {
      if (i == thrower) throw std::runtime_error("this one");
    };
    EXPECT_THROW(inTwoThreads(20, throw_at), std::runtime_error);
  }
}

}  // namespace
}  // namespace beautymap
