// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>

namespace beautymap::simulation {

/// Finaliser of splitmix64 (Steele, Lea, Flood 2014): every input bit changes every output bit.
constexpr std::uint64_t mixBits(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

/// A key made of several numbers; their order matters.
template <typename... Numbers>
constexpr std::uint64_t hashOf(std::uint64_t first, Numbers... others) {
  std::uint64_t key = mixBits(first);
  ((key = mixBits(key ^ static_cast<std::uint64_t>(others))), ...);
  return key;
}

/// Uniform in [0, 1).
constexpr double unitFromBits(std::uint64_t bits) {
  return static_cast<double>(bits >> 11) * 0x1.0p-53;
}

/// Random numbers that depend on the key alone, so neither on threads nor on the standard library
/// (whose distributions are implementation defined).
class Random {
 public:
  explicit Random(std::uint64_t key) : state_(key) {}

  std::uint64_t bits() { return state_ = mixBits(state_); }
  double uniform() { return unitFromBits(bits()); }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  bool chance(double probability) { return uniform() < probability; }

  /// Standard normal (Box-Muller).
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(2.0 * M_PI * uniform());
  }

 private:
  std::uint64_t state_;
};

}  // namespace beautymap::simulation
