// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/offline/offline_cleaner.h"

#include <sys/resource.h>

#if __has_include(<tbb/parallel_pipeline.h>)
#include <tbb/parallel_pipeline.h>
using Mode = tbb::filter_mode;
#else  // before oneTBB
#include <tbb/pipeline.h>
using Mode = tbb::filter;
#endif

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <filesystem>
#include <fstream>
#include <future>
#include <limits>
#include <optional>
#include <thread>
#include <unordered_set>
#include <utility>

#include "beautymap/cell_size.h"
#include "beautymap/io/cloud_fields.h"
#include "beautymap/io/moving_labels.h"
#include "beautymap/io/pcd_header.h"
#include "beautymap/io/pcd_stream.h"
#include "beautymap/io/placed_spool.h"
#include "beautymap/io/scan_conversion.h"
#include "beautymap/io/scan_spool.h"
#include "beautymap/map_cleaner.h"
#include "beautymap/offline/pictures.h"

namespace beautymap {
namespace {

// Points that are shown to the evaluator at once; they fit into the cache.
constexpr std::size_t kScoredBlock = 1 << 13;

/// A scan as the source gave it, as the core takes it, and what it says.
struct ReadScan {
  SourceScan source;
  Scan scan;
  ScanView view;
  std::string unusable;  ///< why, or empty
  // To be written:
  std::vector<PointClass> classes;
  std::vector<bool> moving;    ///< the labels; empty without
  pcl::PCLPointCloud2 in_map;  ///< all fields, x y z in the map frame
};

/// Calls read(scan) until it returns false, work(scan) and use(scan) for each scan. read and use
/// see the scans one by one in their order; work is done for several at once.
template <typename Read, typename Work, typename Use>
void runPipeline(Read read, Work work, Use use) {
  // A scan's memory is used again for a later one: no more scans than these are on their way, and
  // they end in their order.
  std::vector<ReadScan> scans(std::thread::hardware_concurrency() + 1);
  std::size_t next = 0;
  const auto input = [&](tbb::flow_control& control) -> ReadScan* {
    ReadScan& scan = scans[next++ % scans.size()];
    if (!read(scan)) control.stop();
    return &scan;
  };
  tbb::parallel_pipeline(
      scans.size(), tbb::make_filter<void, ReadScan*>(Mode::serial_in_order, input) &
                        tbb::make_filter<ReadScan*, ReadScan*>(Mode::parallel,
                                                               [&](ReadScan* scan) {
                                                                 work(*scan);
                                                                 return scan;
                                                               }) &
                        tbb::make_filter<ReadScan*, void>(Mode::serial_in_order,
                                                          [&](ReadScan* scan) { use(*scan); }));
}

/// The smallest box around all scans' points, horizontally, and their largest coordinate [m].
struct Extent {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d high = -low;
  double largest = 0.0;
};

Extent extentOf(const MapCleaner& cleaner) {
  Extent extent;
  const double side = cleaner.config().matrix.res_g * Tile::kSide;
  cleaner.map().forEachTile([&](ColumnIndex index, const Tile&) {
    const Eigen::Vector2d corner = Eigen::Vector2d(index.x, index.y) * side;
    extent.low = extent.low.cwiseMin(corner);
    extent.high = extent.high.cwiseMax(corner + Eigen::Vector2d::Constant(side));
  });
  extent.largest = std::max({extent.low.cwiseAbs().maxCoeff(), extent.high.cwiseAbs().maxCoeff(),
                             std::abs(cleaner.zOrigin()) + cleaner.config().scan.max_range});
  return extent;
}

/// One of the two point files.
class PointFile {
 public:
  PointFile(std::string path, double voxel_m) : path_(std::move(path)), voxel_m_(voxel_m) {}

  void append(const pcl::PCLPointCloud2& cloud, std::size_t first, std::size_t count) {
    if (!writer_) writer_ = std::make_unique<PcdStreamWriter>(path_, cloud);
    writer_->append(cloud.data.data() + first * cloud.point_step, count);
  }
  /// Whether a point's voxel is still free; it is taken then.
  bool takes(const Eigen::Vector3d& position) {
    return voxel_m_ <= 0.0 || voxels_.insert(voxelKey(position, voxel_m_)).second;
  }
  void close(const pcl::PCLPointCloud2& layout) {
    if (!writer_) writer_ = std::make_unique<PcdStreamWriter>(path_, layout);
    writer_->close();
  }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  double voxel_m_;
  std::unique_ptr<PcdStreamWriter> writer_;
  std::unordered_set<std::uint64_t> voxels_;
};

/// The first scans, up to one that says what size the cells should have.
/// @param config  gets that size
std::deque<SourceScan> readAhead(ScanSource& source, Config& config) {
  constexpr std::size_t kMost = 10;
  std::deque<SourceScan> scans;
  SourceScan read;
  while (scans.size() < kMost && source.next(read)) {
    scans.push_back(read);
    Scan scan;
    convertScan(read, scan);
    const std::optional<double> size = cellSizeFor(scan, config);
    if (!size) continue;
    config.matrix.res_g = *size;
    break;
  }
  return scans;
}

/// The passes over the scans, in their order.
class OfflineRun {
 public:
  OfflineRun(ScanSource& source, Config config, const OfflineOptions& options,
             const ProgressListener& progress)
      : source_(source),
        options_(options),
        progress_(progress),
        read_ahead_(readAhead(source, config)),
        cleaner_(config),
        spool_(options.output),
        placed_(options.output),
        evaluator_(options.score_radius_m) {}

