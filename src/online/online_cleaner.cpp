// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/online/online_cleaner.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <future>

#include "beautymap/io/cloud_fields.h"
#include "beautymap/io/scan_conversion.h"
#include "beautymap/matrix/cell_size.h"
#include "online_cleaner_locks.h"

namespace beautymap {
namespace {

/// Points beyond the radius would bring back the tiles that were put on disk.
Config withinRadius(Config config) {
  if (config.online.radius > 0.0) {
    config.scan.max_range = std::min(config.scan.max_range, config.online.radius);
  }
  return config;
}

}  // namespace

OnlineCleaner::OnlineCleaner(const Config& config, std::string folder)
    : config_(withinRadius(config)),
      folder_(std::move(folder)),
      map_(config_),
      points_(config.matrix.res_g, config.online.map_voxel) {
  if (config.online.radius <= 0.0) return;
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (folder_.empty() || error) {
    throw InputError("cannot make the folder '" + folder_ + "' for tiles outside of online.radius" +
                     (error ? ": " + error.message() : ""));
  }
}

OnlineCleaner::~OnlineCleaner() {
  std::error_code ignored;
  for (const auto& tile : on_disk_) {
    std::filesystem::remove(fileOf({tile.first.first, tile.first.second}), ignored);
  }
  if (!folder_.empty()) std::filesystem::remove(folder_, ignored);  // only if it is empty
}

const std::vector<PointClass>& OnlineCleaner::add(const SourceScan& source) {
  Scan scan;
  convertScan(source, scan);
  const FirstLock lock(*this);
  if (!started_) {
    setCellSize(cellSizeFor(scan, config_).value_or(config_.matrix.res_g));
    float64_ =
        scan.sensor_in_map.cwiseAbs().maxCoeff() + config().scan.max_range > kMaxFloat32Coordinate;
    UpFinder finder;
    finder.add(scan, source.T_map_sensor.linear().col(2));
    up_ = finder.find(config_);
  }
  up_.level(scan);
  if (scan.sensor_in_map.allFinite()) fetchNear(scan.sensor_in_map);
  const auto& classes = map_.addHits(scan);
  started_ = map_.map().tileCount() > 0;
  settled_ = true;
  return classes;
}

void OnlineCleaner::setCellSize(double res_g) {
  if (res_g == config().matrix.res_g) return;
  Config changed = config_;
  changed.matrix.res_g = res_g;
  map_ = OnlineMap(changed);
  points_ = PointStore(res_g, changed.online.map_voxel);
}

void OnlineCleaner::finish(const SourceScan& scan, bool see_free) {
  const FirstLock lock(*this);
  // The points and the matrix have nothing in common: two threads share the time.
  auto stored = std::async(std::launch::async, [&] {
    points_.add(map_.placed(), scan.cloud, scan.T_map_cloud, float64_);
  });
  if (see_free) map_.addSeenFree();
  settled_ = false;
  stored.get();
  storeFar(up_.levelFromMap() * scan.T_map_sensor.translation());
}

double OnlineCleaner::distance(ColumnIndex tile, const Eigen::Vector3d& sensor) const {
  const double side = config().matrix.res_g * Tile::kSide;
  return std::hypot((tile.x + 0.5) * side - sensor.x(), (tile.y + 0.5) * side - sensor.y());
}

std::string OnlineCleaner::fileOf(ColumnIndex tile) const {
  return folder_ + "/tile_" + std::to_string(tile.x) + "_" + std::to_string(tile.y);
}

void OnlineCleaner::fetch(ColumnIndex index, Tile& tile, TilePoints& points) const {
  TileFileReader reader(fileOf(index), config());
  ColumnIndex read;
  if (!reader.next(read, tile, points) || read != index) {
    throw InputError("'" + fileOf(index) + "' holds another tile");
  }
}

void OnlineCleaner::fetchNear(const Eigen::Vector3d& sensor) {
  const double side = config().matrix.res_g * Tile::kSide;
  for (auto it = on_disk_.begin(); it != on_disk_.end();) {
    const ColumnIndex index{it->first.first, it->first.second};
    if (distance(index, sensor) > config().online.radius + side) {
      ++it;
      continue;
    }
    TilePoints points;
    Tile tile = map_.map().newTile();
    fetch(index, tile, points);
    map_.map().tileAt(index) = std::move(tile);
    points_.countAdded(points.size());
    points_.tileAt(index) = std::move(points);
    std::error_code ignored;
    std::filesystem::remove(fileOf(index), ignored);
    it = on_disk_.erase(it);
  }
}

void OnlineCleaner::storeFar(const Eigen::Vector3d& sensor) {
  const double radius = config().online.radius;
  if (radius <= 0.0) return;
  const double side = config().matrix.res_g * Tile::kSide;
  std::vector<ColumnIndex> far;
  map_.map().forEachTile([&](ColumnIndex index, const Tile&) {
    // Farther than what fetchNear() brings back, so that a standing sensor moves no tile.
    if (distance(index, sensor) > radius + 2.0 * side) far.push_back(index);
  });
  if (!far.empty()) map_.settle();
  for (const ColumnIndex index : far) {
    const TilePoints& points = points_.tileAt(index);
    TileFileWriter writer(fileOf(index), header(""), config());
    writer.append(index, *map_.map().findTile(index), points);
    writer.close();
    on_disk_[{index.x, index.y}] = points.size();
    points_.erase(index);
    map_.map().erase(index);
  }
}

TileFileWriter::Header OnlineCleaner::header(const std::string& map_frame) const {
  return {map_frame, map_.zOrigin(), up_.up, points_.layout()};
}

std::vector<ColumnIndex> OnlineCleaner::tiles() const {
  const ReaderLock lock(*this);
  std::vector<ColumnIndex> tiles = tilesOf(map_.map());
  for (const auto& tile : on_disk_) tiles.push_back({tile.first.first, tile.first.second});
  std::sort(tiles.begin(), tiles.end(),
            [](ColumnIndex a, ColumnIndex b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  return tiles;
}

bool OnlineCleaner::look(ColumnIndex index, TileView& view) const {
  // As it was judged at one moment; the points are then copied in portions and judged without the
  // lock, so that no scan waits for a tile of a million points.
  Tile judged(0);
  TilePoints portion;
  bool on_disk = false;
  std::size_t size = 0;
  {
    const ReaderLock lock(*this);
    lock.settle(*this);
    on_disk = on_disk_.count({index.x, index.y}) != 0;
    if (on_disk) {
      judged = map_.map().newTile();
      fetch(index, judged, portion);
    }
    const Tile* tile = on_disk ? &judged : std::as_const(map_).map().findTile(index);
    const TilePoints* points = on_disk ? &portion : points_.findTile(index);
    if (tile == nullptr || points == nullptr) return false;
    size = points->size();
    // Both only grow.
    const std::uint64_t version = 1 + tile->revision + size;
    if (version == view.version) return false;
    view.version = version;
    if (!on_disk) judged = *tile;
  }
  view.cleaned.clear();
  view.removed.clear();
  if (on_disk) {
    take(portion, judged, view);
    return true;
  }
  constexpr std::size_t kPortion = 10000;  // points: some hundredths of a millisecond
  for (std::size_t begin = 0; begin < size; begin += kPortion) {
    if (!copyPoints(index, begin, std::min(begin + kPortion, size), portion)) {
      view = TileView();  // written to disk meanwhile
      return look(index, view);
    }
    take(portion, judged, view);
  }
  return true;
}

bool OnlineCleaner::copyPoints(ColumnIndex tile, std::size_t begin, std::size_t end,
                               TilePoints& copy) const {
  const ReaderLock lock(*this);
  const TilePoints* points = points_.findTile(tile);
  if (points == nullptr) return false;
  const std::size_t step = points->records.size() / points->size();
  const auto copyRange = [&](const auto& from, auto& to, std::size_t values) {
    to.assign(from.data() + begin * values, from.data() + end * values);
  };
  copyRange(points->records, copy.records, step);
  copyRange(points->column, copy.column, 1);
  copyRange(points->z, copy.z, 1);
  return true;
}

void OnlineCleaner::take(const TilePoints& points, const Tile& judged, TileView& view) const {
  if (points.size() == 0) return;
  const std::size_t step = points.records.size() / points.size();
  for (std::size_t begin = 0, end = 0; begin < points.size(); begin = end) {
    // A run of points that are judged alike.
    const auto isDynamic = [&](std::size_t i) {
      return map_.isDynamic(judged, points.column[i], points.z[i]);
    };
    const bool dynamic = isDynamic(begin);
    for (end = begin + 1; end < points.size() && isDynamic(end) == dynamic; ++end) {
    }
    auto& records = dynamic ? view.removed : view.cleaned;
    const std::uint8_t* record = points.records.data();
    records.insert(records.end(), record + begin * step, record + end * step);
  }
}

pcl::PCLPointCloud2 OnlineCleaner::layout() const {
  const FirstLock lock(*this);
  return points_.layout();
}

OnlineCleaner::MatrixView OnlineCleaner::matrixAround(double half_side_m) const {
  const ReaderLock lock(*this);
  lock.settle(*this);
  const int half = std::max(1, static_cast<int>(half_side_m / config().matrix.res_g));
  const ColumnIndex centre = map_.placed().anchor;
  const ColumnWindow window{{centre.x - half, centre.y - half}, 2 * half + 1};
  return {config().matrix, map_.map().extract(window, &Tile::occupied, Bits{0}),
          map_.map().extract(window, &Tile::dynamic, Bits{0}), up_.levelFromMap().inverse()};
}

std::optional<UpDirection> OnlineCleaner::up() const {
  const FirstLock lock(*this);
  if (!started_) return {};
  return up_;
}

OnlineCleaner::Size OnlineCleaner::size() const {
  const FirstLock lock(*this);
  Size size;
  size.points = points_.size();
  for (const auto& tile : on_disk_) size.points += tile.second;
  size.tiles = map_.map().tileCount() + on_disk_.size();
  size.tiles_on_disk = on_disk_.size();
  size.cell_m = config().matrix.res_g;
  size.memory_mb =
      static_cast<double>(map_.map().memoryBytes() + points_.memoryBytes()) / 1048576.0;
  return size;
}

DroppedPoints OnlineCleaner::dropped() const {
  const FirstLock lock(*this);
  return map_.dropped();
}

StageTimes OnlineCleaner::times() const {
  const FirstLock lock(*this);
  return map_.times();
}

}  // namespace beautymap
