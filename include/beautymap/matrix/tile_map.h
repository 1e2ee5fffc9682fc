// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <bitset>
#include <cstdint>
#include <limits>
#include <memory>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <vector>

#include "beautymap/matrix/byte_stream.h"
#include "beautymap/matrix/column_grid.h"
#include "beautymap/matrix/scan.h"

namespace beautymap {

/// What a judgement remembers of the columns of one tile.
class TileState {
 public:
  virtual ~TileState() = default;
  virtual std::unique_ptr<TileState> clone() const = 0;
  virtual std::size_t memoryBytes() const = 0;
  /// Of what a session goes on with.
  virtual void write(ByteSink& sink) const = 0;
  /// @return  whether what was read is consistent
  virtual bool read(ByteSource& source) = 0;
};

/// Owns a state; a copy has one of its own.
class TileStatePointer {
 public:
  TileStatePointer() = default;
  explicit TileStatePointer(std::unique_ptr<TileState> state) : state_(std::move(state)) {}
  TileStatePointer(const TileStatePointer& other)
      : state_(other.state_ ? other.state_->clone() : nullptr) {}
  TileStatePointer(TileStatePointer&&) = default;
  TileStatePointer& operator=(TileStatePointer other) {
    state_ = std::move(other.state_);
    return *this;
  }
  ~TileStatePointer() = default;

  explicit operator bool() const { return state_ != nullptr; }
  TileState& operator*() { return *state_; }
  const TileState& operator*() const { return *state_; }

 private:
  std::unique_ptr<TileState> state_;
};

/// A square of columns, one array per quantity. Heights are [m] above the map's z origin.
struct Tile {
  static constexpr int kShift = 5;
  static constexpr int kSide = 1 << kShift;
  static constexpr int kColumns = kSide * kSide;
  static constexpr float kNoHeight = std::numeric_limits<float>::infinity();

  explicit Tile(int fine_bins, TileStatePointer of_judgement = {})
      : fine_counts(static_cast<std::size_t>(kColumns) * static_cast<std::size_t>(fine_bins), 0),
        state(std::move(of_judgement)) {
    lowest.fill(kNoHeight);
    ground.fill(kNoHeight);
  }

  int fineBins() const { return static_cast<int>(fine_counts.size()) / kColumns; }
  const std::uint32_t* fineCounts(std::size_t column) const {
    return fine_counts.data() + column * static_cast<std::size_t>(fineBins());
  }
  std::uint32_t* fineCounts(std::size_t column) {
    return fine_counts.data() + column * static_cast<std::size_t>(fineBins());
  }

  std::array<float, kColumns> lowest;   ///< lowest point; kNoHeight: no point
  std::array<float, kColumns> ground;   ///< bottom of bit 0: coarse ground g_ij, less bits_below
  std::array<float, kColumns> level{};  ///< mean of scans' lowest points
  std::array<std::uint8_t, kColumns> level_scans{};   ///< of how many, up to 255
  std::array<std::uint8_t, kColumns> below_ground{};  ///< holds below-ground outliers
  std::array<Bits, kColumns> occupied{};              ///< M_ij of the map
  std::array<Bits, kColumns> dynamic{};               ///< cells that are removed
  std::array<std::uint16_t, kColumns>
      static_bins{};                       ///< fine bins of the ground cell that stay; 0: all
  std::vector<std::uint32_t> fine_counts;  ///< points per fine bin of the ground cell
  TileStatePointer state;                  ///< the judgement's own

  // Of maps that grow (OnlineMap).
  std::bitset<kColumns> stale_ground;  ///< columns whose ground must be estimated again
  bool unsettled = false;              ///< cells changed since they were judged
  std::uint64_t revision = 0;  ///< becomes another one when points may be judged differently
};

/// The map's matrix: unbounded, in tiles that exist where points are.
class TileMap {
 public:
  /// @param state  what each new tile begins with
  explicit TileMap(int fine_bins, std::unique_ptr<TileState> state = nullptr)
      : fine_bins_(fine_bins), state_(std::move(state)) {}

  static ColumnIndex tileOf(ColumnIndex column) {
    return {column.x >> Tile::kShift, column.y >> Tile::kShift};
  }
  /// Index of a column in the arrays of its tile.
  static int indexInTile(ColumnIndex column) {
    return ((column.x & (Tile::kSide - 1)) << Tile::kShift) | (column.y & (Tile::kSide - 1));
  }

  /// The columns of a square of tiles, from its first one on, and so many around them.
  static ColumnWindow windowOf(ColumnIndex first_tile, int tiles, int margin) {
    return {{first_tile.x * Tile::kSide - margin, first_tile.y * Tile::kSide - margin},
            tiles * Tile::kSide + 2 * margin};
  }

