// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/binary_encoding.h"

namespace beautymap {

ColumnWindow regionOfInterest(const PlacedScan& scan, const MatrixConfig& config) {
  const int half = std::max(1, static_cast<int>(0.5 * config.roi_size / config.res_g));
  return {{scan.anchor.x - half, scan.anchor.y - half}, 2 * half + 1};
}

BitGrid encodeScan(const PlacedScan& scan, const HeightGrid& map_ground,
                   const MatrixConfig& config) {
  const ColumnWindow& window = map_ground.window();
  const BinaryEncoding encoding(config);
  const int dx = scan.anchor.x - window.corner.x;
  const int dy = scan.anchor.y - window.corner.y;
  BitGrid grid(window, 0);
  forEachColumnPoint(scan, config.res_g, [&](int x, int y, float z) {
    if (!grid.inside(x + dx, y + dy)) return;
    grid.at(x + dx, y + dy) |= encoding.bit(z, map_ground.at(x + dx, y + dy));
  });
  return grid;
}

}  // namespace beautymap
