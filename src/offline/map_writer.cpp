// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "map_writer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <future>
#include <limits>
#include <string>
#include <thread>

#include "beautymap/io/cloud_fields.h"
#include "beautymap/io/moving_labels.h"
#include "beautymap/io/pcd_header.h"
#include "beautymap/io/pcd_stream.h"
#include "beautymap/io/scan_conversion.h"

namespace beautymap {
namespace {

// Points that are shown to the evaluator at once; they fit into the cache.
constexpr std::size_t kScoredBlock = 1 << 13;

/// The smallest box around all scans' points, horizontally and with up as z, and their largest
/// coordinate in the map frame [m].
struct Extent {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d high = -low;
  double largest = 0.0;
};

Extent extentOf(const MapCleaner& cleaner, const UpDirection& up) {
  Extent extent;
  const double side = cleaner.config().matrix.res_g * Tile::kSide;
  cleaner.map().forEachTile([&](ColumnIndex index, const Tile&) {
    const Eigen::Vector2d corner = Eigen::Vector2d(index.x, index.y) * side;
    extent.low = extent.low.cwiseMin(corner);
    extent.high = extent.high.cwiseMax(corner + Eigen::Vector2d::Constant(side));
  });
  const Eigen::Vector2d largest = extent.low.cwiseAbs().cwiseMax(extent.high.cwiseAbs());
  const Eigen::Vector3d level(largest.x(), largest.y(),
                              std::abs(cleaner.zOrigin()) + cleaner.config().scan.max_range);
  extent.largest = (up.levelFromMap().linear().transpose().cwiseAbs() * level).maxCoeff();
  return extent;
}

TopView topViewOf(const Extent& extent) { return {extent.low, extent.high - extent.low}; }

}  // namespace

MapWriter::MapWriter(const MapCleaner& cleaner, const ScanSource& source, bool labelled,
                     const OfflineOptions& options, OfflineReport& report)
    : cleaner_(cleaner),
      source_(source),
      labelled_(labelled),
      options_(options),
      report_(report),
      cleaned_(options.output + "/cleaned.pcd", options.voxel_m),
      dynamic_(options.output + "/dynamic.pcd", options.voxel_m),
      evaluator_(options.score_radius_m),
      T_level_map_(report.up.levelFromMap()),
      top_view_(topViewOf(extentOf(cleaner, report.up))),
      top_views_(top_view_) {
  report_.float64_coordinates = extentOf(cleaner, report.up).largest > kMaxFloat32Coordinate;
}

void MapWriter::prepare(ScanView& view, SourceScan& scan, ScanOutput& output) {
  cleaner_.classify(view, output.classes);
  output.times = {};
  StageClock clock(output.times);
  if (labelled_) output.labels = labelsOf(scan.cloud, source_);
  moveCloud(scan.cloud, scan.T_map_cloud, report_.float64_coordinates, output.in_map);
  if (!thins()) split(output);
  clock.lap("write");
}

void MapWriter::write(ScanOutput& output) {
  StageClock clock(output.times);
  if (thins()) split(output);
  cleaned_.append(output.in_map, output.kept.records);
  dynamic_.append(output.in_map, output.removed.records);
  report_.static_points += output.kept.points;
  report_.dynamic_points += output.removed.points;
  evaluator_.addKept(false, output.kept_static);
  evaluator_.addKept(true, output.kept_moving);
  for (const auto& point : output.unmatched) {
    evaluator_.addUnmatched(point.position, point.moving);
  }
  clock.lap("write");
  report_.stages.add(output.times);
}

/// Some of a scan's points, few enough for the cache.
struct MapWriter::Block {
  static constexpr std::size_t kMost = 1024;

  std::size_t first = 0, last = 0;
  std::array<Eigen::Vector3d, kMost> positions;  ///< [m] in the map
  std::array<std::uint32_t, kMost> pixels;       ///< of the top view

