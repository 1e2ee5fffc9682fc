// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/PCLPointCloud2.h>

#include <string>

#include "beautymap/io/pcd_header.h"

namespace beautymap {

// pcl::PCDReader reads beyond its buffers when such files are damaged, so these are our own.

/// The points of a PCD file with DATA ascii.
/// @throws InputError when a line does not hold a number for every column, or lines are missing.
pcl::PCLPointCloud2 readPcdAscii(const std::string& path, const PcdHeader& header);

/// The points of a PCD file with DATA binary_compressed.
/// @throws InputError when the compressed bytes are damaged or too few.
pcl::PCLPointCloud2 readPcdCompressed(const std::string& path, const PcdHeader& header);

}  // namespace beautymap
