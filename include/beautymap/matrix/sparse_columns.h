// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace beautymap {

/// A large value for each of those columns of a tile that have one: most columns of most tiles are
/// empty.
template <typename T, std::size_t kColumns>
class SparseColumns {
 public:
  bool empty() const { return values_.empty(); }
  bool has(std::size_t column) const { return !places_.empty() && places_[column] != kNone; }

  /// The value of a column; one as made by default where it has none.
  const T& operator[](std::size_t column) const {
    static const T kDefault{};
    return has(column) ? values_[places_[column]] : kDefault;
  }
  /// The same to be changed; the column has one from now on.
  T& touch(std::size_t column) {
    if (places_.empty()) places_.assign(kColumns, kNone);
    if (places_[column] == kNone) {
      // In small steps: doubling would waste what is saved.
      if (values_.size() == values_.capacity()) values_.reserve(values_.size() + kStep);
      places_[column] = static_cast<std::uint16_t>(values_.size());
      values_.emplace_back();
    }
    return values_[places_[column]];
  }

  std::size_t memoryBytes() const {
    return places_.capacity() * sizeof(places_[0]) + values_.capacity() * sizeof(T);
  }

  /// What is written to files, and read from them again.
  const std::vector<std::uint16_t>& places() const { return places_; }
  const std::vector<T>& values() const { return values_; }
  /// @return  whether they belong together; nothing is changed otherwise
  bool assign(std::vector<std::uint16_t> places, std::vector<T> values) {
    const auto known = [&](std::uint16_t place) { return place == kNone || place < values.size(); };
    if (places.size() != (values.empty() ? 0 : kColumns) ||
        !std::all_of(places.begin(), places.end(), known)) {
      return false;
    }
    places_ = std::move(places);
    values_ = std::move(values);
    return true;
  }

 private:
  static constexpr std::uint16_t kNone = 0xFFFF;
  static constexpr std::size_t kStep = 64;
  static_assert(kColumns < kNone, "a place fits into 16 bits");

  std::vector<std::uint16_t> places_;  ///< of each column in values_; empty while no column has one
  std::vector<T> values_;
};

}  // namespace beautymap
