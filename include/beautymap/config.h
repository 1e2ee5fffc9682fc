// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

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
  double res_h = 0.25;
  int n_bit = 64;
  double roi_size = 40.0;

  template <typename Visitor>
  void describe(Visitor& v) {
    v("res_g", res_g, 0.05, 10.0, "m", "horizontal size of a cell");
    v("res_h", res_h, 0.02, 5.0, "m", "height of one bit of a column");
    v("n_bit", n_bit, 2, 64, "bits",
      "bits of a column; whatever is higher than n_bit * res_h above ground counts as the top bit");
    v("roi_size", roi_size, 1.0, 400.0, "m",
      "side of the square around the sensor in which a scan is compared with the map");
  }
};

struct CoarseGroundConfig {
  bool enabled = true;
  int radius = 2;
  double min_share = 0.6;
  double mad_factor = 3.0;

  template <typename Visitor>
  void describe(Visitor& v) {
    v("enabled", enabled, false, true, "",
      "estimate each column's ground; off: every column starts at the map's lowest point, and "
      "fine_ground is off too");
    v("radius", radius, 1, 20, "columns", "half size of the square neighbourhood of a column");
    v("min_share", min_share, 0.0, 1.0, "",
      "share of the neighbouring columns that must hold points, otherwise a column's own lowest "
      "point is its ground");
    v("mad_factor", mad_factor, 0.0, 20.0, "",
      "how many median absolute deviations a ground height may lie from the neighbours' median");
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

/// Everything that decides what is removed. Defaults here equal config/default.yaml.
struct Config {
  ScanConfig scan;
  MatrixConfig matrix;
  CoarseGroundConfig coarse_ground;
  RestorationConfig restoration;
  FineGroundConfig fine_ground;

  template <typename Visitor>
  void describe(Visitor& v) {
    v.group("scan", scan);
    v.group("matrix", matrix);
    v.group("coarse_ground", coarse_ground);
    v.group("restoration", restoration);
    v.group("fine_ground", fine_ground);
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
