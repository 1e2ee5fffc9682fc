// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "beautymap/config/config.h"
#include "beautymap/matrix/column_grid.h"
#include "beautymap/matrix/scan.h"

namespace beautymap {

/// The slope (height over horizontal distance, seen from the sensor) that hardly a point of the
/// scan exceeds. A quantile, so that a single steep outlier does not open the whole sky.
float steepestSlope(const PlacedScan& scan, double share);

/// The map as a scan meets it, in the window that is compared.
struct MapWindow {
  BitGrid occupied;
  HeightGrid ground;
  ColumnGrid<std::uint8_t> below_ground;
};

/// Static restoration a: the cells that were in the scan's view at all, whose steepest_slope must
/// be set. Nothing above ceil(k s) was, nor what lies at or above the highest hit above ground
/// (unless the column holds below-ground outliers, whose bits are displaced), nor a column beyond
/// the sight range whose ground the scan did not hit.
BitGrid cellsInSight(const PlacedScan& scan, const BitGrid& scan_bits, const MapWindow& map,
                     const MatrixConfig& matrix, const RestorationConfig& config);

}  // namespace beautymap
