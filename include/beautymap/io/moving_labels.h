// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "beautymap/io/scan_source.h"

namespace beautymap {

/// Whether each point of a normalized cloud is labelled as moving; empty without a `label` field.
std::vector<bool> movingPoints(const pcl::PCLPointCloud2& cloud, const ScanSource& source);

/// Sets the labels of points that do not move to 0: in bags and PCD folders any other label means
/// moving, whatever it means to `source`.
void clearStaticLabels(pcl::PCLPointCloud2& cloud, const ScanSource& source);

}  // namespace beautymap
