// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/agreement.h"

#include <array>

namespace beautymap {
namespace {

using Neighbourhood = std::array<Bits, 9>;  ///< a column and the eight around it; itself at 4

Neighbourhood around(const BitGrid& grid, int x, int y) {
  Neighbourhood columns;
  std::size_t n = 0;
  for (int dx = -1; dx <= 1; ++dx) {
    for (int dy = -1; dy <= 1; ++dy) columns[n++] = grid.at(x + dx, y + dy);
  }
  return columns;
}

/// Set bits within one bit of a bit, in all columns; not the bit itself in the middle.
int countAround(const Neighbourhood& columns, int bit, Bits counted) {
  const Bits three = (bit == 0 ? Bits{3} : Bits{7} << (bit - 1)) & counted;
  int count = 0;
  for (const Bits column : columns) count += __builtin_popcountll(column & three);
  return count - static_cast<int>((columns[4] & three) >> bit & 1);
}

/// Bits that belong to a run of at least `length` set bits.
Bits inRuns(Bits column, int length) {
  Bits starts = column;
  for (int i = 1; i < length; ++i) starts &= column >> i;
  Bits runs = starts;
  for (int i = 1; i < length; ++i) runs |= starts << i;
  return runs;
}

}  // namespace

BitGrid unsupportedCells(const DynamicWindow& window, int ground_bit,
                         const AgreementConfig& config) {
  BitGrid unsupported(window.dynamic.window(), 0);
  const Bits counted = ~lowBits(ground_bit + 1);
  for (int x = 1; x + 1 < window.dynamic.size(); ++x) {
    for (int y = 1; y + 1 < window.dynamic.size(); ++y) {
      const Bits cells = window.dynamic.at(x, y);
      if (cells == 0) continue;
      const Neighbourhood occupied = around(window.occupied, x, y);
      const Neighbourhood dynamic = around(window.dynamic, x, y);
      Bits anywhere = 0;
      for (const Bits column : dynamic) anywhere |= column;
      Bits& out = unsupported.at(x, y);
      out = cells & ~inRuns(anywhere, config.min_run);
      for (Bits rest = cells & ~out; rest != 0; rest &= rest - 1) {
        const int bit = lowestBitIndex(rest);
        const bool strong = (window.strong.at(x, y) >> bit & 1) != 0;
        const double share = strong ? config.min_share_strong : config.min_share;
        if (countAround(dynamic, bit, counted) < share * countAround(occupied, bit, counted)) {
          out |= lowestBit(rest);
        }
      }
    }
  }
  return unsupported;
}

}  // namespace beautymap
