// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace beautymap {

/// Of a map that is cleaned while it grows (the node); a replay does not use it.
struct OnlineConfig {
  double map_voxel = 0.1;
  double radius = 0.0;
  double free_height = 12.0;

  // Not parameters: how the split of a scan differs from the finished map, which waits for
  // evidence.
  double ground_drift = 0.1;  ///< [m] a column's cells move when its ground does by more than that
  double live_share = 0.16;   ///< join_share of unknown cells; leaning ones need half as much again
  int live_unknown_hits = 5;  ///< [scans] unknown_hits
  int live_rounds = 16;       ///< [columns] join_rounds

  template <typename Visitor>
  void describe(Visitor& v) {
    v("map_voxel", map_voxel, 0.0, 10.0, "m",
      "the map keeps the first point in each cube of this side; 0: every point",
      "memory or the published map grows too large: larger");
    v("radius", radius, 0.0, 100000.0, "m",
      "tiles farther from the sensor are written to disk until it comes back; 0: all stay in "
      "memory",
      "memory grows on a long drive: twice the sensor's range");
    v("free_height", free_height, 0.0, 100.0, "m",
      "up to that height above ground it is remembered which empty cells were seen free");
  }
};

}  // namespace beautymap
