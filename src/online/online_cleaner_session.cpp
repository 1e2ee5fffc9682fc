// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
// A map that is saved and goes on another day.
#include <utility>
#include <vector>

#include "beautymap/online/online_cleaner.h"
#include "online_cleaner_locks.h"

namespace beautymap {

void OnlineCleaner::saveSession(const std::string& path, const std::string& map_frame) const {
  const std::vector<ColumnIndex> all = tiles();
  const TileFileWriter::Header head = [&] {
    const ReaderLock lock(*this);
    return header(map_frame);
  }();
  TileFileWriter writer(path, head, config());
  for (const ColumnIndex index : all) {
    const ReaderLock lock(*this);
    if (on_disk_.count({index.x, index.y}) != 0) {
      Tile tile = map_.map().newTile();
      TilePoints points;
      fetch(index, tile, points);
      writer.append(index, tile, points);
      continue;
    }
    const Tile* tile = map_.map().findTile(index);
    const TilePoints* points = points_.findTile(index);
    if (tile != nullptr) writer.append(index, *tile, points != nullptr ? *points : TilePoints());
  }
  writer.close();
}

std::string OnlineCleaner::loadSession(const std::string& path) {
  const std::lock_guard<std::mutex> lock(mutex_);
  TileFileReader reader(path, config_);
  const UpDirection told = UpFinder().find(config_);
  if (config_.map.up != "auto" && told.up != reader.header().up) {
    throw InputError("'" + path + "' was made with another direction up than map.up = " +
                     config_.map.up + ": leave that at auto, or begin a new map");
  }
  up_.up = reader.header().up;
  up_.basis = UpDirection::Basis::kContinued;
  setCellSize(reader.cellSize());
  map_.setZOrigin(reader.header().z_origin);
  points_.setLayout(reader.header().layout);
  for (const pcl::PCLPointField& field : reader.header().layout.fields) {
    if (field.name == "x") float64_ = field.datatype == pcl::PCLPointField::FLOAT64;
  }
  started_ = true;
  while (true) {
    Tile tile = map_.map().newTile();
    TilePoints points;
    ColumnIndex index;
    if (!reader.next(index, tile, points)) break;
    tile.unsettled = true;
    map_.map().tileAt(index) = std::move(tile);
    points_.countAdded(points.size());
    points_.tileAt(index) = std::move(points);
  }
  map_.settle();
  return reader.header().map_frame;
}

}  // namespace beautymap
