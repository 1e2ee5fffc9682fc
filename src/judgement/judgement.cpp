// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/judgement/judgement.h"

#include <algorithm>

namespace beautymap {

void Judgement::observe(TileMap& map, const PlacedScan& scan) const {
  forEachTileRun(map, scan, [](Tile* tile, std::size_t column, const ColumnRun& run) {
    tile->lowest[column] = std::min(tile->lowest[column], run.lowest);
  });
}

}  // namespace beautymap