  const Eigen::Vector3d& position(std::size_t point) const { return positions[point - first]; }
  std::uint32_t pixel(std::size_t point) const { return pixels[point - first]; }
};

void MapWriter::split(ScanOutput& output) {
  for (ScanOutput::Part* part : {&output.kept, &output.removed}) {
    part->points = 0;
    part->records.clear();
  }
  output.kept_static = output.kept_moving = 0;
  output.unmatched.clear();
  const PositionReader position_of(output.in_map);
  TopView& top_view = top_views_.local();
  const std::vector<PointClass>& classes = output.classes;
  Block block;
  for (; block.first < classes.size(); block.first = block.last) {
    block.last = std::min(classes.size(), block.first + Block::kMost);
    for (std::size_t i = block.first; i < block.last; ++i) {
      block.positions[i - block.first] = position_of(i);
    }
    if (report_.up.isZ()) {
      top_view.findPixels(block.positions.data(), block.last - block.first, block.pixels.data());
    } else {
      std::array<Eigen::Vector3d, Block::kMost> level;
      for (std::size_t i = block.first; i < block.last; ++i) {
        level[i - block.first] = T_level_map_ * block.position(i);
      }
      top_view.findPixels(level.data(), block.last - block.first, block.pixels.data());
    }
    // Neighbouring points mostly have the same class.
    for (std::size_t first = block.first, last = first; first < block.last; first = last) {
      while (last < block.last && classes[last] == classes[first]) ++last;
      splitRun(block, first, last, top_view, output);
    }
  }
}

void MapWriter::splitRun(const Block& block, std::size_t first, std::size_t last, TopView& top_view,
                         ScanOutput& output) {
  if (output.classes[first] == PointClass::kDropped) {
    put(block, first, last, false, output);
    return;
  }
  const bool removed = output.classes[first] == PointClass::kDynamic;
  (removed ? output.removed : output.kept).points += last - first;
  for (std::size_t i = first; i < last; ++i) {
    // What the label leaves open is no mistake either way.
    const PointLabel label = labelled_ ? output.labels[i] : PointLabel::kStatic;
    top_view.add(block.pixel(i), removed,
                 label == PointLabel::kMoving || (label == PointLabel::kIgnored && removed));
  }
  if (!thins()) {
    put(block, first, last, true, output);
    return;
  }
  PointFile& file = removed ? dynamic_ : cleaned_;
  for (std::size_t i = first; i < last; ++i) {
    put(block, i, i + 1, file.takes(block.position(i)), output);
  }
}

void MapWriter::put(const Block& block, std::size_t first, std::size_t last, bool written,
                    ScanOutput& output) const {
  const bool removed = output.classes[first] == PointClass::kDynamic;
  if (written) {
    std::vector<std::uint8_t>& records = (removed ? output.removed : output.kept).records;
    const std::uint8_t* scan = output.in_map.data.data();
    const std::size_t step = output.in_map.point_step;
    records.insert(records.end(), scan + first * step, scan + last * step);
  }
  if (!labelled_) return;
  if (written && !removed) {
    for (std::size_t i = first; i < last; ++i) {
      output.kept_moving += output.labels[i] == PointLabel::kMoving ? 1 : 0;
      output.kept_static += output.labels[i] == PointLabel::kStatic ? 1 : 0;
    }
    return;
  }
  for (std::size_t i = first; i < last; ++i) {
    if (output.labels[i] == PointLabel::kIgnored) continue;
    output.unmatched.push_back({block.position(i), output.labels[i] == PointLabel::kMoving});
  }
}

void MapWriter::finish() {
  cleaned_.close();
  dynamic_.close();
  for (const TopView& view : top_views_) top_view_.add(view);
  top_views_.clear();
  StageClock clock(report_.stages);
  auto pictures = std::async(std::launch::async, [&] { writePictures(); });
  if (labelled_) score();
  clock.lap("score");
  pictures.get();
  clock.lap("pictures");
}

void MapWriter::score() {
  evaluator_.finishTruth();
  // Each thread shows its share of the file. Their order does not matter.
  const std::uint64_t size = readPcdHeader(cleaned_.path()).points;
  const std::uint64_t threads = std::max(1U, std::thread::hardware_concurrency());
  std::vector<std::future<void>> shares;
  for (std::uint64_t t = 0; t < threads; ++t) {
    const PcdRange share{size * t / threads, size * (t + 1) / threads};
    shares.push_back(std::async(std::launch::async, [&, share] {
      std::vector<Eigen::Vector3d> points;
      const auto show = [&](const pcl::PCLPointCloud2& block) {
        const PositionReader position(block);
        points.resize(block.width);
        for (std::size_t i = 0; i < points.size(); ++i) points[i] = position(i);
        evaluator_.showCleaned(points);
      };
      readPcdBlocks(cleaned_.path(), show, kScoredBlock, share);
    }));
  }
  for (auto& share : shares) share.get();
  report_.score = evaluator_.score();
}

void MapWriter::writePictures() const {
  top_view_.before().writePng(options_.output + "/before.png");
  top_view_.after().writePng(options_.output + "/after.png");
  if (labelled_) top_view_.mistakes().writePng(options_.output + "/mistakes.png");
  drawMatrix(cleaner_.map()).writePng(options_.output + "/matrix.png");
}

}  // namespace beautymap
