// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/PCLPointCloud2.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "beautymap/cleaner/online_map.h"
#include "beautymap/config/config.h"
#include "beautymap/io/scan_source.h"
#include "beautymap/matrix/up_direction.h"
#include "beautymap/online/point_store.h"
#include "beautymap/online/tile_file.h"

namespace beautymap {

/// A map that is cleaned while it grows: the matrix, the points, and tiles on disk when a radius is
/// set. Tiles are where they are with up as z; points, what is saved and published, are in the map
/// frame. One thread adds scans; others may look at the map at the same time, a tile at a time, and
/// give way to the scans.
class OnlineCleaner {
 public:
  /// @param folder  for tiles outside of online.radius; removed again with the cleaner. May be
  /// empty without a radius.
  /// @throws ConfigError; InputError when the folder cannot be made.
  OnlineCleaner(const Config& config, std::string folder);
  ~OnlineCleaner();
  OnlineCleaner(const OnlineCleaner&) = delete;
  OnlineCleaner& operator=(const OnlineCleaner&) = delete;

  /// The class of each point, to be published before finish() is called.
  /// @throws std::invalid_argument when the pose is not finite; nothing is changed then.
  const std::vector<PointClass>& add(const SourceScan& scan);
  /// What the same scan saw free; its points join the map.
  /// @param see_free  false leaves the former out, which takes most of the time
  /// @throws InputError when a tile cannot be written to disk; it stays in memory then.
  void finish(const SourceScan& scan, bool see_free = true);

  /// The points of one tile as they are judged now.
  struct TileView {
    std::uint64_t version = 0;  ///< another one when the points or what is said of them differ
    std::vector<std::uint8_t> cleaned;  ///< records
    std::vector<std::uint8_t> removed;
  };
  /// All tiles, those on disk as well.
  std::vector<ColumnIndex> tiles() const;
  /// Updates a view of a tile.
  /// @return false when it is up to date already; nothing is done then
  bool look(ColumnIndex tile, TileView& view) const;
  /// Fields and point_step of the records, no points.
  pcl::PCLPointCloud2 layout() const;
  /// The columns in a window around the last sensor position.
  struct MatrixView {
    MatrixConfig config;
    BitGrid occupied, dynamic;
    Eigen::Isometry3d T_map_level;  ///< its columns stand upright in the level frame
  };
  MatrixView matrixAround(double half_side_m) const;

  /// Which way is up, as the first scan or a session says; nothing before.
  std::optional<UpDirection> up() const;

  /// Writes the whole state, so that load() can go on with it.
  void saveSession(const std::string& path, const std::string& map_frame) const;
  /// Instead of the first scan. @return the map's frame
  std::string loadSession(const std::string& path);

  struct Size {
    std::size_t points = 0;
    std::size_t tiles = 0;
    std::size_t tiles_on_disk = 0;
    double memory_mb = 0.0;
    double cell_m = 0.0;  ///< horizontally, as the place asks for
  };
  Size size() const;
  DroppedPoints dropped() const;
  /// Time of each stage over all scans.
  StageTimes times() const;

 private:
  class FirstLock;
  class ReaderLock;
  /// With the size of the cells that the place asks for.
  const Config& config() const { return map_.config(); }
  /// Before the map holds anything.
  void setCellSize(double res_g);
  void fetchNear(const Eigen::Vector3d& sensor);
  void storeFar(const Eigen::Vector3d& sensor);
  double distance(ColumnIndex tile, const Eigen::Vector3d& sensor) const;
  std::string fileOf(ColumnIndex tile) const;
  void fetch(ColumnIndex index, Tile& tile, TilePoints& points) const;
  /// @return false when the tile is not in memory any more
  bool copyPoints(ColumnIndex tile, std::size_t begin, std::size_t end, TilePoints& copy) const;
  /// Appends the points to what a view shows.
  void take(const TilePoints& points, const Tile& judged, TileView& view) const;
  TileFileWriter::Header header(const std::string& map_frame) const;

  Config config_;  ///< as it was given
  std::string folder_;
  mutable OnlineMap map_;        ///< changed by those who look only to judge what is not yet
  mutable bool settled_ = true;  ///< everything in the map is judged
  PointStore points_;
  std::map<std::pair<std::int32_t, std::int32_t>, std::size_t> on_disk_;  ///< tile: its points
  UpDirection up_;
  bool float64_ = false;
  bool started_ = false;
  mutable std::mutex mutex_;
  mutable std::atomic<int> first_waiting_{0};  ///< in FirstLock
};

}  // namespace beautymap
