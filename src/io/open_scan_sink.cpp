// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>

#include "beautymap/io/scan_sink.h"
#include "pcd_folder_sink.h"
#include "rosbag_sink.h"

namespace beautymap {

std::unique_ptr<ScanSink> openScanSink(const std::string& path, const SinkOptions& options,
                                       const ScanSource& source) {
  if (path.empty()) throw InputError("the output path is empty");
  if (std::filesystem::path(path).extension() == ".bag") {
    return std::make_unique<RosbagSink>(path, options, source);
  }
  return std::make_unique<PcdFolderSink>(path, source);
}

}  // namespace beautymap
