// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace beautymap {

/// A file without a name for what is too much for memory: it is gone with the process, however that
/// ends.
class TemporaryFile {
 public:
  /// @param folder  where the file is made
  /// @throws InputError when no file can be made there.
  explicit TemporaryFile(const std::string& folder);
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  // Several threads may reserve room, write what they reserved, and read what was written.
  /// Room behind all that was reserved before.
  /// @return its offset
  std::int64_t reserve(std::size_t size) {
    return size_.fetch_add(static_cast<std::int64_t>(size));
  }
  /// Writes at an offset, and moves the offset behind it.
  /// @throws InputError when the disk is full.
  void write(std::int64_t& offset, const void* bytes, std::size_t size) const;
  /// Fills `bytes` with what was written at an offset, and moves the offset behind it.
  /// @throws InputError when that cannot be read.
  void read(std::int64_t& offset, void* bytes, std::size_t size) const;

  template <typename T>
  void write(std::int64_t& offset, const std::vector<T>& values) const {
    write(offset, values.data(), values.size() * sizeof(T));
  }
  template <typename T>
  void read(std::int64_t& offset, std::vector<T>& values) const {
    read(offset, values.data(), values.size() * sizeof(T));
  }

 private:
  std::string folder_;
  int descriptor_;
  std::atomic<std::int64_t> size_{0};  ///< [byte]
};

}  // namespace beautymap
