// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/online/point_store.h"

#include "beautymap/io/cloud_fields.h"

namespace beautymap {

bool VoxelSet::place(std::uint64_t slot) {
  const std::size_t mask = slots_.size() - 1;
  // Fibonacci hashing: neighbouring voxels must not fill neighbouring slots.
  std::size_t at = static_cast<std::size_t>(slot * 0x9E3779B97F4A7C15ULL >> 20) & mask;
  while (slots_[at] != 0) {
    if (slots_[at] == slot) return false;
    at = (at + 1) & mask;
  }
  slots_[at] = slot;
  return true;
}

bool VoxelSet::insert(std::uint64_t key) {
  if (3 * (size_ + 1) > 2 * slots_.size()) {
    const std::vector<std::uint64_t> old = std::move(slots_);
    slots_.assign(std::max<std::size_t>(64, 2 * old.size()), 0);
    for (const std::uint64_t slot : old) {
      if (slot != 0) place(slot);
    }
  }
  const bool is_new = place(key + 1);
  size_ += is_new ? 1 : 0;
  return is_new;
}

std::vector<std::uint64_t> VoxelSet::keys() const {
  std::vector<std::uint64_t> keys;
  keys.reserve(size_);
  for (const std::uint64_t slot : slots_) {
    if (slot != 0) keys.push_back(slot - 1);
  }
  return keys;
}

std::size_t TilePoints::memoryBytes() const {
  return records.capacity() + column.capacity() * sizeof(column[0]) + z.capacity() * sizeof(z[0]) +
         voxels.memoryBytes();
}

pcl::PCLPointCloud2 layoutOf(const pcl::PCLPointCloud2& cloud) {
  pcl::PCLPointCloud2 layout;
  layout.fields = cloud.fields;
  layout.point_step = cloud.point_step;
  layout.height = 1;
  return layout;
}

std::vector<CopyRun> recordRuns(const pcl::PCLPointCloud2& from, const pcl::PCLPointCloud2& to) {
  std::vector<CopyRun> runs;
  for (const pcl::PCLPointField& wanted : to.fields) {
    for (const pcl::PCLPointField& field : from.fields) {
      if (field.name != wanted.name || field.datatype != wanted.datatype ||
          field.count != wanted.count) {
        continue;
      }
      appendRun(runs, {field.offset, wanted.offset, fieldTypeSize(field.datatype) * field.count});
      break;
    }
  }
  return runs;
}

std::size_t PointStore::add(const PlacedScan& placed, const pcl::PCLPointCloud2& cloud_in_map) {
  if (layout_.fields.empty()) layout_ = layoutOf(cloud_in_map);
  const std::vector<CopyRun> runs = recordRuns(cloud_in_map, layout_);
  const std::size_t before = size_;
  ColumnIndex last{};
  TilePoints* tile = nullptr;
  for (const ColumnRun& run : placed.runs) {
    const ColumnIndex column{placed.anchor.x + run.x, placed.anchor.y + run.y};
    const ColumnIndex index = TileMap::tileOf(column);
    if (tile == nullptr || index != last) {
      tile = &tileAt(index);
      last = index;
    }
    const auto in_tile = static_cast<std::uint16_t>(TileMap::indexInTile(column));
    for (std::uint32_t i = run.begin; i < run.end; ++i) {
      const Eigen::Vector3d position(placed.anchor.x * res_g_ + static_cast<double>(placed.x[i]),
                                     placed.anchor.y * res_g_ + static_cast<double>(placed.y[i]),
                                     static_cast<double>(placed.z[i]));
      if (voxel_m_ > 0.0 && !tile->voxels.insert(voxelKey(position, voxel_m_))) continue;
      const std::size_t at = tile->records.size();
      tile->records.resize(at + layout_.point_step);
      copyRuns(runs,
               cloud_in_map.data.data() +
                   static_cast<std::size_t>(placed.source_index[i]) * cloud_in_map.point_step,
               tile->records.data() + at);
      tile->column.push_back(in_tile);
      tile->z.push_back(placed.z[i]);
      ++size_;
    }
  }
  return size_ - before;
}

const TilePoints* PointStore::findTile(ColumnIndex tile) const {
  const auto found = tiles_.find({tile.x, tile.y});
  return found == tiles_.end() ? nullptr : &found->second;
}

void PointStore::erase(ColumnIndex tile) {
  const auto found = tiles_.find({tile.x, tile.y});
  if (found == tiles_.end()) return;
  size_ -= found->second.size();
  tiles_.erase(found);
}

std::size_t PointStore::memoryBytes() const {
  std::size_t bytes = 0;
  for (const auto& tile : tiles_) bytes += tile.second.memoryBytes();
  return bytes;
}

}  // namespace beautymap
