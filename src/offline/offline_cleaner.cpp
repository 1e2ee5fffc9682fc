// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/offline/offline_cleaner.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <filesystem>
#include <optional>
#include <utility>

#include "beautymap/cleaner/map_cleaner.h"
#include "beautymap/io/cloud_fields.h"
#include "beautymap/io/new_file.h"
#include "beautymap/io/placed_spool.h"
#include "beautymap/io/scan_conversion.h"
#include "beautymap/io/scan_spool.h"
#include "beautymap/matrix/cell_size.h"
#include "beautymap/matrix/up_direction.h"
#include "map_writer.h"
#include "scan_pipeline.h"

namespace beautymap {
namespace {

/// A scan as the source gave it, as the core takes it, and what it says.
struct ReadScan {
  SourceScan source;
  Scan scan;
  ScanView view;
  std::string unusable;                      ///< why, or empty
  std::int64_t place = 0, placed_place = 0;  ///< in the temporary files
  ScanOutput output;
};

/// The first scans, and what they say about the place.
/// @param config  gets the cells' size
std::deque<SourceScan> readAhead(ScanSource& source, Config& config, UpDirection& up) {
  const std::size_t most = std::min<std::size_t>(10, source.size());
  std::deque<SourceScan> scans;
  std::optional<double> size;
  UpFinder finder;
  SourceScan read;
  while (scans.size() < most && source.next(read)) {
    scans.push_back(read);
    Scan scan;
    convertScan(read, scan);
    if (!size) size = cellSizeFor(scan, config);
    finder.add(scan, read.T_map_sensor.linear().col(2));
  }
  config.matrix.res_g = size.value_or(config.matrix.res_g);
  up = finder.find(config);
  return scans;
}

/// What of the placed scans any pass needs.
PlacedSpool::Part partOf(const std::vector<JudgementPass>& passes) {
  const bool all = std::any_of(passes.begin(), passes.end(),
                               [](const JudgementPass& pass) { return pass.needs_xy; });
  return all ? PlacedSpool::Part::kAll : PlacedSpool::Part::kHeights;
}

/// Heights count from the first sensor, or from the one of median height where the first is far
/// from it: a first pose that makes no sense would take the millimetres from all points.
Eigen::Vector3d originOf(const std::deque<SourceScan>& scans, const UpDirection& up) {
  constexpr double kFar = 1000.0;  // [m]
  const Eigen::Isometry3d T_level_map = up.levelFromMap();
  std::vector<double> heights;
  for (const SourceScan& scan : scans) {
    heights.push_back((T_level_map * scan.T_map_sensor.translation()).z());
  }
  Eigen::Vector3d origin = T_level_map * scans.front().T_map_sensor.translation();
  const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
  std::nth_element(heights.begin(), middle, heights.end());
  if (std::abs(origin.z() - *middle) > kFar) origin.z() = *middle;
  return origin;
}

/// The passes over the scans, in their order.
class OfflineRun {
 public:
  OfflineRun(ScanSource& source, Config config, const OfflineOptions& options,
             const ProgressListener& progress)
      : source_(source),
        options_(options),
        progress_(progress),
        read_ahead_(readAhead(source, config, report_.up)),
        cleaner_(config),
        spool_(options.output),
        placed_(options.output, partOf(cleaner_.passes())) {}

  OfflineReport run() {
    const auto start = std::chrono::steady_clock::now();
    observe();
    cleaner_.estimateGround();
    for (const JudgementPass& p : cleaner_.passes()) {
      pass(
          p.name,
          [&](ReadScan& s) { return nextPlaced(s.view, p.needs_xy ? Part::kAll : Part::kHeights); },
          [&](ReadScan& s) { cleaner_.look(p, s.view); },
          [&](const ReadScan& s) {
            if (!levelled_) levellings_.push_back(*s.view.levelling);
            cleaner_.add(p, s.view);
          });
      cleaner_.conclude(p);
      levelled_ = true;
    }
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
  /// The next scan of a pass as it was placed, and levelled as in the first pass.
  bool nextPlaced(ScanView& view, Part part);
  void observe();
  template <typename Read, typename Work, typename Use>
  void pass(const std::string& name, Read read, Work work, Use use);
  void write();

  ScanSource& source_;
  const OfflineOptions& options_;
  const ProgressListener& progress_;
  OfflineReport report_;
  std::deque<SourceScan> read_ahead_;  ///< the first scans, until observe() takes them
  MapCleaner cleaner_;
  ScanSpool spool_;                    ///< the scans as they came, for writing
  PlacedSpool placed_;                 ///< the same scans in the map, for the passes between
  std::vector<Levelling> levellings_;  ///< of the scans, from the first pass
  bool levelled_ = false;              ///< it is over
  std::size_t next_levelling_ = 0;     ///< of the pass at hand
  bool labelled_ = true;               ///< until a scan without labels comes
};

bool OfflineRun::nextScan(SourceScan& scan) {
  if (read_ahead_.empty()) return source_.next(scan);
  scan = std::move(read_ahead_.front());
  read_ahead_.pop_front();
  return true;
}

bool OfflineRun::nextPlaced(ScanView& view, Part part) {
  if (!placed_.next(view.placed, part)) return false;
  view.levelling.reset();
  if (!levelled_) return true;
  view.levelling = levellings_[next_levelling_++];
  applyLevelling(*view.levelling, view.placed);
  return true;
}

void OfflineRun::observe() {
  progress_.begin("reading", source_.size());
  if (!read_ahead_.empty()) cleaner_.startAt(originOf(read_ahead_, report_.up));
  const auto skip = [&](const std::string& reason, const std::string& example) {
    Skipped& skipped = report_.skipped_scans[reason];
    if (skipped.count++ == 0) skipped.example = example;
  };
  runPipeline<ReadScan>(
      [&](ReadScan& read) {
        if (!nextScan(read.source)) return false;
        cleaner_.startAt(report_.up.levelFromMap() * read.source.T_map_sensor.translation());
        return true;
      },
      [&](ReadScan& read) {
        convertScan(read.source, read.scan);
        report_.up.level(read.scan);
        try {
          read.unusable.clear();
          cleaner_.place(read.scan, read.view);
        } catch (const std::invalid_argument& e) {
          read.unusable = e.what();
          return;
        }
        StageClock clock(read.view.times);
        read.place = spool_.write(read.source);
        read.placed_place = placed_.write(read.view.placed);
        clock.lap("spool");
      },
      [&](ReadScan& read) {
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
        spool_.add(read.source, read.place);
        placed_.add(read.placed_place);
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
  next_levelling_ = 0;
  runPipeline<ReadScan>(read, work, [&](ReadScan& scan) {
    use(scan);
    progress_.step();
  });
}

void OfflineRun::write() {
  report_.cell_size_m = cleaner_.config().matrix.res_g;
  report_.tiles = cleaner_.map().tileCount();
  report_.matrix_memory_mb = static_cast<double>(cleaner_.map().memoryBytes()) / 1048576.0;
  MapWriter writer(cleaner_, source_, labelled_, options_, report_);
  spool_.rewind();
  pass(
      "writing",
      [&](ReadScan& read) {
        return nextPlaced(read.view, Part::kHeights) && spool_.next(read.source);
      },
      [&](ReadScan& read) { writer.prepare(read.view, read.source, read.output); },
      [&](ReadScan& read) {
        cleaner_.addTimes(read.view);
        writer.write(read.output);
      });
  writer.finish();
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
  const std::string json = toJson(report, config);
  NewFile file(options.output + "/report.json");
  file.write(json.data(), json.size());
  file.commit();
  return report;
}

}  // namespace beautymap
