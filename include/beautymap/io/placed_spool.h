// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "beautymap/io/temporary_file.h"
#include "beautymap/matrix/scan.h"

namespace beautymap {

/// Placed scans in a temporary file, so that each is placed once for all passes.
class PlacedSpool {
 public:
  enum class Part {
    kAll,
    kHeights,  ///< without x and y
  };

  /// @param folder  where the file is made; it needs 20 to 40 bytes a point, 8 less without x and y
  /// @throws InputError when no file can be made there.
  explicit PlacedSpool(const std::string& folder, Part kept = Part::kAll)
      : file_(folder), kept_(kept) {}

  /// Writes a scan into the file; several threads may do so at once. It belongs to the spool only
  /// when it is added.
  /// @return its place, for add()
  /// @throws InputError when the disk is full.
  std::int64_t write(const PlacedScan& scan);
  void add(std::int64_t place) { places_.push_back(place); }
  void rewind() { read_ = 0; }
  /// The next scan, as far as it was kept; false at the end. Its memory is used again, also that of
  /// parts left out, which then hold nothing meaningful.
  bool next(PlacedScan& scan, Part part = Part::kAll);
  std::size_t size() const { return places_.size(); }

 private:
  TemporaryFile file_;
  Part kept_;
  std::vector<std::int64_t> places_;  ///< of the scans in the file [byte]
  std::size_t read_ = 0;
};

}  // namespace beautymap