  OfflineReport run() {
    const auto start = std::chrono::steady_clock::now();
    observe();
    cleaner_.estimateGround();
    if (cleaner_.needsEncoding()) {
      pass(
          "encoding", [&](ReadScan& s) { return placed_.next(s.view.placed, Part::kHeights); },
          [](ReadScan&) {}, [&](const ReadScan& s) { cleaner_.encode(s.view); });
    }
    pass(
        "comparing", [&](ReadScan& s) { return placed_.next(s.view.placed); },
        [&](ReadScan& s) { cleaner_.look(s.view); },
        [&](const ReadScan& s) { cleaner_.add(s.view); });
    cleaner_.segmentGround();
    write();
    for (const auto& stage : cleaner_.times().stages())
      report_.stages.add(stage.first, stage.second);
    report_.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    report_.peak_memory_mb = static_cast<double>(usage.ru_maxrss) / 1024.0;
    return report_;
  }

 private:
  using Part = PlacedSpool::Part;

  bool nextScan(SourceScan& scan);
  void observe();
  template <typename Read, typename Work, typename Use>
  void pass(const std::string& name, Read read, Work work, Use use);
  void write();
  void prepareWriting(ReadScan& read);
  void writeScan(const ReadScan& read);
  void writeRun(const ReadScan& read, std::size_t first, std::size_t last);
  void scoreAgainst(const std::string& cleaned);
  void writePictures() const;

