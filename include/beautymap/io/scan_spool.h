// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "beautymap/io/scan_source.h"
#include "beautymap/io/temporary_file.h"

namespace beautymap {

/// A temporary file of scans, for a source that is slow to read (compressed bags, text files) and
/// wanted again; more may be appended while it is read. All scans have the fields of the first one.
class ScanSpool {
 public:
  /// @param folder  where the file is made; it needs the room of the uncompressed scans
  /// @throws InputError when no file can be made there.
  explicit ScanSpool(const std::string& folder) : file_(folder) {}

  /// Whether the scan has the fields of those before; add() takes only such ones.
  bool accepts(const SourceScan& scan) const;
  /// Writes a scan into the file; several threads may do so at once. It belongs to the spool only
  /// when it is added.
  /// @return its place, for add()
  /// @throws InputError when the disk is full.
  std::int64_t write(const SourceScan& scan);
  /// @param place  of the scan in the file
  void add(const SourceScan& scan, std::int64_t place);
  void append(const SourceScan& scan) { add(scan, write(scan)); }
  void rewind();
  /// The next scan; false at the end. Buffers of the scan given are used again.
  bool next(SourceScan& scan);
  std::size_t size() const { return places_.size(); }

 private:
  TemporaryFile file_;
  pcl::PCLPointCloud2 layout_;        ///< fields of the first scan, no points
  std::vector<std::int64_t> places_;  ///< of the scans in the file [byte]
  std::size_t read_ = 0;
};

}  // namespace beautymap
