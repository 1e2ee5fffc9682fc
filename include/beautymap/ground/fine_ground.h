// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "beautymap/config/config.h"
#include "beautymap/matrix/tile_map.h"

namespace beautymap {

/// How many fine bins a cell of the matrix has.
int fineBinCount(const MatrixConfig& matrix, const FineGroundConfig& config);

/// The fine bin of a height above the bottom of its cell [m].
int fineBinOf(float height_in_cell, int bins, const FineGroundConfig& config);

/// How many bins, from below, are ground: up to the one at which the accumulated share of the
/// points reaches the ground points number ratio. The bins above are dynamic.
int groundBins(const std::uint32_t* counts, int bins, double ground_ratio);

/// Fine ground segmentation: splits the ground cell (lowest occupied bit) of each column of a tile
/// whose upper neighbour is dynamic, by the counts of the points in the fine bins.
/// @param ground_bit  of every column; -1: each column's lowest occupied one
void segmentFineGround(Tile& tile, const FineGroundConfig& config, int ground_bit = -1);

}  // namespace beautymap
