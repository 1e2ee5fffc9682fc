// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "beautymap/io/temporary_file.h"
#include "beautymap/scan.h"

namespace beautymap {

/// Placed scans in a temporary file, so that each is placed once for all passes.
class PlacedSpool {
 public:
  enum class Part {
    kAll,
    kHeights,  ///< without x and y
  };

  /// @param folder  where the file is made; it needs 20 to 40 bytes a point
  /// @throws InputError when no file can be made there.
  explicit PlacedSpool(const std::string& folder) : file_(folder) {}

  /// @throws InputError when the disk is full.
  void append(const PlacedScan& scan);
  void rewind();
  /// The next scan; false at the end. Its memory is used again, also that of parts left out, which
  /// then hold nothing meaningful.
  bool next(PlacedScan& scan, Part part = Part::kAll);
  std::size_t size() const { return size_; }

 private:
  TemporaryFile file_;
  std::size_t size_ = 0;
  std::size_t read_ = 0;
  std::int64_t read_offset_ = 0;  ///< [byte]
};

}  // namespace beautymap
