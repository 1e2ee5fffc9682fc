// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

namespace beautymap {

struct ScanConfig {
  double min_range = 0.0;
  double max_range = 200.0;

  template <typename Visitor>
  void describe(Visitor& v) {
    v("min_range", min_range, 0.0, 100.0, "m", "points nearer to the sensor are dropped",
      "the robot or its mast is in the map: higher");
    v("max_range", max_range, 1.0, 1000.0, "m", "points farther from the sensor are dropped",
      "far noise, fog or rain in the map: lower");
  }
};

struct MatrixConfig {
  double res_g = 0.5;
  double room_res_g = 0.15;
  double res_h = 0.2;
  int n_bit = 64;
  int bits_below = 8;
  double roi_size = 160.0;

  /// Horizontal size of a cell in a room [m].
  double resInRoom() const { return room_res_g > 0.0 ? std::min(room_res_g, res_g) : res_g; }

  // Not parameters: what a room is needs no tuning.
  double room_range =
      12.0;  ///< [m] a room is where nine of ten points of the first scan are no farther

  template <typename Visitor>
  void describe(Visitor& v) {
    v("res_g", res_g, 0.05, 10.0, "m", "horizontal size of a cell",
      "what stands beside moving things goes with them: smaller; sparse scans leave moving points: "
      "larger");
    v("room_res_g", room_res_g, 0.0, 10.0, "m",
      "the same in a room, if that is smaller; 0: no difference");
    v("res_h", res_h, 0.02, 5.0, "m", "height of one bit of a column");
    v("n_bit", n_bit, 2, 64, "bits",
      "bits of a column; whatever is higher than n_bit * res_h above ground counts as the top bit");
    v("bits_below", bits_below, 0, 32, "bits",
      "bits of a column that lie below its coarse ground, so that a lower level is judged, too");
    v("roi_size", roi_size, 1.0, 400.0, "m",
      "side of the square around the sensor in which a scan is compared with the map");
  }
};

}  // namespace beautymap
