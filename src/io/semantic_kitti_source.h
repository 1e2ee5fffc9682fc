// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "beautymap/io/scan_source.h"

namespace beautymap {

/// A SemanticKITTI sequence: velodyne/NNNNNN.bin (float32 x y z intensity), poses.txt (left
/// camera), calib.txt (`Tr`: camera from velodyne), optional labels/NNNNNN.label (uint32, semantic
/// class in the lower 16 bits) and times.txt. The map frame is the first scan's velodyne frame of
/// poses.txt. Stamps are 1 s + times.txt, or 10 Hz without it.
class SemanticKittiSource : public ScanSource {
 public:
  /// @throws InputError when poses.txt or calib.txt are missing or not what they should be.
  SemanticKittiSource(const std::filesystem::path& folder, const SourceOptions& options);

  /// Whether a path is a folder that holds velodyne/.
  static bool accepts(const std::filesystem::path& folder);

  bool next(SourceScan& scan) override;
  void rewind() override;
  std::size_t size() const override { return scans_.size(); }
  std::vector<std::string> describe() const override;
  /// SemanticKITTI's moving classes are 252 to 259.
  bool isMoving(std::uint32_t label) const override;

 private:
  struct Scan {
    std::filesystem::path path;
    std::size_t number;  // line of poses.txt and times.txt
    std::uint64_t stamp_ns;
  };
  void listScans(const SourceOptions& options);
  bool read(const Scan& file, SourceScan& scan);

  std::filesystem::path folder_;
  std::vector<Eigen::Isometry3d> T_map_velodyne_;
  bool has_labels_ = false;
  std::vector<Scan> scans_;
  std::size_t next_ = 0;
};

}  // namespace beautymap
