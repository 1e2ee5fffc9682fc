// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace beautymap {

struct LevellingConfig {
  bool enabled = true;

  // Not parameters: wide enough for any sensor, and what noise of the ground is.
  int radius = 100;  ///< [columns] half size of the square whose ground is looked at
  double min_correction =
      0.03;  ///< [m] scans that would move by less, root mean square, stay as they are

  template <typename Visitor>
  void describe(Visitor& v) {
    v("enabled", enabled, false, true, "",
      "tilt and raise scans whose ground does not lie where the other scans' does, before they are "
      "judged");
  }
};

struct CoarseGroundConfig {
  bool enabled = true;
  int radius = 2;
  double mad_factor = 3.0;
  int wide_radius = 10;

  // Not parameters: wide enough for any sensor, and what noise of the ground is.
  double min_share =
      0.6;  ///< of the neighbouring columns must hold points for their median to count
  double wide_quantile = 0.3;  ///< of the lowest points in wide_radius lie below the ground's limit

  template <typename Visitor>
  void describe(Visitor& v) {
    v("enabled", enabled, false, true, "",
      "estimate each column's ground; off: every column starts at the map's lowest point, and "
      "fine_ground is off too");
    v("radius", radius, 1, 20, "columns", "half size of the square neighbourhood of a column");
    v("mad_factor", mad_factor, 0.0, 20.0, "",
      "how many median absolute deviations a ground height may lie from the neighbours' median");
    v("wide_radius", wide_radius, 0, 100, "columns",
      "where fewer neighbours hold points: half size of the square whose lowest points a column's "
      "ground lies no higher than; 0: its own lowest point is its ground there");
  }
};

struct FineGroundConfig {
  bool enabled = true;
  double bin_height = 0.1;
  double ground_ratio = 0.85;

  template <typename Visitor>
  void describe(Visitor& v) {
    v("enabled", enabled, false, true, "",
      "split a ground cell below a dynamic one into ground and object points");
    v("bin_height", bin_height, 0.01, 1.0, "m", "height of a fine bin within the ground cell");
    v("ground_ratio", ground_ratio, 0.01, 1.0, "",
      "from below, bins above this accumulated share of the cell's points are dynamic");
  }
};

struct GroundLayerConfig {
  bool enabled = true;
  double max_thickness = 0.15;

  // Not parameters: the histogram and what is a peak in it. Drives and streets do not feel them,
  // people on steps do.
  double bin_height = 0.025;   ///< [m] of the histogram
  double search_height = 0.4;  ///< [m] the peak lies at most that far above the coarse ground
  double tail_share = 0.1;     ///< the layer ends where a bin has less than this share of the peak
  double min_low_peak =
      0.25;  ///< a peak in the ground cell with this share of the highest is the ground
  double min_contrast =
      4.0;  ///< what was seen free is ground only with that many times the points of the cell above
  bool floors =
      true;  ///< split the cell of a surface above the ground on which something moved, too

  template <typename Visitor>
  void describe(Visitor& v) {
    v("enabled", enabled, false, true, "",
      "keep a column's ground surface, found as the peak of its points' heights (only with "
      "evidence); off: fine_ground divides the ground cell");
    v("max_thickness", max_thickness, 0.01, 1.0, "m", "the layer ends at most that far above it");
  }
};

}  // namespace beautymap