  ScanSource& source_;
  const OfflineOptions& options_;
  const ProgressListener& progress_;
  std::deque<SourceScan> read_ahead_;  ///< the first scans, until observe() takes them
  MapCleaner cleaner_;
  ScanSpool spool_;     ///< the scans as they came, for writing
  PlacedSpool placed_;  ///< the same scans in the map, for the passes between
  Evaluator evaluator_;
  OfflineReport report_;
  bool labelled_ = true;  ///< until a scan without labels comes
  std::unique_ptr<PointFile> cleaned_, dynamic_;
  std::unique_ptr<TopView> top_view_;
  pcl::PCLPointCloud2 output_layout_;
};

bool OfflineRun::nextScan(SourceScan& scan) {
  if (read_ahead_.empty()) return source_.next(scan);
  scan = std::move(read_ahead_.front());
  read_ahead_.pop_front();
  return true;
}

void OfflineRun::observe() {
  progress_.begin("reading", source_.size());
  const auto skip = [&](const std::string& reason, const std::string& example) {
    Skipped& skipped = report_.skipped_scans[reason];
    if (skipped.count++ == 0) skipped.example = example;
  };
  runPipeline(
      [&](ReadScan& read) {
        if (!nextScan(read.source)) return false;
        cleaner_.startAt(read.source.T_map_sensor.translation());
        return true;
      },
      [&](ReadScan& read) {
        convertScan(read.source, read.scan);
        try {
          read.unusable.clear();
          cleaner_.place(read.scan, read.view);
        } catch (const std::invalid_argument& e) {
          read.unusable = e.what();
        }
      },
      [&](const ReadScan& read) {
        progress_.step();
        if (!spool_.accepts(read.source)) {
          skip("fields differ from the first scan's", "scan " + std::to_string(report_.scans));
          return;
        }
        if (!read.unusable.empty()) {
          skip("unusable pose", read.unusable);
          return;
        }
        cleaner_.observe(read.view);
        StageClock clock(report_.stages);
        spool_.append(read.source);
        placed_.append(read.view.placed);
        clock.lap("spool");
        ++report_.scans;
        report_.points += read.scan.cloud.size();
        labelled_ = labelled_ && FieldReader::has(read.source.cloud, "label");
      });
  for (const auto& skipped : source_.skipped()) report_.skipped_scans.insert(skipped);
  report_.dropped_points = cleaner_.dropped();
  if (report_.scans > 0) return;
  std::string reasons;
  for (const auto& s : report_.skipped_scans) {
    reasons += "\n  " + std::to_string(s.second.count) + " x " + s.first + ": " + s.second.example;
  }
  throw InputError("no scan can be used" + (reasons.empty() ? ": the input is empty" : reasons));
}

/// Reads the scans once more, see runPipeline().
template <typename Read, typename Work, typename Use>
void OfflineRun::pass(const std::string& name, Read read, Work work, Use use) {
  progress_.begin(name, placed_.size());
  placed_.rewind();
  runPipeline(read, work, [&](const ReadScan& scan) {
    use(scan);
    progress_.step();
  });
}

void OfflineRun::write() {
  const Extent extent = extentOf(cleaner_);
  report_.float64_coordinates = extent.largest > kMaxFloat32Coordinate;
  report_.cell_size_m = cleaner_.config().matrix.res_g;
  report_.tiles = cleaner_.map().tileCount();
  report_.matrix_memory_mb = static_cast<double>(cleaner_.map().memoryBytes()) / 1048576.0;
  top_view_ = std::make_unique<TopView>(extent.low, extent.high - extent.low);
  cleaned_ = std::make_unique<PointFile>(options_.output + "/cleaned.pcd", options_.voxel_m);
  dynamic_ = std::make_unique<PointFile>(options_.output + "/dynamic.pcd", options_.voxel_m);
  spool_.rewind();
  pass(
      "writing",
      [&](ReadScan& read) {
        return placed_.next(read.view.placed, Part::kHeights) && spool_.next(read.source);
      },
      [&](ReadScan& read) { prepareWriting(read); },
      [&](const ReadScan& read) { writeScan(read); });
  cleaned_->close(output_layout_);
  dynamic_->close(output_layout_);
  StageClock clock(report_.stages);
  auto pictures = std::async(std::launch::async, [&] { writePictures(); });
  if (labelled_) scoreAgainst(cleaned_->path());
  clock.lap("score");
  pictures.get();
  clock.lap("pictures");
}

void OfflineRun::prepareWriting(ReadScan& read) {
  cleaner_.classify(read.view, read.classes);
  if (labelled_) read.moving = movingPoints(read.source.cloud, source_);
  moveCloud(read.source.cloud, read.source.T_map_cloud, report_.float64_coordinates, read.in_map);
}

void OfflineRun::writeScan(const ReadScan& read) {
  cleaner_.addTimes(read.view);
  StageClock clock(report_.stages);
  output_layout_.fields = read.in_map.fields;
  output_layout_.point_step = read.in_map.point_step;
  // Neighbouring points mostly have the same class.
  const std::vector<PointClass>& classes = read.classes;
  for (std::size_t first = 0, last = 0; first < classes.size(); first = last) {
    while (last < classes.size() && classes[last] == classes[first]) ++last;
    writeRun(read, first, last);
  }
  clock.lap("write");
}

void OfflineRun::writeRun(const ReadScan& read, std::size_t first, std::size_t last) {
  const PointClass point_class = read.classes[first];
  const bool removed = point_class == PointClass::kDynamic;
  const bool dropped = point_class == PointClass::kDropped;
  const PositionReader position_of(read.in_map);
  PointFile& file = removed ? *dynamic_ : *cleaned_;
  if (!dropped) (removed ? report_.dynamic_points : report_.static_points) += last - first;

  std::size_t unwritten = first;
  for (std::size_t i = first; i < last; ++i) {
    const Eigen::Vector3d position = position_of(i);
    const bool moving = labelled_ && read.moving[i];
    const bool written = !dropped && file.takes(position);
    if (!dropped) top_view_->add(position, removed, moving);
    if (!written) {
      file.append(read.in_map, unwritten, i - unwritten);
      unwritten = i + 1;
    }
    if (!labelled_) continue;
    if (written && !removed) {
      evaluator_.addKept(moving);
    } else {
      evaluator_.addUnmatched(position, moving);
    }
  }
  file.append(read.in_map, unwritten, last - unwritten);
}

void OfflineRun::scoreAgainst(const std::string& cleaned) {
  evaluator_.finishTruth();
  // Each thread shows its share of the file. Their order does not matter.
  const std::uint64_t size = readPcdHeader(cleaned).points;
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
      readPcdBlocks(cleaned, show, kScoredBlock, share);
    }));
  }
  for (auto& share : shares) share.get();
  report_.score = evaluator_.score();
}

void OfflineRun::writePictures() const {
  top_view_->before().writePng(options_.output + "/before.png");
  top_view_->after().writePng(options_.output + "/after.png");
  if (labelled_) top_view_->mistakes().writePng(options_.output + "/mistakes.png");
  drawMatrix(cleaner_.map()).writePng(options_.output + "/matrix.png");
}

void writeText(const std::string& path, const std::string& text) {
  const std::string temporary = path + ".tmp";
  {
    std::ofstream file(temporary);
    file << text;
    if (!file.flush()) throw InputError("cannot write '" + path + "'");
  }
  std::filesystem::rename(temporary, path);
}

}  // namespace

OfflineReport cleanOffline(ScanSource& source, const Config& config, const OfflineOptions& options,
                           const ProgressListener& progress) {
  std::error_code error;
  std::filesystem::create_directories(options.output, error);
  if (error) {
    throw InputError("cannot make the folder '" + options.output + "': " + error.message());
  }
  OfflineReport report = OfflineRun(source, config, options, progress).run();
  writeText(options.output + "/report.json", toJson(report, config));
  return report;
}

}  // namespace beautymap
