// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/matrix/tile_map.h"

namespace beautymap {

Tile& TileMap::tileAt(ColumnIndex tile) {
  std::unique_ptr<Tile>& slot = tiles_[keyOf(tile)];
  if (!slot) slot = std::make_unique<Tile>(fine_bins_);
  return *slot;
}

const Tile* TileMap::findTile(ColumnIndex tile) const {
  const auto found = tiles_.find(keyOf(tile));
  return found == tiles_.end() ? nullptr : found->second.get();
}

void TileMap::merge(const BitGrid& grid, std::array<Bits, Tile::kColumns> Tile::*quantity) {
  forEachColumn(*this, grid.window(), [&](int x, int y, Tile& tile, std::size_t column) {
    (tile.*quantity)[column] |= grid.at(x, y);
  });
}

std::size_t TileMap::memoryBytes() const {
  const std::size_t fine =
      sizeof(std::uint32_t) * Tile::kColumns * static_cast<std::size_t>(fine_bins_);
  std::size_t sparse = 0;
  for (const auto& tile : tiles_) {
    sparse += tile.second->evidence.memoryBytes() + tile.second->floors.memoryBytes();
  }
  return tiles_.size() * (sizeof(Tile) + fine) + sparse;
}

}  // namespace beautymap
