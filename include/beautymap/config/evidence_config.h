// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace beautymap {

struct VisibilityConfig {
  double max_range = 80.0;
  double pixel_deg = 0.2;
  int min_beams = 2;
  double min_share = 0.85;
  double pose_position = 0.0;
  double pose_rotation = 0.0;

  // Not parameters: what a footprint and a point of the beam image cannot tell.
  double blind_radius = 0.5;  ///< [m] cells nearer to the sensor are not judged
  double margin = 0.05;       ///< [m] a beam passed when it ended that far behind the cell

  template <typename Visitor>
  void describe(Visitor& v) {
    v("max_range", max_range, 1.0, 200.0, "m", "columns farther from the sensor are not judged",
      "too slow, or poses whose rotation is so bad that far walls go: lower");
    v("pixel_deg", pixel_deg, 0.05, 2.0, "deg", "resolution of the beam image");
    v("min_beams", min_beams, 1, 100, "beams",
      "beams that must have passed through a cell's angular footprint for it to be seen free");
    v("min_share", min_share, 0.5, 1.0, "",
      "share of the beams in the footprint that must have passed");
    v("pose_position", pose_position, 0.0, 2.0, "m",
      "standard deviation of a scan's position, if known: cells are seen free only with that "
      "margin around them",
      "walls and poles get thinner or have holes: the position's error, say 0.05");
    v("pose_rotation", pose_rotation, 0.0, 10.0, "deg",
      "standard deviation of a scan's rotation, if known: the same, growing with the range");
  }
};

struct EvidenceConfig {
  int min_free = 2;
  double free_ratio = 0.5;
  double order_ratio = 0.1;
  int unknown_hits = 12;

  // Not parameters: how an edge of what stays differs from what moves, and how little is enough
  // where neighbours agree.
  /// Evidence is strong where a cell was seen free before its first and after its last hit in more
  /// than this times its hits,
  double strong_ratio = 1.0;
  /// and leans to dynamic where it was at least once and in this times its hits.
  double leaning_ratio = 0.03;
  /// [scans] Where no more hit a cell, those count half in which too few beams passed it.
  int few_beams_hits = 2;
  /// [gaps] A cell flickers when it was seen free between its hits in at least as many (0: never),
  int flicker_gaps = 2;
  /// [scans] was hit in no more than that, on average, between two gaps,
  int flicker_hits = 3;
  /// and was not seen free before or after its hits in more than this times them.
  double flicker_order = 4.0;
  /// [gaps] With at least as many it is dynamic only if its neighbours say so.
  int doubt_gaps = 3;

  template <typename Visitor>
  void describe(Visitor& v) {
    v("free_ratio", free_ratio, 0.0, 100.0, "",
      "a dynamic cell was seen free in more than this times its hits",
      "moving points stay: lower; static points go: higher");
    v("min_free", min_free, 1, 255, "scans", "and in at least as many");
    v("order_ratio", order_ratio, 0.0, 100.0, "",
      "the same where it was seen free before its first or after its last hit");
    v("unknown_hits", unknown_hits, 0, 1023, "scans",
      "a cell that was never seen free is unknown when no more scans hit it");
  }
};

struct AgreementConfig {
  bool enabled = true;
  double min_share = 0.6;
  double join_share = 0.4;
  int join_rounds = 8;

  // Not parameters: what noise looks like, and the shares that go with join_share.
  double min_share_strong = 0.2;  ///< min_share where the evidence is strong
  double unknown_share = 0.4;     ///< join_share where a cell is unknown
  bool across_gaps = true;        ///< objects grow over gaps of one cell where nothing around stays
  /// Where more of the dynamic cells around flickers, a cell needs join_share of its neighbours to
  /// be dynamic by their own evidence.
  double flicker_share = 0.3;
  int surface_bits = 2;    ///< [bits] so thin upon what stays, dynamic cells are its noise
  int overhead_bits = 10;  ///< [bits] so high also where they hang free: a ceiling, a roof

  template <typename Visitor>
  void describe(Visitor& v) {
    v("enabled", enabled, false, true, "",
      "let neighbouring cells decide what belongs to a moving object");
    v("min_share", min_share, 0.0, 1.0, "",
      "share of its occupied neighbours that must be dynamic for a cell to be, too");
    v("join_share", join_share, 0.0, 1.0, "", "the same where a cell only leans to dynamic");
    v("join_rounds", join_rounds, 0, 30, "columns",
      "how far an object grows over leaning and unknown cells");
  }
};

}  // namespace beautymap
