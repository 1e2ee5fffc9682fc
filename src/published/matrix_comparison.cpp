// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/published/matrix_comparison.h"

namespace beautymap {
namespace {

template <typename F>
void combine(BitGrid& into, const BitGrid& other, F f) {
  for (int x = 0; x < into.size(); ++x) {
    for (int y = 0; y < into.size(); ++y) into.at(x, y) = f(into.at(x, y), other.at(x, y));
  }
}

}  // namespace

BitGrid compareMatrices(const BitGrid& map, const BitGrid& scan, BitGrid recycled) {
  BitGrid dynamic = std::move(recycled);
  dynamic = map;  // into the memory it has
  restore(dynamic, scan);
  return dynamic;
}

void excludeLowestBits(BitGrid& candidates, const BitGrid& map) {
  combine(candidates, map, [](Bits c, Bits m) { return c & ~lowestBit(m); });
}

void keepOnly(BitGrid& candidates, const BitGrid& mask) {
  combine(candidates, mask, [](Bits c, Bits m) { return c & m; });
}

void restore(BitGrid& candidates, const BitGrid& restored) {
  combine(candidates, restored, [](Bits c, Bits r) { return c & ~r; });
}

}  // namespace beautymap
