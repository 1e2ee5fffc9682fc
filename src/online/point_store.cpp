// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/online/point_store.h"

#include <algorithm>

#include "beautymap/io/cloud_fields.h"

namespace beautymap {

bool VoxelSet::place(std::uint64_t slot) {
  const std::size_t mask = slots_.size() - 1;
  std::size_t at = home(slot);
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

std::vector<PointStore::NewPoint> PointStore::newPoints(const PlacedScan& placed) {
  const Eigen::Vector3d origin(placed.anchor.x * res_g_, placed.anchor.y * res_g_, 0.0);
  std::vector<NewPoint> points;
  points.reserve(placed.size());
  ColumnIndex last{};
  TilePoints* tile = nullptr;
  for (const ColumnRun& run : placed.runs) {
    const ColumnIndex column{placed.anchor.x + run.x, placed.anchor.y + run.y};
    const ColumnIndex index = TileMap::tileOf(column);
    if (tile == nullptr || index != last) tile = &tileAt(index);
    last = index;
    const auto in_tile = static_cast<std::uint16_t>(TileMap::indexInTile(column));
    for (std::uint32_t i = run.begin; i < run.end; ++i) {
      std::uint64_t voxel = 0;
      if (voxel_m_ > 0.0) {
        voxel = voxelKey(origin + placed.point(i).cast<double>(), voxel_m_);
        // Neighbouring beams often end in the same voxel.
        if (!points.empty() && points.back().tile == tile && points.back().voxel == voxel) continue;
      }
      points.push_back(
          {tile, voxel, static_cast<std::uint32_t>(placed.sourceOf(i)), in_tile, placed.z[i]});
    }
  }
  if (voxel_m_ == 0.0) return points;
  constexpr std::size_t kAhead = 16;  // points
  std::size_t found = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i + kAhead < points.size()) {
      points[i + kAhead].tile->voxels.prefetch(points[i + kAhead].voxel);
    }
    if (points[i].tile->voxels.insert(points[i].voxel)) points[found++] = points[i];
  }
  points.resize(found);
  return points;
}

std::size_t PointStore::add(const PlacedScan& placed, const pcl::PCLPointCloud2& cloud,
                            const Eigen::Isometry3d& T_map_cloud, bool as_float64) {
  const std::vector<NewPoint> added = newPoints(placed);
  // Only these are moved: in a map with voxels they are few.
  pcl::PCLPointCloud2 chosen = layoutOf(cloud);
  chosen.width = static_cast<std::uint32_t>(added.size());
  chosen.data.resize(added.size() * cloud.point_step);
  for (std::size_t i = 0; i < added.size(); ++i) {
    const auto* record = cloud.data.data() + std::size_t{added[i].source} * cloud.point_step;
    std::copy(record, record + cloud.point_step, chosen.data.data() + i * cloud.point_step);
  }
  const pcl::PCLPointCloud2 in_map = moveCloud(chosen, T_map_cloud, as_float64);
  if (layout_.fields.empty()) layout_ = layoutOf(in_map);
  const std::vector<CopyRun> runs = recordRuns(in_map, layout_);
  for (std::size_t i = 0; i < added.size(); ++i) {
    TilePoints& tile = *added[i].tile;
    const std::size_t at = tile.records.size();
    tile.records.resize(at + layout_.point_step);
    copyRuns(runs, in_map.data.data() + i * in_map.point_step, tile.records.data() + at);
    tile.column.push_back(added[i].column);
    tile.z.push_back(added[i].z);
  }
  size_ += added.size();
  return added.size();
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