  /// One that is empty, outside of the map.
  Tile newTile() const { return Tile(fine_bins_, state_); }
  Tile& tileAt(ColumnIndex tile);
  void erase(ColumnIndex tile) { tiles_.erase(keyOf(tile)); }
  const Tile* findTile(ColumnIndex tile) const;
  Tile* findTile(ColumnIndex tile) {
    return const_cast<Tile*>(static_cast<const TileMap*>(this)->findTile(tile));
  }

  /// The values of one quantity in a window; `absent` where no tile is.
  /// @param recycled  an earlier result whose memory is used again
  template <typename T>
  ColumnGrid<T> extract(ColumnWindow window, std::array<T, Tile::kColumns> Tile::*quantity,
                        T absent, ColumnGrid<T> recycled = {}) const;

  /// Calls f(tile index, tile) for each tile, in no particular order.
  template <typename F>
  void forEachTile(F f) {
    for (auto& entry : tiles_) f(indexOf(entry.first), *entry.second);
  }
  template <typename F>
  void forEachTile(F f) const {
    for (const auto& entry : tiles_) f(indexOf(entry.first), std::as_const(*entry.second));
  }

  std::size_t tileCount() const { return tiles_.size(); }
  int fineBins() const { return fine_bins_; }
  std::size_t memoryBytes() const;

 private:
  static std::uint64_t keyOf(ColumnIndex tile) {
    return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(tile.x)) << 32) |
           static_cast<std::uint32_t>(tile.y);
  }
  static ColumnIndex indexOf(std::uint64_t key) {
    return {static_cast<std::int32_t>(key >> 32), static_cast<std::int32_t>(key)};
  }

  std::unordered_map<std::uint64_t, std::unique_ptr<Tile>> tiles_;
  int fine_bins_;
  TileStatePointer state_;
};

/// All tiles of a map.
std::vector<ColumnIndex> tilesOf(const TileMap& map);

/// Tiles of a map and those within so many columns of each, each once.
std::vector<ColumnIndex> withNeighbours(const TileMap& map, const std::vector<ColumnIndex>& tiles,
                                        int columns);

/// Looks up the tiles of columns that come in any order. Neighbouring points mostly share a tile,
/// so the last one is kept. @tparam Map  const TileMap: nullptr where no tile is; TileMap: tiles
/// are made.
template <typename Map>
class TileCursor {
 public:
  explicit TileCursor(Map& map) : map_(map) {}

  auto* operator()(ColumnIndex column) {
    const ColumnIndex index = TileMap::tileOf(column);
    if (!valid_ || index != index_) {
      index_ = index;
      valid_ = true;
      if constexpr (std::is_const<Map>::value) {
        tile_ = map_.findTile(index);
      } else {
        tile_ = &map_.tileAt(index);
      }
    }
    return tile_;
  }

 private:
  Map& map_;
  ColumnIndex index_;
  std::conditional_t<std::is_const<Map>::value, const Tile*, Tile*> tile_ = nullptr;
  bool valid_ = false;
};

/// Calls f(tile, column in tile, run) for each run of a scan's points; tile is nullptr where a
/// const map has none.
template <typename Map, typename F>
void forEachTileRun(Map& map, const PlacedScan& scan, F f) {
  TileCursor<Map> tile_of(map);
  for (const ColumnRun& run : scan.runs) {
    const ColumnIndex column{scan.anchor.x + run.x, scan.anchor.y + run.y};
    f(tile_of(column), static_cast<std::size_t>(TileMap::indexInTile(column)), run);
  }
}

/// Calls f(x, y, tile, column in tile) for each column of a window that lies in an existing tile; x
/// and y count from the window's corner.
template <typename Map, typename F>
void forEachColumn(Map& map, ColumnWindow window, F f) {
  const ColumnIndex first = TileMap::tileOf(window.corner);
  const ColumnIndex last =
      TileMap::tileOf({window.corner.x + window.size - 1, window.corner.y + window.size - 1});
  for (std::int32_t tx = first.x; tx <= last.x; ++tx) {
    for (std::int32_t ty = first.y; ty <= last.y; ++ty) {
      auto* tile = map.findTile({tx, ty});
      if (!tile) continue;
      const int x0 = tx * Tile::kSide - window.corner.x;
      const int y0 = ty * Tile::kSide - window.corner.y;
      for (int x = std::max(0, x0); x < std::min(window.size, x0 + Tile::kSide); ++x) {
        for (int y = std::max(0, y0); y < std::min(window.size, y0 + Tile::kSide); ++y) {
          f(x, y, *tile, static_cast<std::size_t>((x - x0) << Tile::kShift | (y - y0)));
        }
      }
    }
  }
}

template <typename T>
ColumnGrid<T> TileMap::extract(ColumnWindow window, std::array<T, Tile::kColumns> Tile::*quantity,
                               T absent, ColumnGrid<T> recycled) const {
  ColumnGrid<T> grid = std::move(recycled);
  grid.reset(window, absent);
  forEachColumn(*this, window, [&](int x, int y, const Tile& tile, std::size_t column) {
    grid.at(x, y) = (tile.*quantity)[column];
  });
  return grid;
}

}  // namespace beautymap
