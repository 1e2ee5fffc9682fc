// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "beautymap/io/scan_source.h"

namespace beautymap {

enum class PointLabel : std::uint8_t { kStatic, kMoving, kIgnored };

/// What the label of each point of a normalized cloud says; empty without a `label` field. Points
/// without a position (not finite, or zero as drivers write where nothing came back) are ignored.
/// @param cloud  as it came, not moved
std::vector<PointLabel> labelsOf(const pcl::PCLPointCloud2& cloud, const ScanSource& source);

/// Gives the labels the values that they have in bags and PCD folders, whatever they are to
/// `source`: static 0, moving 1. Ignored points keep theirs, but 2 where that would mean moving.
void unifyLabels(pcl::PCLPointCloud2& cloud, const ScanSource& source);

}  // namespace beautymap
