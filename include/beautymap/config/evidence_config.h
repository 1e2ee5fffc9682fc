// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace beautymap {

struct VisibilityConfig {
  double max_range = 80.0;
  double blind_radius = 0.5;
  double pixel_deg = 0.2;
  int min_beams = 2;
  double min_share = 0.8;
  double margin = 0.05;
  double pose_position = 0.0;
  double pose_rotation = 0.0;

  template <typename Visitor>
  void describe(Visitor& v) {
    v("max_range", max_range, 1.0, 200.0, "m", "columns farther from the sensor are not judged");
    v("blind_radius", blind_radius, 0.0, 20.0, "m", "columns nearer to the sensor are not judged");
    v("pixel_deg", pixel_deg, 0.05, 2.0, "deg", "resolution of the beam image");
    v("min_beams", min_beams, 1, 100, "beams",
      "beams that must have passed through a cell's angular footprint for it to be seen free");
    v("min_share", min_share, 0.5, 1.0, "",
      "share of the beams in the footprint that must have passed");
    v("margin", margin, 0.0, 5.0, "m", "a beam passed when it ended that far behind the cell");
    v("pose_position", pose_position, 0.0, 2.0, "m",
      "standard deviation of a scan's position, if known: cells are seen free only with that "
      "margin around them");
    v("pose_rotation", pose_rotation, 0.0, 10.0, "deg",
      "standard deviation of a scan's rotation, if known: the same, growing with the range");
  }
};

struct EvidenceConfig {
  int min_free = 2;
  double free_ratio = 1.0;
  int min_free_in_order = 5;
  double order_ratio = 0.1;
  double strong_ratio = 1.0;
  double leaning_ratio = 0.03;
  int unknown_hits = 12;
  int few_beams_hits = 2;
  int flicker_gaps = 2;
  int flicker_hits = 3;
  double flicker_order = 4.0;
  int doubt_gaps = 3;

  template <typename Visitor>
  void describe(Visitor& v) {
    v("min_free", min_free, 1, 255, "scans", "a dynamic cell was seen free in at least as many");
    v("free_ratio", free_ratio, 0.0, 100.0, "", "and in more than this times its hits");
    v("min_free_in_order", min_free_in_order, 1, 255, "scans",
      "or it was seen free in as many before its first or after its last hit");
    v("order_ratio", order_ratio, 0.0, 100.0, "", "and there in more than this times its hits");
    v("strong_ratio", strong_ratio, 0.0, 100.0, "",
      "evidence is strong when a cell was seen free before its first and after its last hit in "
      "more than this times its hits");
    v("leaning_ratio", leaning_ratio, 0.0, 100.0, "",
      "a cell leans to dynamic when it was seen free there at least once and in this times its "
      "hits");
    v("unknown_hits", unknown_hits, 0, 1023, "scans",
      "a cell that was never seen free is unknown when no more scans hit it");
    v("few_beams_hits", few_beams_hits, 0, 1023, "scans",
      "where no more scans hit a cell, those count half in which too few beams passed it to be "
      "seen free");
    v("flicker_gaps", flicker_gaps, 0, 1023, "gaps",
      "a cell flickers, as edges do, when it was seen free between its hits in at least as many "
      "gaps; 0: never");
    v("flicker_hits", flicker_hits, 0, 1023, "scans",
      "and was hit in no more than that, on average, between two gaps");
    v("flicker_order", flicker_order, 0.0, 1000.0, "",
      "and was not seen free before its first or after its last hit in more than this times its "
      "hits");
    v("doubt_gaps", doubt_gaps, 0, 1023, "gaps",
      "a cell that flickers with at least as many is dynamic only if its neighbours say so");
  }
};

struct AgreementConfig {
  bool enabled = true;
  double min_share = 0.6;
  double min_share_strong = 0.2;
  double join_share = 0.4;
  double unknown_share = 0.4;
  int join_rounds = 8;
  bool across_gaps = true;
  double flicker_share = 0.3;
  int surface_bits = 2;
  int overhead_bits = 10;
  int floor_neighbours = 7;

  template <typename Visitor>
  void describe(Visitor& v) {
    v("enabled", enabled, false, true, "",
      "let neighbouring cells decide what belongs to a moving object");
    v("min_share", min_share, 0.0, 1.0, "",
      "share of its occupied neighbours that must be dynamic for a cell to be, too");
    v("min_share_strong", min_share_strong, 0.0, 1.0, "", "the same where the evidence is strong");
    v("join_share", join_share, 0.0, 1.0, "", "the same where a cell only leans to dynamic");
    v("unknown_share", unknown_share, 0.0, 1.0, "", "the same where a cell is unknown");
    v("join_rounds", join_rounds, 0, 30, "columns",
      "how far an object grows over leaning and unknown cells");
    v("across_gaps", across_gaps, false, true, "",
      "let objects grow over gaps of one cell, too, where nothing around stays");
    v("flicker_share", flicker_share, 0.0, 1.0, "",
      "where more than this share of the dynamic cells around flickers, a cell needs join_share "
      "of its neighbours to be dynamic by their own evidence; 1: nowhere");
    v("surface_bits", surface_bits, 0, 16, "bits",
      "that many dynamic cells upon one that stays, with none above them, are its noise");
    v("overhead_bits", overhead_bits, 0, 64, "bits",
      "that high above ground such a layer is noise also where it hangs free, with no other "
      "dynamic cells below and above it: a ceiling, a roof");
    v("floor_neighbours", floor_neighbours, 1, 9, "columns",
      "a cell that stays is part of a floor, which says nothing about what stands on it, where "
      "that many of the columns around have a surface as high; 9: never");
  }
};

}  // namespace beautymap
