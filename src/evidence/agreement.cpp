// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/evidence/agreement.h"

#include <algorithm>

#include "beautymap/evidence/object_growth.h"
#include "neighbourhood.h"

namespace beautymap {
namespace {

void excludeCells(BitGrid& cells, const BitGrid& excluded) {
  for (int x = 0; x < cells.size(); ++x) {
    for (int y = 0; y < cells.size(); ++y) cells.at(x, y) &= ~excluded.at(x, y);
  }
}

}  // namespace

BitGrid unsupportedCells(const EvidenceWindow& window, int ground_bit,
                         const AgreementConfig& config) {
  BitGrid unsupported(window.suspected.window(), 0);
  const Bits counted = ~lowBits(ground_bit + 1);
  for (int x = 1; x + 1 < window.suspected.size(); ++x) {
    for (int y = 1; y + 1 < window.suspected.size(); ++y) {
      const Bits cells = window.suspected.at(x, y);
      if (cells == 0) continue;
      const Neighbourhood occupied = around(window.occupied, x, y);
      const Neighbourhood suspected = around(window.suspected, x, y);
      Bits& out = unsupported.at(x, y);
      for (Bits rest = cells; rest != 0; rest &= rest - 1) {
        const int bit = lowestBitIndex(rest);
        const bool strong = (window.strong.at(x, y) >> bit & 1) != 0;
        const double share = strong ? config.min_share_strong : config.min_share;
        if (countAround(suspected, bit, counted) < share * countAround(occupied, bit, counted)) {
          out |= lowestBit(rest);
        }
      }
    }
  }
  return unsupported;
}

BitGrid surfaceNoise(const EvidenceWindow& window, int surface_bits) {
  BitGrid noise(window.suspected.window(), 0);
  for (int x = 1; x + 1 < window.suspected.size(); ++x) {
    for (int y = 1; y + 1 < window.suspected.size(); ++y) {
      const Bits suspected = window.suspected.at(x, y);
      const Bits staying = window.occupied.at(x, y) & ~suspected & ~window.leaning.at(x, y);
      Bits layer = suspected & staying << 1;  // n bits above a surface's first one
      if (layer == 0) continue;
      const Bits near = anyOf(around(window.suspected, x, y));
      for (int n = 0; n < surface_bits; ++n, layer = suspected & layer << 1) {
        // An object reaches higher than the noise, even where beams missed some of its cells.
        const int up = surface_bits - n;
        noise.at(x, y) |= layer & ~(near >> up | near >> (up + 1) | near >> (up + 2));
      }
    }
  }
  return noise;
}

BitGrid overheadNoise(const EvidenceWindow& window, int ground_bit, const AgreementConfig& config) {
  BitGrid noise(window.suspected.window(), 0);
  if (config.surface_bits == 0) return noise;  // no layer is that thin
  const Bits overhead = ~lowBits(ground_bit + config.overhead_bits);
  for (int x = 1; x + 1 < window.suspected.size(); ++x) {
    for (int y = 1; y + 1 < window.suspected.size(); ++y) {
      const Bits cells = window.suspected.at(x, y) & overhead;
      if (cells == 0) continue;
      const Bits near = anyOf(around(window.suspected, x, y));
      Bits thicker = 0;
      for (int n = config.surface_bits + 1; n <= 2 * config.surface_bits; ++n) {
        thicker |= near << n | near >> n;
      }
      noise.at(x, y) = cells & ~thicker;
    }
  }
  return noise;
}

int agreementMargin(const AgreementConfig& config) {
  return 2 + 2 * config.join_rounds + kFlickerRounds;
}

BitGrid dynamicCells(const EvidenceWindow& window, int ground_bit, const AgreementConfig& config) {
  BitGrid dynamic = window.suspected;
  excludeCells(dynamic, surfaceNoise(window, config.surface_bits));
  excludeCells(dynamic, unsupportedCells(window, ground_bit, config));
  excludeCells(dynamic, overheadNoise(window, ground_bit, config));
  growObjects(window, dynamic, ground_bit, config);
  excludeFlicker(window, dynamic, ground_bit, config);
  return dynamic;
}

}  // namespace beautymap
