// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <bitset>
#include <cstddef>

#include "beautymap/config/matrix_config.h"
#include "beautymap/matrix/tile_map.h"

namespace beautymap {

/// The cells of a column moved by bits, upwards for bits > 0: what comes to lie above the highest
/// bit counts as that bit, what comes to lie below the lowest is lost.
Bits shiftedUpToTop(Bits cells, int bits, int n_bit);

/// Moves the bottom of a column by whole bits as near as possible to a height [m], and its cells
/// with it. Whole bits, because a cell that came to lie beside its points would be judged by the
/// evidence of others. What comes to lie above the highest bit counts as that bit, what comes to
/// lie below the lowest is lost.
/// @return  by how many bits, upwards for > 0, the cells moved: what a judgement remembers of the
///          column must follow
int moveBottom(Tile& tile, std::size_t column, float bottom, const MatrixConfig& config);

/// Sets the bottom of a column to an estimate [m]: at once where nothing is known of its cells,
/// otherwise with moveBottom(), and only if it is farther than max_drift from where the cells are
/// anchored.
/// @return as moveBottom()
int anchorColumn(Tile& tile, std::size_t column, float bottom, double max_drift, bool cells_known,
                 const MatrixConfig& config);

/// Moves the counts of heights near the ground of a column to other bins.
void shiftCounts(Tile& tile, std::size_t column, long bins);

/// A provisional ground for the columns of a tile of which none is known, so that they can be seen
/// free before something enters them: that of the nearest column with ground.
/// @return  Tile::kNoHeight for columns with ground, and in a tile without any
std::array<float, Tile::kColumns> groundOfOtherColumns(
    const Tile& tile, const std::bitset<Tile::kColumns>& has_ground);

}  // namespace beautymap
