// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include "beautymap/matrix/column_grid.h"

namespace beautymap {

/// One saturating counter per bit of a column, stored as bit planes: plane p holds bit p of all 64
/// counters, so that a whole column counts in a few bitwise instructions.
template <int kPlanes>
class BitCounters {
 public:
  static constexpr int kMax = (1 << kPlanes) - 1;

  /// Adds one to the counters in the mask.
  void increment(Bits mask) {
    Bits carry = mask;
    for (int p = 0; p < kPlanes && carry != 0; ++p) {
      const Bits sum = planes_[p] ^ carry;
      carry &= planes_[p];
      planes_[p] = sum;
    }
    saturate(carry);
  }

  /// Adds other counters to those in the mask.
  template <int kOtherPlanes>
  void add(const BitCounters<kOtherPlanes>& other, Bits mask) {
    static_assert(kOtherPlanes <= kPlanes, "the sum would not know the other's range");
    Bits carry = 0;
    for (int p = 0; p < kPlanes; ++p) {
      const Bits addend = p < kOtherPlanes ? other.plane(p) & mask : Bits{0};
      const Bits half = planes_[p] ^ addend;
      const Bits sum = half ^ carry;
      carry = (planes_[p] & addend) | (half & carry);
      planes_[p] = sum;
    }
    saturate(carry);
  }

  void clear(Bits mask) {
    for (Bits& plane : planes_) plane &= ~mask;
  }
  /// Takes the other's counters where the mask is set.
  void assign(const BitCounters& other, Bits mask) {
    for (int p = 0; p < kPlanes; ++p) {
      planes_[p] = (planes_[p] & ~mask) | (other.planes_[p] & mask);
    }
  }

  /// The counters above a number.
  Bits above(int number) const {
    Bits greater = 0, equal = ~Bits{0};
    for (int p = kPlanes - 1; p >= 0; --p) {
      const Bits digit = (number >> p & 1) != 0 ? ~Bits{0} : Bits{0};
      greater |= equal & planes_[p] & ~digit;
      equal &= ~(planes_[p] ^ digit);
    }
    return number > kMax ? Bits{0} : greater;
  }

  /// Moves every counter to another bit, upwards for bits > 0; those that leave the mask are lost.
  void shift(int bits, Bits mask) {
    for (Bits& plane : planes_) plane = shifted(plane, bits) & mask;
  }

  int count(int bit) const {
    int value = 0;
    for (int p = 0; p < kPlanes; ++p) value |= static_cast<int>(planes_[p] >> bit & 1) << p;
    return value;
  }
  /// The counters that are not zero.
  Bits any() const {
    Bits set = 0;
    for (const Bits plane : planes_) set |= plane;
    return set;
  }
  Bits plane(int p) const { return planes_[static_cast<std::size_t>(p)]; }

 private:
  void saturate(Bits overflowed) {
    if (overflowed == 0) return;
    for (Bits& plane : planes_) plane |= overflowed;
  }

  std::array<Bits, kPlanes> planes_{};
};

}  // namespace beautymap
