// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

namespace beautymap {

/// A parameter with an unknown name or a value outside its range. what() names both and the range.
class ConfigError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

// Each struct belongs to one stage. describe() declares each parameter once:
// name, value, smallest, largest, unit, meaning. The default stands at the member.

struct ScanConfig {
  double min_range = 0.0;
  double max_range = 200.0;

  template <typename Visitor>
  void describe(Visitor& v) {
    v("min_range", min_range, 0.0, 100.0, "m", "points nearer to the sensor are dropped");
    v("max_range", max_range, 1.0, 1000.0, "m", "points farther from the sensor are dropped");
  }
};

struct MatrixConfig {
  double res_g = 0.5;
  double room_res_g = 0.15;
  double room_range = 12.0;
  double res_h = 0.2;
  int n_bit = 64;
  int bits_below = 8;
  double roi_size = 160.0;

  /// Horizontal size of a cell in a room [m].
  double resInRoom() const { return room_res_g > 0.0 ? std::min(room_res_g, res_g) : res_g; }

  template <typename Visitor>
  void describe(Visitor& v) {
    v("res_g", res_g, 0.05, 10.0, "m", "horizontal size of a cell");
    v("room_res_g", room_res_g, 0.0, 10.0, "m",
      "the same in a room, if that is smaller; 0: no difference");
    v("room_range", room_range, 0.0, 1000.0, "m",
      "a room is where nine of ten points of the first scan are no farther");
    v("res_h", res_h, 0.02, 5.0, "m", "height of one bit of a column");
    v("n_bit", n_bit, 2, 64, "bits",
      "bits of a column; whatever is higher than n_bit * res_h above ground counts as the top bit");
    v("bits_below", bits_below, 0, 32, "bits",
      "bits of a column that lie below its coarse ground, so that a lower level is judged, too");
    v("roi_size", roi_size, 1.0, 400.0, "m",
      "side of the square around the sensor in which a scan is compared with the map");
  }
};

struct LevellingConfig {
  bool enabled = true;
  int radius = 100;
  double min_correction = 0.03;

  template <typename Visitor>
  void describe(Visitor& v) {
    v("enabled", enabled, false, true, "",
      "tilt and raise scans whose ground does not lie where the other scans' does, before they are "
      "judged (only with evidence)");
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

struct RestorationConfig {
  bool enabled = true;
  double blind_radius = 2.0;
  double sight_range = 15.0;
  double steepest_share = 0.999;

  template <typename Visitor>
  void describe(Visitor& v) {
    v("enabled", enabled, false, true, "",
      "restore what a scan could not have seen (sight mask, lowest bit, reverse ray casting)");
    v("blind_radius", blind_radius, 0.0, 20.0, "m",
      "columns nearer to the sensor are never judged");
    v("sight_range", sight_range, 0.0, 400.0, "m",
      "a column beyond it is judged only where the scan saw its ground");
    v("steepest_share", steepest_share, 0.5, 1.0, "",
      "this quantile of the points' slopes is the steepest view; 1: the maximum");
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
  bool enabled = true;
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
    v("enabled", enabled, false, true, "",
      "count over all scans how often each cell was hit and seen free; off: what one scan finds "
      "dynamic is removed, as published");
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
      "let neighbouring cells decide what belongs to a moving object (only with evidence)");
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

/// Everything that decides what is removed. Defaults here equal config/default.yaml.
struct Config {
  ScanConfig scan;
  MatrixConfig matrix;
  LevellingConfig levelling;
  CoarseGroundConfig coarse_ground;
  RestorationConfig restoration;
  FineGroundConfig fine_ground;
  GroundLayerConfig ground_layer;
  VisibilityConfig visibility;
  EvidenceConfig evidence;
  AgreementConfig agreement;
  OnlineConfig online;

  template <typename Visitor>
  void describe(Visitor& v) {
    v.group("scan", scan);
    v.group("matrix", matrix);
    v.group("levelling", levelling);
    v.group("coarse_ground", coarse_ground);
    v.group("restoration", restoration);
    v.group("fine_ground", fine_ground);
    v.group("ground_layer", ground_layer);
    v.group("visibility", visibility);
    v.group("evidence", evidence);
    v.group("agreement", agreement);
    v.group("online", online);
  }
};

/// One parameter for tables and help texts; values as YAML writes them.
struct ParameterInfo {
  std::string name;  ///< as in --set, e.g. matrix.res_g
  std::string value;
  std::string unit;
  std::string min;
  std::string max;
  std::string meaning;
};

/// Reads a YAML file over the defaults.
/// @throws ConfigError for a file that cannot be read, an unknown key, or a value outside its
/// range.
Config loadConfig(const std::string& path);

/// The same from YAML text.
Config parseConfig(const std::string& yaml);

/// Sets one parameter from "group.name=value"; contradictions are left to checkConfig(). @throws
/// ConfigError
void setParameter(Config& config, const std::string& assignment);

/// @throws ConfigError when a value is outside its range or values contradict each other.
void checkConfig(const Config& config);

/// All parameters with their present values.
std::vector<ParameterInfo> listParameters(const Config& config);

/// The whole configuration as a YAML file that loadConfig() reads.
std::string toYaml(const Config& config);

}  // namespace beautymap
