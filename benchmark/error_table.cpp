// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause

// beautymap_error_table INPUT [moving_labels=1,2] [group.parameter=value...]: where a replay of a
// labelled input is wrong, by height above the ground and by range, as the tables of
// docs/accuracy.md. Each point counts with the class it got: no neighbour within 0.05 m saves it.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "beautymap/cleaner/map_cleaner.h"
#include "beautymap/evaluation/evaluation.h"
#include "labelled_scans.h"

namespace beautymap {
namespace {

constexpr double kRangeStep = 10.0;  // [m]
constexpr std::size_t kRanges = 12;
constexpr std::size_t kHeights = 16;  ///< below the ground, cells above it, all that is higher

/// The scores of the points in each of some intervals.
class Table {
 public:
  explicit Table(std::size_t rows) : rows_(rows) {}

  void add(double row, bool moving, bool kept) {
    const double last = static_cast<double>(rows_.size() - 1);
    Score& score = rows_[static_cast<std::size_t>(std::clamp(row, 0.0, last))];
    ++(moving ? score.dynamic_points : score.static_points);
    if (kept) ++(moving ? score.kept_dynamic : score.kept_static);
  }

  template <typename NameOf>
  void print(const char* quantity, NameOf name_of) const {
    std::printf("| %s | static points | removed | | dynamic points | kept | |\n", quantity);
    std::printf("| --- | --- | --- | --- | --- | --- | --- |\n");
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const Score& score = rows_[i];
      if (score.static_points + score.dynamic_points == 0) continue;
      std::printf("| %s |", name_of(i).c_str());
      printErrors(score.static_points, score.static_points - score.kept_static);
      printErrors(score.dynamic_points, score.kept_dynamic);
      std::printf("\n");
    }
    std::printf("\n");
  }

 private:
  static void printErrors(std::uint64_t points, std::uint64_t wrong) {
    std::printf(" %llu | %llu |", static_cast<unsigned long long>(points),
                static_cast<unsigned long long>(wrong));
    if (points == 0) {
      std::printf(" |");
    } else {
      std::printf(" %.2f %% |", 100.0 * static_cast<double>(wrong) / static_cast<double>(points));
    }
  }

  std::vector<Score> rows_;
};

std::string metres(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.1f", value);
  return text;
}

std::string interval(double low, double high, bool last) {
  return last ? metres(low) + " m and more" : metres(low) + " to " + metres(high) + " m";
}

void run(const std::vector<LabelledScan>& scans, const Config& given) {
  const Config config = withCellSize(scans, given);
  MapCleaner cleaner(config);
  judge(scans, cleaner);

  const MatrixConfig& matrix = config.matrix;
  Table heights(kHeights), ranges(kRanges);
  for (const LabelledScan& labelled : scans) {
    const Scan& scan = labelled.scan;
    const std::vector<PointClass> classes = cleaner.classify(scan);
    for (std::size_t i = 0; i < classes.size(); ++i) {
      const PointLabel label = labelled.labels[i];
      if (classes[i] == PointClass::kDropped || label == PointLabel::kIgnored) continue;
      const bool moving = label == PointLabel::kMoving;
      const pcl::PointXYZ& point = scan.cloud[i];
      const Eigen::Vector3d in_map = scan.T_map_cloud * Eigen::Vector3d(point.x, point.y, point.z);
      const ColumnIndex column = columnOf(in_map, matrix.res_g);
      const Tile& tile = *cleaner.map().findTile(TileMap::tileOf(column));
      const double bottom = tile.ground[static_cast<std::size_t>(TileMap::indexInTile(column))];
      const double bit = std::floor((in_map.z() - cleaner.zOrigin() - bottom) / matrix.res_h);
      const bool kept = classes[i] == PointClass::kStatic;
      heights.add(bit - matrix.bits_below + 1.0, moving, kept);
      ranges.add((in_map - scan.sensor_in_map).norm() / kRangeStep, moving, kept);
    }
  }
  heights.print("height", [&](std::size_t row) {
    const double low = (static_cast<double>(row) - 1.0) * matrix.res_h;
    return row == 0 ? "below the ground" : interval(low, low + matrix.res_h, row + 1 == kHeights);
  });
  ranges.print("range", [](std::size_t row) {
    const double low = static_cast<double>(row) * kRangeStep;
    return interval(low, low + kRangeStep, row + 1 == kRanges);
  });
}

}  // namespace
}  // namespace beautymap

int main(int argc, char** argv) {
  return beautymap::runOnLabelledScans("beautymap_error_table", argc, argv, beautymap::run);
}
