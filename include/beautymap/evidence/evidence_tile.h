// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <bitset>
#include <memory>

#include "beautymap/evidence/column_evidence.h"
#include "beautymap/ground/floor_layer.h"
#include "beautymap/matrix/sparse_columns.h"
#include "beautymap/matrix/tile_map.h"

namespace beautymap {

/// What the judgement by evidence remembers of a tile's columns.
struct EvidenceTile : TileState {
  static constexpr int kColumns = Tile::kColumns;

  EvidenceTile() { highest.fill(-Tile::kNoHeight); }
  std::unique_ptr<TileState> clone() const override;
  std::size_t memoryBytes() const override;
  void write(ByteSink& sink) const override;
  bool read(ByteSource& source) override;

  SparseColumns<ColumnEvidence, kColumns> evidence;  ///< of columns that were observed
  FloorCells floors;                                 ///< of columns that have one
  std::array<Bits, kColumns> suspected{};            ///< cells dynamic by their own evidence
  std::array<Bits, kColumns> strong{};      ///< those of the suspected cells with strong evidence
  std::array<Bits, kColumns> leaning{};     ///< cells with some evidence for dynamic, not enough
  std::array<Bits, kColumns> unknown{};     ///< cells never seen free and seldom hit
  std::array<Bits, kColumns> flickering{};  ///< cells that change as the edges of what stays do

  // Of maps of which all points are known before they are judged.
  std::array<float, kColumns> highest;    ///< highest point; -kNoHeight: no point
  std::array<Bits, kColumns> possible{};  ///< cells that can be judged; HeightBins of all points
                                          ///< until the ground is known
  std::bitset<kColumns> flat;  ///< columns of which all points lie in the ground cell: all stay
};

inline EvidenceTile& evidenceTile(Tile& tile) { return static_cast<EvidenceTile&>(*tile.state); }
inline const EvidenceTile& evidenceTile(const Tile& tile) {
  return static_cast<const EvidenceTile&>(*tile.state);
}

/// The cells of one kind in a window.
BitGrid cellsOf(const TileMap& map, ColumnWindow window,
                std::array<Bits, Tile::kColumns> EvidenceTile::*kind);

}  // namespace beautymap
