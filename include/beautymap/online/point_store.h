// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/PCLPointCloud2.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "beautymap/io/copy_runs.h"
#include "beautymap/matrix/scan.h"
#include "beautymap/matrix/tile_map.h"

namespace beautymap {

/// Keys of voxels: open addressing, because millions of them are looked up per second.
class VoxelSet {
 public:
  /// @return false when it was there already
  bool insert(std::uint64_t key);
  /// Fetches from memory what insert(key) will look at: most of its time is waiting for that.
  void prefetch(std::uint64_t key) const {
    if (!slots_.empty()) __builtin_prefetch(&slots_[home(key + 1)]);
  }
  std::size_t size() const { return size_; }
  std::size_t memoryBytes() const { return slots_.size() * sizeof(std::uint64_t); }
  /// All keys, in no particular order.
  std::vector<std::uint64_t> keys() const;

 private:
  bool place(std::uint64_t slot);
  /// Where a slot's search begins. Fibonacci hashing: neighbouring voxels must not fill
  /// neighbouring slots.
  std::size_t home(std::uint64_t slot) const {
    return static_cast<std::size_t>(slot * 0x9E3779B97F4A7C15ULL >> 20) & (slots_.size() - 1);
  }

  std::vector<std::uint64_t> slots_;  ///< key + 1; 0: empty
  std::size_t size_ = 0;
};

/// The points of one tile: their records in the map frame, and what a judgement needs.
struct TilePoints {
  std::vector<std::uint8_t> records;
  std::vector<std::uint16_t> column;  ///< in the tile
  std::vector<float> z;               ///< [m] above the map's z origin
  VoxelSet voxels;

  std::size_t size() const { return column.size(); }
  std::size_t memoryBytes() const;
};

/// The points of a map, by tile: every point, or the first in each voxel, in the order in which
/// they came. All records have the layout of the first cloud.
class PointStore {
 public:
  /// @param voxel_m  side of the voxels [m]; 0: every point is kept
  PointStore(double res_g, double voxel_m) : res_g_(res_g), voxel_m_(voxel_m) {}

  /// Adds the points of a scan with all fields of its cloud, coordinates in the map frame. Fields
  /// that the first cloud did not have are left out, those that this one lacks are 0.
  /// @param as_float64  type of the coordinates in the map frame; otherwise float32
  /// @return how many were kept
  std::size_t add(const PlacedScan& placed, const pcl::PCLPointCloud2& cloud,
                  const Eigen::Isometry3d& T_map_cloud, bool as_float64);

  /// Fields and point_step of the records, no points; without fields before the first scan.
  const pcl::PCLPointCloud2& layout() const { return layout_; }
  void setLayout(const pcl::PCLPointCloud2& layout) { layout_ = layout; }

  TilePoints& tileAt(ColumnIndex tile) { return tiles_[{tile.x, tile.y}]; }
  const TilePoints* findTile(ColumnIndex tile) const;
  void erase(ColumnIndex tile);
  std::size_t size() const { return size_; }
  /// A tile was filled from outside.
  void countAdded(std::size_t points) { size_ += points; }
  std::size_t memoryBytes() const;

 private:
  struct NewPoint {
    TilePoints* tile;
    std::uint64_t voxel;   ///< its key
    std::uint32_t source;  ///< index in the scan's cloud
    std::uint16_t column;
    float z;
  };
  /// Those of a scan's points that are the first in their voxels.
  std::vector<NewPoint> newPoints(const PlacedScan& placed);

  double res_g_;
  double voxel_m_;
  pcl::PCLPointCloud2 layout_;
  std::map<std::pair<std::int32_t, std::int32_t>, TilePoints> tiles_;
  std::size_t size_ = 0;
};

/// How records of a cloud's layout become records of another one: fields of the same name and type.
std::vector<CopyRun> recordRuns(const pcl::PCLPointCloud2& from, const pcl::PCLPointCloud2& to);

/// Fields and point_step of a cloud.
pcl::PCLPointCloud2 layoutOf(const pcl::PCLPointCloud2& cloud);

}  // namespace beautymap
