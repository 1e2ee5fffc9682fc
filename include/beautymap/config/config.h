// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "beautymap/config/evidence_config.h"
#include "beautymap/config/ground_config.h"
#include "beautymap/config/matrix_config.h"
#include "beautymap/config/online_config.h"
#include "beautymap/config/published_config.h"

namespace beautymap {

/// A parameter with an unknown name or a value outside its range. what() names both and the range.
class ConfigError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

// Each struct belongs to one stage, and stands in the header of its room. describe() declares each
// parameter once: name, value, smallest, largest (or the choices), unit, meaning, and for the few
// that users turn the symptom. The default stands at the member. Members that describe() leaves out
// are constants.

/// Which judgement says what is removed: one line for each in cleaner/make_judgement.cpp.
struct JudgementConfig {
  std::string method = "evidence";

  template <typename Visitor>
  void describe(Visitor& v) {
    v("method", method, {"evidence", "published"},
      "evidence: count over all scans how often each cell was hit and seen free; published: what "
      "one scan finds dynamic is removed",
      "to compare with the paper: published");
  }
};

struct MapConfig {
  std::string up = "auto";

  template <typename Visitor>
  void describe(Visitor& v) {
    v("up", up, {"auto", "z", "-z", "y", "-y", "x", "-x"},
      "which axis of the map frame points up; auto: found from the ground of the first scans",
      "a warning says that another surface could be the ground: the axis that points up");
  }
};

/// Everything that decides what is removed. Defaults here equal config/default.yaml.
struct Config {
  JudgementConfig judgement;
  MapConfig map;
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
    v.group("judgement", judgement);
    v.group("map", map);
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
  std::string min;  ///< of choices the first one
  std::string max;
  std::string meaning;
  std::string choices;  ///< empty for numbers
  std::string symptom;  ///< when to change it which way; empty for experts' parameters

  /// "MIN to MAX UNIT", or the choices.
  std::string range() const {
    return choices.empty() ? min + " to " + max + (unit.empty() ? "" : " " + unit) : choices;
  }
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
