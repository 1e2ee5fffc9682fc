// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "beautymap/io/cloud_fields.h"
#include "beautymap/io/moving_labels.h"
#include "beautymap/io/scan_conversion.h"
#include "beautymap/io/scan_source.h"

namespace beautymap {

struct LabelledScan {
  Scan scan;
  std::vector<bool> moving;
};

/// All scans of a bag or folder.
/// @throws InputError when there are none, or one has no labels.
inline std::vector<LabelledScan> readLabelledScans(const std::string& input) {
  const auto source = openScanSource({input}, SourceOptions());
  std::vector<LabelledScan> scans;
  SourceScan read;
  while (source->next(read)) {
    scans.emplace_back();
    convertScan(read, scans.back().scan);
    scans.back().moving = movingPoints(read.cloud, *source);
    if (scans.back().moving.size() != scans.back().scan.cloud.size()) {
      throw InputError(input + ": there are scans without a field `label`");
    }
  }
  if (scans.empty()) throw InputError(input + ": there are no scans");
  return scans;
}

}  // namespace beautymap
