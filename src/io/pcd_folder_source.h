// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "beautymap/io/scan_source.h"

namespace beautymap {

/// A folder in the dynamic-map benchmark's layout: pcd/*.pcd (or *.pcd), a file a scan in natural
/// order, points in the map frame, VIEWPOINT = T_map_sensor. There are no stamps.
class PcdFolderSource : public ScanSource {
 public:
  /// @throws InputError when there are no PCD files, when every VIEWPOINT is the default, or when
  /// the options ask for times.
  PcdFolderSource(const std::filesystem::path& folder, const SourceOptions& options);

  /// Whether a path is a folder that holds PCD files.
  static bool accepts(const std::filesystem::path& folder);

  bool next(SourceScan& scan) override;
  void rewind() override;
  std::size_t size() const override { return files_.size(); }
  std::vector<std::string> describe() const override { return description_; }

 private:
  void readViewpoints();
  void makeDescription();

  struct File {
    std::filesystem::path path;
    Eigen::Isometry3d T_map_sensor = Eigen::Isometry3d::Identity();
    std::string unusable;  // the reason, where it is
    std::string example;
  };
  std::filesystem::path folder_;
  std::vector<File> files_;
  std::vector<std::string> description_;
  std::size_t next_ = 0;
};

}  // namespace beautymap
