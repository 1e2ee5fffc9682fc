// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <bitset>
#include <cstddef>

#include "beautymap/config/config.h"
#include "beautymap/matrix/tile_map.h"

namespace beautymap {

/// Moves the bottom of a column by whole bits as near as possible to a height [m]; its cells, their
/// evidence and the counts of heights near the ground follow. Whole bits, because a cell that came
/// to lie beside its points would be judged by the evidence of others. What comes to lie above the
/// highest bit counts as that bit, what comes to lie below the lowest is lost.
void moveBottom(Tile& tile, std::size_t column, float bottom, const Config& config);

/// Sets the bottom of a column to an estimate [m]: at once where the column holds nothing,
/// otherwise with moveBottom(), and only if it is farther than max_drift from where the cells are
/// anchored.
/// @return whether cells moved
bool anchorColumn(Tile& tile, std::size_t column, float bottom, double max_drift,
                  const Config& config);

/// Whether the space below a height [m] of a column was seen free: what lies there is a ceiling, a
/// roof or the upper part of an object, and no ground.
bool hangsOverFreeSpace(const Tile& tile, std::size_t column, float height, const Config& config);

/// A provisional ground for the columns of a tile of which none is known, so that they can be seen
/// free before something enters them: that of the nearest column with ground.
/// @return  Tile::kNoHeight for columns with ground, and in a tile without any
std::array<float, Tile::kColumns> groundOfOtherColumns(
    const Tile& tile, const std::bitset<Tile::kColumns>& has_ground);

}  // namespace beautymap
