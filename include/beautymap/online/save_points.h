// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/PCLPointCloud2.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "beautymap/online/online_cleaner.h"

namespace beautymap {

/// Keeps the first record in each voxel. @param voxel_m  side [m]; 0 keeps all
void thinRecords(std::vector<std::uint8_t>& records, const pcl::PCLPointCloud2& layout,
                 double voxel_m);

/// Writes the cleaned points of a map to one PCD file and the removed ones to another, each at its
/// name only when it is complete.
/// @param voxel_m  the first point in each voxel; 0: all
/// @return how many were written to each
/// @throws InputError when a file cannot be written.
std::pair<std::uint64_t, std::uint64_t> savePoints(const OnlineCleaner& cleaner,
                                                   const std::string& cleaned_path,
                                                   const std::string& removed_path, double voxel_m);

}  // namespace beautymap
