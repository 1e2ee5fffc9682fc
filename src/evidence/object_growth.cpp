// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/evidence/object_growth.h"

#include <vector>

#include "neighbourhood.h"

namespace beautymap {
namespace {

Neighbourhood both(Neighbourhood columns, const Neighbourhood& others) {
  for (std::size_t i = 0; i < columns.size(); ++i) columns[i] &= others[i];
  return columns;
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

}  // namespace beautymap
