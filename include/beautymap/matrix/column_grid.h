// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace beautymap {

/// floor() to an integer; the value must fit. Several times faster than std::floor without SSE4.1.
inline int floorToInt(float value) {
  const int truncated = static_cast<int>(value);
  return truncated - (static_cast<float>(truncated) > value ? 1 : 0);
}

/// Index of a column of the map matrix: floor(x / res_g), floor(y / res_g) of map coordinates.
struct ColumnIndex {
  std::int32_t x = 0;
  std::int32_t y = 0;
};
inline bool operator==(ColumnIndex a, ColumnIndex b) { return a.x == b.x && a.y == b.y; }
inline bool operator!=(ColumnIndex a, ColumnIndex b) { return !(a == b); }

/// A square of columns of the map: `size` columns to each side, the first one is `corner`.
struct ColumnWindow {
  ColumnIndex corner;
  int size = 0;

  bool contains(ColumnIndex column) const {
    return column.x >= corner.x && column.x < corner.x + size && column.y >= corner.y &&
           column.y < corner.y + size;
  }
};

/// One value per column of a window, stored row by row (x is the slow index).
template <typename T>
class ColumnGrid {
 public:
  ColumnGrid() = default;
  ColumnGrid(ColumnWindow window, T value)
      : window_(window), values_(static_cast<std::size_t>(window.size) * window.size, value) {}

  /// Begins anew with the memory it has.
  void reset(ColumnWindow window, T value) {
    window_ = window;
    values_.assign(static_cast<std::size_t>(window.size) * window.size, value);
  }

  const ColumnWindow& window() const { return window_; }
  int size() const { return window_.size; }

  /// Indices relative to the window's corner.
  T& at(int x, int y) { return values_[static_cast<std::size_t>(x) * window_.size + y]; }
  const T& at(int x, int y) const {
    return values_[static_cast<std::size_t>(x) * window_.size + y];
  }
  bool isAll(const T& value) const {
    return std::all_of(values_.begin(), values_.end(), [&](const T& v) { return v == value; });
  }
  bool inside(int x, int y) const {
    return x >= 0 && x < window_.size && y >= 0 && y < window_.size;
  }

 private:
  ColumnWindow window_;
  std::vector<T> values_;
};

/// The vertical occupancy of one column, the paper's matrix element: bit k stands for the heights
/// [k res_h, (k + 1) res_h) above the column's ground.
using Bits = std::uint64_t;
using BitGrid = ColumnGrid<Bits>;
using HeightGrid = ColumnGrid<float>;

constexpr int kMaxBits = 64;

/// Bits 0 to count - 1; all for count >= 64, none for count <= 0.
constexpr Bits lowBits(int count) {
  return count <= 0 ? Bits{0} : count >= kMaxBits ? ~Bits{0} : (Bits{1} << count) - 1;
}
/// The column moved up by a number of bits, or down where it is negative.
constexpr Bits shifted(Bits column, int bits) {
  return bits >= kMaxBits || bits <= -kMaxBits ? Bits{0}
         : bits >= 0                           ? column << bits
                                               : column >> -bits;
}
/// The lowest set bit alone; 0 for an empty column.
constexpr Bits lowestBit(Bits column) { return column & (~column + 1); }
/// Index of the lowest set bit; the column must not be empty.
inline int lowestBitIndex(Bits column) { return __builtin_ctzll(column); }
/// Index of the highest set bit; the column must not be empty.
inline int highestBitIndex(Bits column) { return kMaxBits - 1 - __builtin_clzll(column); }

}  // namespace beautymap
