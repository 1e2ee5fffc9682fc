// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace beautymap {

struct LevellingConfig {
  bool enabled = true;
  int radius = 100;
  double min_correction = 0.03;

  template <typename Visitor>
  void describe(Visitor& v) {
    v("enabled", enabled, false, true, "",
      "tilt and raise scans whose ground does not lie where the other scans' does, before they are "
      "judged");
    v("radius", radius, 5, 400, "columns", "half size of the square whose ground is looked at");
    v("min_correction", min_correction, 0.0, 1.0, "m",
      "scans that would move by less, root mean square, stay as they are");
  }
};

struct CoarseGroundConfig {
  bool enabled = true;
  int radius = 2;
  double min_share = 0.6;
  double mad_factor = 3.0;
  int wide_radius = 10;
  double wide_quantile = 0.3;

  template <typename Visitor>
  void describe(Visitor& v) {
    v("enabled", enabled, false, true, "",
      "estimate each column's ground; off: every column starts at the map's lowest point, and "
      "fine_ground is off too");
    v("radius", radius, 1, 20, "columns", "half size of the square neighbourhood of a column");
    v("min_share", min_share, 0.0, 1.0, "",
      "share of the neighbouring columns that must hold points for their median to say where the "
      "ground is");
    v("mad_factor", mad_factor, 0.0, 20.0, "",
      "how many median absolute deviations a ground height may lie from the neighbours' median");
    v("wide_radius", wide_radius, 0, 100, "columns",
      "where fewer neighbours hold points: half size of the square whose lowest points a column's "
      "ground lies no higher than; 0: its own lowest point is its ground there");
    v("wide_quantile", wide_quantile, 0.0, 1.0, "",
      "the share of these lowest points that lie below that height");
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
  double bin_height = 0.025;
  double search_height = 0.4;
  double max_thickness = 0.15;
  double tail_share = 0.1;
  double min_low_peak = 0.25;
  double min_contrast = 4.0;
  bool floors = true;

  template <typename Visitor>
  void describe(Visitor& v) {
    v("enabled", enabled, false, true, "",
      "keep a column's ground surface, found as the peak of its points' heights (only with "
      "evidence); off: fine_ground divides the ground cell");
    v("bin_height", bin_height, 0.01, 0.5, "m", "height of a bin of the histogram");
    v("search_height", search_height, 0.05, 2.0, "m",
      "the peak lies at most that far above the coarse ground");
    v("max_thickness", max_thickness, 0.01, 1.0, "m", "the layer ends at most that far above it");
    v("tail_share", tail_share, 0.0, 1.0, "",
      "the layer ends where a bin has less than this share of the peak's points");
    v("min_low_peak", min_low_peak, 0.0, 1.0, "",
      "below a moving object a peak in the ground cell is the ground if it has this share of the "
      "highest");
    v("min_contrast", min_contrast, 0.0, 100.0, "",
      "a ground cell that was itself seen free or seldom hit, below a moving object, is "
      "ground only if it holds this many times the points of the cell above; where it was "
      "seldom hit, that many times the object's hits will do, too");
    v("floors", floors, false, true, "",
      "split the cell of a surface above the ground, on which something moved (a deck, a step, a "
      "storey), in the same way");
  }
};

}  // namespace beautymap
