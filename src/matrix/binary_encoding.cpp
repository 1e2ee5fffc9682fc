// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/matrix/binary_encoding.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace beautymap {

namespace {

ColumnWindow windowAround(ColumnIndex column, int reach) {
  return {{column.x - reach, column.y - reach}, 2 * reach + 1};
}

int regionReach(const MatrixConfig& config) {
  return std::max(1, static_cast<int>(0.5 * config.roi_size / config.res_g));
}

}  // namespace

float depthBelowGround(const MatrixConfig& config) {
  // The lowest points are what the ground's height comes from: not even rounding may move them to
  // the cell below.
  constexpr double kRounding = 1e-3;  // [m]
  const double depth = config.bits_below * config.res_h;
  return static_cast<float>(config.bits_below == 0 ? depth : depth + kRounding);
}

ColumnWindow regionOfInterest(const PlacedScan& scan, const MatrixConfig& config) {
  return windowAround(scan.anchor, regionReach(config));
}

ColumnWindow seenRegion(const PlacedScan& scan, const MatrixConfig& config) {
  int reach = 1;
  for (const ColumnRun& run : scan.runs) {
    reach = std::max({reach, std::abs(run.x), std::abs(run.y)});
  }
  return windowAround(scan.anchor, std::min(reach, regionReach(config)));
}

BitGrid encodeScan(const PlacedScan& scan, const HeightGrid& map_ground, const MatrixConfig& config,
                   BitGrid recycled) {
  const ColumnWindow& window = map_ground.window();
  const BinaryEncoding encoding(config);
  const int dx = scan.anchor.x - window.corner.x;
  const int dy = scan.anchor.y - window.corner.y;
  BitGrid grid = std::move(recycled);
  grid.reset(window, 0);
  for (const ColumnRun& run : scan.runs) {
    const int x = run.x + dx, y = run.y + dy;
    if (grid.inside(x, y)) grid.at(x, y) |= encoding.bits(scan, run, map_ground.at(x, y));
  }
  return grid;
}

}  // namespace beautymap
