// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "beautymap/config/config.h"
#include "beautymap/matrix/column_grid.h"
#include "beautymap/matrix/scan.h"

namespace beautymap {

/// Static restoration c, reverse virtual ray casting: the candidates that were hidden, because the
/// ray from the cell's centre back to the sensor meets a cell which the scan hit, in another
/// column.
/// @param ground  the map's ground heights, finite wherever the scan or the candidates have bits
/// [m]
BitGrid cellsHidden(const BitGrid& candidates, const BitGrid& scan_bits, const HeightGrid& ground,
                    const PlacedScan& scan, const MatrixConfig& config);

}  // namespace beautymap
