// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/matrix/tile_map.h"

#include <algorithm>
#include <tuple>

namespace beautymap {

Tile& TileMap::tileAt(ColumnIndex tile) {
  std::unique_ptr<Tile>& slot = tiles_[keyOf(tile)];
  if (!slot) slot = std::make_unique<Tile>(newTile());
  return *slot;
}

const Tile* TileMap::findTile(ColumnIndex tile) const {
  const auto found = tiles_.find(keyOf(tile));
  return found == tiles_.end() ? nullptr : found->second.get();
}

std::size_t TileMap::memoryBytes() const {
  const std::size_t fine =
      sizeof(std::uint32_t) * Tile::kColumns * static_cast<std::size_t>(fine_bins_);
  std::size_t states = 0;
  for (const auto& tile : tiles_) {
    if (tile.second->state) states += (*std::as_const(tile.second->state)).memoryBytes();
  }
  return tiles_.size() * (sizeof(Tile) + fine) + states;
}

std::vector<ColumnIndex> tilesOf(const TileMap& map) {
  std::vector<ColumnIndex> tiles;
  tiles.reserve(map.tileCount());
  map.forEachTile([&](ColumnIndex index, const Tile&) { tiles.push_back(index); });
  return tiles;
}

std::vector<ColumnIndex> withNeighbours(const TileMap& map, const std::vector<ColumnIndex>& tiles,
                                        int columns) {
  const int reach = (columns + Tile::kSide - 1) / Tile::kSide;
  std::vector<ColumnIndex> all;
  for (const ColumnIndex tile : tiles) {
    for (int dx = -reach; dx <= reach; ++dx) {
      for (int dy = -reach; dy <= reach; ++dy) {
        const ColumnIndex near{tile.x + dx, tile.y + dy};
        if (map.findTile(near) != nullptr) all.push_back(near);
      }
    }
  }
  const auto before = [](ColumnIndex a, ColumnIndex b) {
    return std::tie(a.x, a.y) < std::tie(b.x, b.y);
  };
  std::sort(all.begin(), all.end(), before);
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

}  // namespace beautymap
