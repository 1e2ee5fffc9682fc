// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/evidence/evidence_tile.h"

#include <type_traits>
#include <utility>
#include <vector>

namespace beautymap {
namespace {

static_assert(std::is_trivially_copyable<ColumnEvidence>::value &&
                  std::is_trivially_copyable<FloorCell>::value,
              "they are stored as they are");

/// Calls f(data, bytes) for each array that a session keeps.
template <typename State, typename F>
void forEachArray(State& state, F f) {
  for (auto* cells :
       {&state.suspected, &state.strong, &state.leaning, &state.unknown, &state.flickering}) {
    f(cells->data(), sizeof(*cells));
  }
}

template <typename T, std::size_t kColumns>
void writeSparse(const SparseColumns<T, kColumns>& columns, ByteSink& sink) {
  sink.writeVector(columns.places());
  sink.writeVector(columns.values());
}

template <typename T, std::size_t kColumns>
bool readSparse(SparseColumns<T, kColumns>& columns, ByteSource& source) {
  std::vector<std::uint16_t> places;
  std::vector<T> values;
  source.readVector(places);
  source.readVector(values);
  return columns.assign(std::move(places), std::move(values));
}

}  // namespace

std::unique_ptr<TileState> EvidenceTile::clone() const {
  return std::make_unique<EvidenceTile>(*this);
}

std::size_t EvidenceTile::memoryBytes() const {
  return sizeof(*this) + evidence.memoryBytes() + floors.memoryBytes();
}

void EvidenceTile::write(ByteSink& sink) const {
  forEachArray(*this, [&](const void* data, std::size_t size) { sink.write(data, size); });
  writeSparse(evidence, sink);
  writeSparse(floors, sink);
}

bool EvidenceTile::read(ByteSource& source) {
  forEachArray(*this, [&](void* data, std::size_t size) { source.read(data, size); });
  const bool has_evidence = readSparse(evidence, source);
  return readSparse(floors, source) && has_evidence;
}

BitGrid cellsOf(const TileMap& map, ColumnWindow window,
                std::array<Bits, Tile::kColumns> EvidenceTile::*kind) {
  BitGrid grid(window, 0);
  forEachColumn(map, window, [&](int x, int y, const Tile& tile, std::size_t column) {
    grid.at(x, y) = (evidenceTile(tile).*kind)[column];
  });
  return grid;
}

}  // namespace beautymap
