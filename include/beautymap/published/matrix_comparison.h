// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "beautymap/matrix/column_grid.h"

namespace beautymap {

/// Equation M_dyn = M_map AND NOT M_scan: cells of the map in which the scan has no point.
BitGrid compareMatrices(const BitGrid& map, const BitGrid& scan, BitGrid recycled = {});

/// Takes the lowest occupied cell of each map column, the ground cell, out of the candidates: it is
/// left to the fine ground segmentation (static restoration b).
void excludeLowestBits(BitGrid& candidates, const BitGrid& map);

/// candidates &= mask
void keepOnly(BitGrid& candidates, const BitGrid& mask);
/// candidates &= ~restored
void restore(BitGrid& candidates, const BitGrid& restored);

}  // namespace beautymap
