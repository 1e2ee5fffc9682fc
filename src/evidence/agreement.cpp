// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/evidence/agreement.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "beautymap/evidence/evidence.h"

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

Neighbourhood both(Neighbourhood columns, const Neighbourhood& others) {
  for (std::size_t i = 0; i < columns.size(); ++i) columns[i] &= others[i];
  return columns;
}

/// Set bits of a column among the counted ones within `reach` (1 or 2) bits of a bit.
int countWithin(Bits column, int bit, int reach, Bits counted) {
  // Looked up: not every x86-64 processor counts bits by an instruction.
  constexpr std::array<std::uint8_t, 32> kOnes{0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4,
                                               1, 2, 2, 3, 2, 3, 3, 4, 2, 3, 3, 4, 3, 4, 4, 5};
  const int low = std::max(0, bit - reach);
  return kOnes[(column & counted) >> low & lowBits(bit + reach - low + 1)];
}

/// Set bits within one bit of a bit, in all columns; not the bit itself in the middle.
int countAround(const Neighbourhood& columns, int bit, Bits counted) {
  int count = 0;
  for (const Bits column : columns) count += countWithin(column, bit, 1, counted);
  return count - static_cast<int>((columns[4] & counted) >> bit & 1);
}

void excludeCells(BitGrid& cells, const BitGrid& excluded) {
  for (int x = 0; x < cells.size(); ++x) {
    for (int y = 0; y < cells.size(); ++y) cells.at(x, y) &= ~excluded.at(x, y);
  }
}

/// Cells of one column.
struct ColumnCells {
  int x, y;
  Bits cells;
};

/// Columns of which something depends on what changed, each once; the others need not be looked at
/// again. None lies nearer to the window's border than `border` columns.
class ColumnQueue {
 public:
  ColumnQueue(const ColumnWindow& window, int border)
      : waits_(window, 0), first_(border), last_(window.size - 1 - border) {}

  /// Adds a column and those that lie around it.
  void addAround(int x, int y, int reach) {
    for (int nx = std::max(first_, x - reach); nx <= std::min(last_, x + reach); ++nx) {
      for (int ny = std::max(first_, y - reach); ny <= std::min(last_, y + reach); ++ny) {
        if (waits_.at(nx, ny) != 0) continue;
        waits_.at(nx, ny) = 1;
        columns_.push_back({nx, ny});
      }
    }
  }
  void addAroundSet(const BitGrid& grid, int reach) {
    for (int x = 0; x < grid.size(); ++x) {
      for (int y = 0; y < grid.size(); ++y) {
        if (grid.at(x, y) != 0) addAround(x, y, reach);
      }
    }
  }
  /// Empties the queue: what f(x, y) finds in each of its columns, without those where it is none.
  template <typename F>
  std::vector<ColumnCells> find(F f) {
    std::vector<ColumnCells> found;
    for (const ColumnIndex column : columns_) {
      waits_.at(column.x, column.y) = 0;
      const Bits cells = f(column.x, column.y);
      if (cells != 0) found.push_back({column.x, column.y, cells});
    }
    columns_.clear();
    return found;
  }

 private:
  ColumnGrid<std::uint8_t> waits_;
  std::vector<ColumnIndex> columns_;
  int first_, last_;
};

constexpr int kFlickerRounds = 3;  ///< edges are a few cells thick

/// The cells within two columns and two bits of a column's that are set in a grid and counted.
Bits anyWithinTwo(const BitGrid& cells, int x, int y, Bits counted) {
  Bits any = 0;
  for (int dx = -2; dx <= 2; ++dx) {
    for (int dy = -2; dy <= 2; ++dy) any |= cells.at(x + dx, y + dy);
  }
  any &= counted;
  any |= any << 1 | any >> 1;
  return any | any << 1 | any >> 1;
}

/// The occupied cells that nothing speaks against.
BitGrid stayingCells(const EvidenceWindow& window, const BitGrid& dynamic) {
  BitGrid staying(dynamic.window(), 0);
  for (int x = 0; x < dynamic.size(); ++x) {
    for (int y = 0; y < dynamic.size(); ++y) {
      staying.at(x, y) = window.occupied.at(x, y) & ~dynamic.at(x, y) & ~window.leaning.at(x, y) &
                         ~window.unknown.at(x, y);
    }
  }
  return staying;
}

/// Whether a leaning or unknown cell joins: so many of its occupied neighbours are dynamic.
bool joins(bool leans, int dynamic, int occupied, const AgreementConfig& config) {
  const double share = leans ? config.join_share : config.unknown_share;
  return dynamic > 0 && dynamic >= share * occupied;
}

