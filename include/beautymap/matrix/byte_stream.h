// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace beautymap {

/// Where the state of a map is written to.
class ByteSink {
 public:
  virtual ~ByteSink() = default;
  virtual void write(const void* data, std::size_t size) = 0;
  /// The number of bytes, and the values.
  template <typename T>
  void writeVector(const std::vector<T>& values) {
    const std::uint64_t bytes = values.size() * sizeof(T);
    write(&bytes, sizeof(bytes));
    write(values.data(), bytes);
  }
};

/// Where it is read from again. Each throws what the source throws when it is truncated or damaged.
class ByteSource {
 public:
  virtual ~ByteSource() = default;
  virtual void read(void* data, std::size_t size) = 0;
  template <typename T>
  void readVector(std::vector<T>& values) {
    std::uint64_t bytes = 0;
    read(&bytes, sizeof(bytes));
    values.resize(checkedCount(bytes, sizeof(T)));
    read(values.data(), bytes);
  }

 protected:
  /// How many values so many bytes are, if the source can hold as many.
  virtual std::size_t checkedCount(std::uint64_t bytes, std::size_t value_size) const = 0;
};

}  // namespace beautymap
