// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/duration.h>
#include <ros/time.h>

#include <algorithm>
#include <cstdint>

namespace beautymap {

/// ros::Time and tf2 throw where a sum passes 2^32 s or a difference 2^31 s. What comes from
/// outside is refused beyond this stamp (the year 2033), far enough from both.
constexpr std::uint64_t kLatestStampNs = 2'000'000'000'000'000'000;

inline bool isPlausible(const ros::Time& stamp) { return stamp.toNSec() <= kLatestStampNs; }

/// a - b [s].
inline double secondsBetween(const ros::Time& a, const ros::Time& b) {
  return static_cast<double>(static_cast<std::int64_t>(a.toNSec()) -
                             static_cast<std::int64_t>(b.toNSec())) *
         1e-9;
}

/// So many seconds later, or earlier, as far as ros::Time can say.
inline ros::Time shifted(const ros::Time& time, double by_s) {
  const double limit = ros::TIME_MAX.toSec();
  const auto by_ns = static_cast<std::int64_t>(std::clamp(by_s, -limit, limit) * 1e9);
  const auto sum = static_cast<std::int64_t>(time.toNSec()) + by_ns;
  ros::Time result;
  result.fromNSec(static_cast<std::uint64_t>(
      std::clamp<std::int64_t>(sum, static_cast<std::int64_t>(ros::TIME_MIN.toNSec()),
                               static_cast<std::int64_t>(ros::TIME_MAX.toNSec()))));
  return result;
}

}  // namespace beautymap
