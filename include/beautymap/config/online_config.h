// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace beautymap {

/// Of a map that is cleaned while it grows (the node); a replay does not use it.
struct OnlineConfig {
  double map_voxel = 0.1;
  double radius = 0.0;
  double free_height = 12.0;
  double ground_drift = 0.1;
  double live_share = 0.16;
  int live_unknown_hits = 5;
  int live_rounds = 16;

  template <typename Visitor>
  void describe(Visitor& v) {
    v("map_voxel", map_voxel, 0.0, 10.0, "m",
      "the map keeps the first point in each cube of this side; 0: every point");
    v("radius", radius, 0.0, 100000.0, "m",
      "tiles farther from the sensor are written to disk until it comes back; 0: all stay in "
      "memory");
    v("free_height", free_height, 0.0, 100.0, "m",
      "up to that height above ground it is remembered which empty cells were seen free");
    v("ground_drift", ground_drift, 0.0, 1.0, "m",
      "a column's cells move when its ground does by more than that");
    v("live_share", live_share, 0.0, 1.0, "",
      "in the split of a scan, share of the occupied cells around that must be dynamic for an "
      "unknown cell to be, too; half as much again where the cell leans to dynamic");
    v("live_unknown_hits", live_unknown_hits, 0, 1023, "scans",
      "in the split of a scan, a cell that was never seen free is unknown when no more scans hit "
      "it");
    v("live_rounds", live_rounds, 0, 100, "columns",
      "how far an object grows so in the split of a scan");
  }
};

}  // namespace beautymap
