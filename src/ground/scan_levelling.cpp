// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/ground/scan_levelling.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace beautymap {
namespace {

// What poses are usually wrong by: without ground to tell, a scan stays as it is.
constexpr double kUsualHeight = 0.1;     // [m]
constexpr double kUsualSlope = 0.00524;  // [m/m]: 0.3 degrees
// Neighbouring columns are wrong alike, so that each says less than its own noise would allow.
constexpr double kColumnDeviation = 0.22;  // [m]
// Columns that differ by more than this count less and less: wide at first, as far poses are wrong.
constexpr float kFirstWidth = 0.4F, kLastWidth = 0.1F;  // [m]
constexpr int kRounds = 8;
// No pose should be so wrong near the sensor; farther columns that are lost so are not missed.
constexpr float kStorey = 0.4F;                     // [m]
constexpr std::size_t kFewest = 100, kMost = 1500;  // columns
// The mean of fewer, of which this scan is one, says little where beams are sparse.
constexpr int kFewestScans = 5;
// A pose that was wrong leaves a fraction of the differences (0.2 to 0.45); what is fitted to
// sparse beams on rough ground leaves most of them.
constexpr float kMostLeft = 0.7F;

/// Columns and how far the map's level lies above the scan's lowest point there.
struct Differences {
  Eigen::MatrixX3f plane;  ///< 1, x, y of each column
  Eigen::ArrayXf height;   ///< [m]
};

Differences differencesTo(const TileMap& map, ColumnIndex anchor,
                          const std::vector<ColumnLow>& lows) {
  std::vector<Eigen::Vector3f> known;
  TileCursor<const TileMap> tile_of(map);
  for (const ColumnLow& low : lows) {
    const ColumnIndex column{anchor.x + low.x, anchor.y + low.y};
    const Tile* tile = tile_of(column);
    if (tile == nullptr) continue;
    const auto i = static_cast<std::size_t>(TileMap::indexInTile(column));
    if (tile->level_scans[i] < kFewestScans) continue;
    known.emplace_back(low.x, low.y, tile->level[i] - low.z);
  }
  const std::size_t step = 1 + known.size() / kMost;
  const auto size = static_cast<Eigen::Index>((known.size() + step - 1) / step);
  Differences differences{Eigen::MatrixX3f::Ones(size, 3), Eigen::ArrayXf(size)};
  for (Eigen::Index i = 0; i < size; ++i) {
    const Eigen::Vector3f& column = known[static_cast<std::size_t>(i) * step];
    differences.plane.row(i).tail<2>() = column.head<2>().transpose();
    differences.height[i] = column.z();
  }
  return differences;
}

float medianSize(const Eigen::ArrayXf& values) {
  Eigen::ArrayXf sizes = values.abs();
  float* const middle = sizes.data() + sizes.size() / 2;
  std::nth_element(sizes.data(), middle, sizes.data() + sizes.size());
  return *middle;
}

}  // namespace

std::vector<ColumnLow> lowestOfColumns(const PlacedScan& scan, int radius) {
  HeightGrid grid({{-radius, -radius}, 2 * radius + 1}, Tile::kNoHeight);
  for (const ColumnRun& run : scan.runs) {
    if (!grid.inside(run.x + radius, run.y + radius)) continue;
    float& lowest = grid.at(run.x + radius, run.y + radius);
    lowest = std::min(lowest, run.lowest);
  }
  std::vector<ColumnLow> lows;
  for (int x = 0; x < grid.size(); ++x) {
    for (int y = 0; y < grid.size(); ++y) {
      const float z = grid.at(x, y);
      if (z != Tile::kNoHeight) lows.push_back({x - radius, y - radius, z});
    }
  }
  return lows;
}

void addLevels(TileMap& map, ColumnIndex anchor, const std::vector<ColumnLow>& lows) {
  TileCursor<TileMap> tile_of(map);
  for (const ColumnLow& low : lows) {
    const ColumnIndex column{anchor.x + low.x, anchor.y + low.y};
    Tile& tile = *tile_of(column);
    const auto i = static_cast<std::size_t>(TileMap::indexInTile(column));
    std::uint8_t& scans = tile.level_scans[i];
    // Of several storeys the lowest one counts: a mean of two would be neither.
    const bool is_other_storey = scans > 0 && std::abs(low.z - tile.level[i]) > kStorey;
    if (is_other_storey && low.z > tile.level[i]) continue;
    if (is_other_storey) scans = 0;
    if (scans < 255) ++scans;  // from then on a sliding mean
    tile.level[i] += (low.z - tile.level[i]) / static_cast<float>(scans);
  }
}

Levelling findLevelling(const TileMap& map, ColumnIndex anchor, const std::vector<ColumnLow>& lows,
                        double res_g, const LevellingConfig& config) {
  const Differences seen = differencesTo(map, anchor, lows);
  if (seen.height.size() < static_cast<Eigen::Index>(kFewest)) return {};
  const auto square = [](double value) { return value * value; };
  const double slope = kUsualSlope * res_g;
  const Eigen::Vector3d usual(1.0 / square(kUsualHeight), 1.0 / square(slope), 1.0 / square(slope));
  Eigen::Vector3d plane = Eigen::Vector3d::Zero();
  float width = kFirstWidth;
  // Weighted least squares, with the weights of Geman and McClure.
  for (int round = 0; round < kRounds; ++round, width = std::max(kLastWidth, 0.6F * width)) {
    const Eigen::ArrayXf off =
        (seen.height - (seen.plane * plane.cast<float>()).array()) * (1.0F / width);
    const Eigen::ArrayXf weights = (1.0F + off.square()).square().inverse() *
                                   static_cast<float>(1.0 / square(kColumnDeviation));
    const Eigen::MatrixX3f weighted = seen.plane.array().colwise() * weights;
    Eigen::Matrix3d normal = (weighted.transpose() * seen.plane).cast<double>();
    normal.diagonal() += usual;
    plane = normal.ldlt().solve((weighted.transpose() * seen.height.matrix()).cast<double>());
  }
  const Eigen::Vector3f found = plane.cast<float>();
  const Eigen::ArrayXf moved = (seen.plane * found).array();
  const bool is_small = !(moved.matrix().norm() >=
                          config.min_correction * std::sqrt(static_cast<double>(moved.size())));
  if (is_small || !(medianSize(seen.height - moved) < kMostLeft * medianSize(seen.height))) {
    return {};
  }
  return {found[0], found[1], found[2]};
}

void applyLevelling(const Levelling& levelling, PlacedScan& scan) {
  if (levelling.isNone()) return;
  scan.sensor.z() += levelling.height;
  for (ColumnRun& run : scan.runs) {
    const float height = levelling.at(run.x, run.y);
    run.lowest += height;
    run.highest += height;
    for (std::uint32_t i = run.begin; i < run.end; ++i) scan.z[i] += height;
  }
}

}  // namespace beautymap