/// The leaning and unknown cells of one column that join dynamic ones within two cells, where
/// nothing stays within two.
Bits joiningAcrossGaps(const EvidenceWindow& window, const BitGrid& staying, const BitGrid& dynamic,
                       int x, int y, int ground_bit, const AgreementConfig& config) {
  const Bits counted = ~lowBits(ground_bit + 1);
  const Bits leaning = window.leaning.at(x, y) & ~window.flickering.at(x, y);
  Bits cells = (leaning | window.unknown.at(x, y)) & ~dynamic.at(x, y) & counted;
  if (cells != 0) cells &= anyWithinTwo(dynamic, x, y, counted);
  if (cells != 0) cells &= ~anyWithinTwo(staying, x, y, counted);
  Bits joining = 0;
  for (Bits rest = cells; rest != 0; rest &= rest - 1) {
    const int bit = lowestBitIndex(rest);
    int dynamic_count = 0, occupied_count = -1;  // without the cell itself
    for (int dx = -2; dx <= 2; ++dx) {
      for (int dy = -2; dy <= 2; ++dy) {
        dynamic_count += countWithin(dynamic.at(x + dx, y + dy), bit, 2, counted);
        occupied_count += countWithin(window.occupied.at(x + dx, y + dy), bit, 2, counted);
      }
    }
    const bool leans = (window.leaning.at(x, y) & lowestBit(rest)) != 0;
    if (joins(leans, dynamic_count, occupied_count, config)) joining |= lowestBit(rest);
  }
  return joining;
}

/// The leaning and unknown cells of one column that join dynamic ones beside them.
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
    const bool leans = (leaning >> bit & 1) != 0;
    if (joins(leans, countAround(dynamic_around, bit, counted), countAround(occupied, bit, counted),
              config)) {
      joining |= lowestBit(rest);
    }
  }
  return joining;
}

/// The dynamic cells of one column that are but flickering edges.
Bits flickerInColumn(const EvidenceWindow& window, const BitGrid& dynamic, int x, int y,
                     int ground_bit, const AgreementConfig& config) {
  const Bits counted = ~lowBits(ground_bit + 1);
  const Bits cells = dynamic.at(x, y) & counted;
  if (cells == 0) return 0;
  const Neighbourhood dynamic_around = around(dynamic, x, y);
  const Neighbourhood flickering = both(dynamic_around, around(window.flickering, x, y));
  if (anyOf(flickering) == 0) return 0;
  const Neighbourhood suspected = both(dynamic_around, around(window.suspected, x, y));
  const Neighbourhood occupied = around(window.occupied, x, y);
  Bits flicker = 0;
  for (Bits rest = cells; rest != 0; rest &= rest - 1) {
    const int bit = lowestBitIndex(rest);
    const int itself = (window.flickering.at(x, y) & lowestBit(rest)) != 0 ? 1 : 0;
    const bool mostly = countAround(flickering, bit, counted) + itself >
                        config.flicker_share * (countAround(dynamic_around, bit, counted) + 1);
    if (mostly && countAround(suspected, bit, counted) <
                      config.join_share * countAround(occupied, bit, counted)) {
      flicker |= lowestBit(rest);
    }
  }
  return flicker;
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
  BitGrid surfaces = stayingCells(window, window.suspected);
  for (int x = 0; x < floors.size(); ++x) {
    for (int y = 0; y < floors.size(); ++y) {
      Bits& cells = surfaces.at(x, y);
      cells &= ~(cells >> 1) & ~lowBits(ground_bit + 1);
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
  const BitGrid staying = config.across_gaps ? stayingCells(window, dynamic) : BitGrid();
  ColumnQueue near_change(dynamic.window(), 2);
  near_change.addAroundSet(dynamic, 2);
  for (int round = 0; round < config.join_rounds; ++round) {
    const std::vector<ColumnCells> joining = near_change.find([&](int x, int y) {
      Bits cells = joiningInColumn(window, dynamic, x, y, ground_bit, config);
      if (config.across_gaps) {
        cells |= joiningAcrossGaps(window, staying, dynamic, x, y, ground_bit, config);
      }
      return cells;
    });
    if (joining.empty()) break;
    for (const ColumnCells& column : joining) {
      dynamic.at(column.x, column.y) |= column.cells;
      near_change.addAround(column.x, column.y, 2);
    }
  }
}

void excludeFlicker(const EvidenceWindow& window, BitGrid& dynamic, int ground_bit,
                    const AgreementConfig& config) {
  ColumnQueue near_change(dynamic.window(), 1);
  near_change.addAroundSet(dynamic, 0);
  for (int round = 0; round < kFlickerRounds; ++round) {
    const std::vector<ColumnCells> flicker = near_change.find(
        [&](int x, int y) { return flickerInColumn(window, dynamic, x, y, ground_bit, config); });
    if (flicker.empty()) break;
    for (const ColumnCells& column : flicker) {
      dynamic.at(column.x, column.y) &= ~column.cells;
      near_change.addAround(column.x, column.y, 1);
    }
  }
}

int agreementMargin(const AgreementConfig& config) {
  return 2 + 2 * config.join_rounds + kFlickerRounds;
}

BitGrid dynamicCells(EvidenceWindow window, int ground_bit, const AgreementConfig& config) {
  BitGrid dynamic = window.suspected;
  excludeCells(dynamic, surfaceNoise(window, config.surface_bits));
  excludeCells(window.occupied, floorCells(window, ground_bit, config));
  excludeCells(dynamic, unsupportedCells(window, ground_bit, config));
  excludeCells(dynamic, overheadNoise(window, ground_bit, config));
  growObjects(window, dynamic, ground_bit, config);
  excludeFlicker(window, dynamic, ground_bit, config);
  return dynamic;
}

}  // namespace beautymap
