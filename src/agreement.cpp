// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/agreement.h"

#include <array>
#include <vector>

#include "beautymap/evidence.h"

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

Bits anyOf(const Neighbourhood& columns) {
  Bits any = 0;
  for (const Bits column : columns) any |= column;
  return any;
}

/// Set bits within one bit of a bit, in all columns; not the bit itself in the middle.
int countAround(const Neighbourhood& columns, int bit, Bits counted) {
  const Bits three = (bit == 0 ? Bits{3} : Bits{7} << (bit - 1)) & counted;
  int count = 0;
  for (const Bits column : columns) count += __builtin_popcountll(column & three);
  return count - static_cast<int>((columns[4] & three) >> bit & 1);
}

void excludeCells(BitGrid& cells, const BitGrid& excluded) {
  for (int x = 0; x < cells.size(); ++x) {
    for (int y = 0; y < cells.size(); ++y) cells.at(x, y) &= ~excluded.at(x, y);
  }
}

/// The leaning and unknown cells of one column that join dynamic ones.
Bits joiningInColumn(const EvidenceWindow& window, const BitGrid& dynamic, int x, int y,
                     int ground_bit, const AgreementConfig& config) {
  const Bits counted = ~lowBits(ground_bit + 1);
  const Bits leaning = window.leaning.at(x, y) & ~dynamic.at(x, y);
  const Bits unknown = window.unknown.at(x, y) & ~dynamic.at(x, y);
  if ((leaning | unknown) == 0) return 0;
  const Neighbourhood dynamic_around = around(dynamic, x, y);
  Bits near = anyOf(dynamic_around) & counted;
  near |= near << 1 | near >> 1;
  if (((leaning | unknown) & near) == 0) return 0;
  const Neighbourhood occupied = around(window.occupied, x, y);
  const Bits staying = window.occupied.at(x, y) & ~dynamic.at(x, y) & counted;
  Bits joining = 0;
  for (Bits rest = (leaning | unknown) & near & ~(staying << 1); rest != 0; rest &= rest - 1) {
    const int bit = lowestBitIndex(rest);
    const int count = countAround(dynamic_around, bit, counted);
    const bool leans = (leaning >> bit & 1) != 0;
    const double share = leans ? config.join_share : config.unknown_share;
    if (count > 0 && count >= share * countAround(occupied, bit, counted)) {
      joining |= lowestBit(rest);
    }
  }
  return joining;
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

BitGrid floorCells(const EvidenceWindow& window, int ground_bit, const AgreementConfig& config) {
  BitGrid floors(window.occupied.window(), 0);
  BitGrid surfaces = floors;
  for (int x = 0; x < floors.size(); ++x) {
    for (int y = 0; y < floors.size(); ++y) {
      const Bits staying = window.occupied.at(x, y) & ~window.suspected.at(x, y) &
                           ~window.leaning.at(x, y) & ~window.unknown.at(x, y);
      surfaces.at(x, y) = staying & ~(staying >> 1) & ~lowBits(ground_bit + 1);
    }
  }
  for (int x = 1; x + 1 < floors.size(); ++x) {
    for (int y = 1; y + 1 < floors.size(); ++y) {
      if (surfaces.at(x, y) == 0) continue;
      BitCounters<4> columns;  // as high as each bit; the middle one is as high as its own
      for (const Bits near : around(surfaces, x, y))
        columns.increment(near | near << 1 | near >> 1);
      floors.at(x, y) = surfaces.at(x, y) & columns.above(config.floor_neighbours);
    }
  }
  return floors;
}

void growObjects(const EvidenceWindow& window, BitGrid& dynamic, int ground_bit,
                 const AgreementConfig& config) {
  struct Column {
    int x, y;
    Bits joining;
  };
  std::vector<Column> growing;  // the columns that can
  for (int x = 1; x + 1 < dynamic.size(); ++x) {
    for (int y = 1; y + 1 < dynamic.size(); ++y) {
      const Bits cells = (window.leaning.at(x, y) | window.unknown.at(x, y)) & ~dynamic.at(x, y);
      if (cells != 0) growing.push_back({x, y, 0});
    }
  }
  for (int round = 0; round < config.join_rounds; ++round) {
    Bits any = 0;
    for (Column& column : growing) {
      column.joining = joiningInColumn(window, dynamic, column.x, column.y, ground_bit, config);
      any |= column.joining;
    }
    if (any == 0) break;
    for (const Column& column : growing) dynamic.at(column.x, column.y) |= column.joining;
  }
}

int agreementMargin(const AgreementConfig& config) { return 2 + config.join_rounds; }

BitGrid dynamicCells(EvidenceWindow window, int ground_bit, const AgreementConfig& config) {
  BitGrid dynamic = window.suspected;
  excludeCells(dynamic, surfaceNoise(window, config.surface_bits));
  excludeCells(window.occupied, floorCells(window, ground_bit, config));
  excludeCells(dynamic, unsupportedCells(window, ground_bit, config));
  excludeCells(dynamic, overheadNoise(window, ground_bit, config));
  growObjects(window, dynamic, ground_bit, config);
  return dynamic;
}

}  // namespace beautymap
