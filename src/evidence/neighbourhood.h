// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "beautymap/evidence/evidence_window.h"
#include "beautymap/matrix/column_grid.h"

namespace beautymap {

using Neighbourhood = std::array<Bits, 9>;  ///< a column and the eight around it; itself at 4

inline Neighbourhood around(const BitGrid& grid, int x, int y) {
  Neighbourhood columns;
  std::size_t n = 0;
  for (int dx = -1; dx <= 1; ++dx) {
    for (int dy = -1; dy <= 1; ++dy) columns[n++] = grid.at(x + dx, y + dy);
  }
  return columns;
}

inline Bits anyOf(const Neighbourhood& columns) {
  Bits any = 0;
  for (const Bits column : columns) any |= column;
  return any;
}

/// Set bits of a column among the counted ones within `reach` (1 or 2) bits of a bit.
inline int countWithin(Bits column, int bit, int reach, Bits counted) {
  // Looked up: not every x86-64 processor counts bits by an instruction.
  constexpr std::array<std::uint8_t, 32> kOnes{0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4,
                                               1, 2, 2, 3, 2, 3, 3, 4, 2, 3, 3, 4, 3, 4, 4, 5};
  const int low = std::max(0, bit - reach);
  return kOnes[(column & counted) >> low & lowBits(bit + reach - low + 1)];
}

/// Set bits within one bit of a bit, in all columns; not the bit itself in the middle.
inline int countAround(const Neighbourhood& columns, int bit, Bits counted) {
  int count = 0;
  for (const Bits column : columns) count += countWithin(column, bit, 1, counted);
  return count - static_cast<int>((columns[4] & counted) >> bit & 1);
}

/// The occupied cells that nothing speaks against.
inline BitGrid stayingCells(const EvidenceWindow& window, const BitGrid& dynamic) {
  BitGrid staying(dynamic.window(), 0);
  for (int x = 0; x < dynamic.size(); ++x) {
    for (int y = 0; y < dynamic.size(); ++y) {
      staying.at(x, y) = window.occupied.at(x, y) & ~dynamic.at(x, y) & ~window.leaning.at(x, y) &
                         ~window.unknown.at(x, y);
    }
  }
  return staying;
}

}  // namespace beautymap
