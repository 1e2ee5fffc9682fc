// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/config/config.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <iomanip>
#include <iterator>
#include <set>
#include <sstream>
#include <type_traits>

namespace beautymap {
namespace {

/// The shortest text that reads back as the same value.
template <typename T>
std::string text(const T& value) {
  for (int digits = 10;; ++digits) {
    std::ostringstream out;
    out << std::boolalpha << std::setprecision(digits) << value;
    T back{};
    std::istringstream(out.str()) >> std::boolalpha >> back;
    if (back == value || digits == 17) return out.str();
  }
}

template <typename T>
[[noreturn]] void refuse(const std::string& name, const std::string& value, const T& min,
                         const T& max, const std::string& unit) {
  const std::string range =
      std::is_same<T, bool>::value
          ? "true or false"
          : "from " + text(min) + " to " + text(max) + (unit.empty() ? "" : " [" + unit + "]");
  throw ConfigError("parameter " + name + " = '" + value + "': must be " + range);
}

template <typename T>
void assign(const std::string& name, const YAML::Node& node, T& value, T min, T max,
            const std::string& unit) {
  T parsed{};
  const std::string written = node.IsScalar() ? node.Scalar() : "not a single value";
  if (!node.IsScalar() || !YAML::convert<T>::decode(node, parsed)) {
    refuse(name, written, min, max, unit);
  }
  if constexpr (std::is_floating_point<T>::value) {
    if (!std::isfinite(parsed)) refuse(name, written, min, max, unit);
  }
  if (parsed < min || parsed > max) refuse(name, written, min, max, unit);
  value = parsed;
}

using Choices = std::initializer_list<const char*>;

std::string text(Choices choices) {
  std::string all;
  for (const char* choice : choices) all.append(all.empty() ? "" : " or ").append(choice);
  return all;
}

void checkChoice(const std::string& name, const std::string& value, Choices choices) {
  if (std::find(choices.begin(), choices.end(), value) != choices.end()) return;
  throw ConfigError("parameter " + name + " = '" + value + "': must be " + text(choices));
}

/// Sets the parameters that a YAML map names, and remembers which names exist.
class Reader {
 public:
  explicit Reader(const YAML::Node& root) : root_(root) {}

  template <typename Group>
  void group(const char* name, Group& group) {
    known_.push_back(name);
    node_.reset(root_.IsMap() ? root_[name] : YAML::Node(YAML::NodeType::Undefined));
    group_ = name;
    names_.clear();
    if (node_.IsDefined() && !node_.IsMap() && !node_.IsNull()) {
      throw ConfigError("parameter group " + group_ + " must hold named parameters");
    }
    group.describe(*this);
    if (!node_.IsDefined() || !node_.IsMap()) return;
    refuseOthers(node_, names_, group_ + ".");
  }

  template <typename T>
  void operator()(const char* name, T& value, T min, T max, const char* unit, const char*,
                  const char* = "") {
    names_.push_back(name);
    if (!node_.IsDefined() || !node_.IsMap() || !node_[name]) return;
    assign(group_ + "." + name, node_[name], value, min, max, unit);
  }
  void operator()(const char* name, std::string& value, Choices choices, const char*,
                  const char* = "") {
    names_.push_back(name);
    if (!node_.IsDefined() || !node_.IsMap() || !node_[name]) return;
    const std::string written =
        node_[name].IsScalar() ? node_[name].Scalar() : "not a single value";
    checkChoice(group_ + "." + name, written, choices);
    value = written;
  }

  void refuseUnknownGroups() const {
    if (root_.IsNull()) return;
    if (!root_.IsMap()) throw ConfigError("the configuration must hold named parameter groups");
    refuseOthers(root_, known_, "");
  }

 private:
  [[noreturn]] static void refuseUnknown(const std::string& name,
                                         const std::vector<std::string>& known) {
    std::string names;
    for (const std::string& k : known) names.append(names.empty() ? "" : ", ").append(k);
    throw ConfigError("unknown parameter " + name + ": known are " + names);
  }
  [[noreturn]] static void refuseTwice(const std::string& name) {
    throw ConfigError("parameter " + name + " comes twice");
  }

  /// Refuses names that are not known, and names that come twice.
  static void refuseOthers(const YAML::Node& map, const std::vector<std::string>& known,
                           const std::string& prefix) {
    std::set<std::string> seen;
    for (const auto& entry : map) {
      const std::string name = entry.first.IsScalar() ? entry.first.Scalar() : "(not a name)";
      if (std::find(known.begin(), known.end(), name) == known.end()) {
        refuseUnknown(prefix + name, known);
      }
      if (!seen.insert(name).second) refuseTwice(prefix + name);
    }
  }

  YAML::Node root_;
  YAML::Node node_;
  std::string group_;
  std::vector<std::string> names_;
  std::vector<std::string> known_;
};

/// Refuses values outside their range.
class RangeChecker {
 public:
  template <typename Group>
  void group(const char* name, Group& group) {
    group_ = name;
    group.describe(*this);
  }
  template <typename T>
  void operator()(const char* name, T& value, T min, T max, const char* unit, const char*,
                  const char* = "") {
    // Written so that NaN is refused.
    if (!(value >= min && value <= max)) refuse(group_ + "." + name, text(value), min, max, unit);
  }
  void operator()(const char* name, const std::string& value, Choices choices, const char*,
                  const char* = "") {
    checkChoice(group_ + "." + name, value, choices);
  }

 private:
  std::string group_;
};

class Lister {
 public:
  template <typename Group>
  void group(const char* name, Group& group) {
    group_ = name;
    group.describe(*this);
  }
  template <typename T>
  void operator()(const char* name, T& value, T min, T max, const char* unit, const char* meaning,
                  const char* symptom = "") {
    list.push_back(
        {group_ + "." + name, text(value), unit, text(min), text(max), meaning, "", symptom});
  }
  void operator()(const char* name, const std::string& value, Choices choices, const char* meaning,
                  const char* symptom = "") {
    list.push_back({group_ + "." + name, value, "", *choices.begin(), *(choices.end() - 1), meaning,
                    text(choices), symptom});
  }

  std::vector<ParameterInfo> list;

 private:
  std::string group_;
};

std::string readFile(const std::string& path) {
  std::ifstream file(path);
  // A folder opens, too.
  if (!file || std::filesystem::is_directory(path)) throw ConfigError("cannot be read");
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void apply(Config& config, const YAML::Node& root) {
  Reader reader(root);
  config.describe(reader);
  reader.refuseUnknownGroups();
}

}  // namespace

Config parseConfig(const std::string& yaml) {
  Config config;
  try {
    apply(config, YAML::Load(yaml));
  } catch (const YAML::Exception& e) {
    throw ConfigError(std::string("cannot be read as YAML: ") + e.what());
  }
  checkConfig(config);
  return config;
}

Config loadConfig(const std::string& path) {
  try {
    return parseConfig(readFile(path));
  } catch (const ConfigError& e) {
    throw ConfigError(path + ": " + e.what());
  }
}

void setParameter(Config& config, const std::string& assignment) {
  const auto equals = assignment.find('=');
  const auto dot = assignment.find('.');
  if (equals == std::string::npos || dot == std::string::npos || dot > equals) {
    throw ConfigError("'" + assignment + "': expected group.parameter=value");
  }
  YAML::Node root;
  root[assignment.substr(0, dot)][assignment.substr(dot + 1, equals - dot - 1)] =
      assignment.substr(equals + 1);
  apply(config, root);
}

void checkConfig(const Config& config) {
  Config copy = config;
  RangeChecker checker;
  copy.describe(checker);
  if (config.scan.min_range >= config.scan.max_range) {
    throw ConfigError("scan.min_range = " + text(config.scan.min_range) +
                      " must be less than scan.max_range = " + text(config.scan.max_range));
  }
  if (config.matrix.room_res_g > 0.0 && config.matrix.room_res_g < 0.05) {
    throw ConfigError("matrix.room_res_g = " + text(config.matrix.room_res_g) +
                      " must be 0 or at least 0.05");
  }
  constexpr double kMaxColumns = 2000;  // of a window's side: 32 MB for each of its matrices
  const double smallest = config.matrix.resInRoom();
  if (config.matrix.roi_size / smallest > kMaxColumns) {
    throw ConfigError("matrix.roi_size = " + text(config.matrix.roi_size) + " must be at most " +
                      text(kMaxColumns) + " cells of " + text(smallest) + " m");
  }
  // What a scan of few points may ask for: each may lie in a tile of its own.
  constexpr double kMaxReach = 4000;  // columns from the sensor: 9 GB of tiles
  if (config.scan.max_range / smallest > kMaxReach) {
    throw ConfigError("scan.max_range = " + text(config.scan.max_range) + " must be at most " +
                      text(kMaxReach) + " cells of " + text(smallest) +
                      " m (matrix.res_g, matrix.room_res_g; 0: none for rooms)");
  }
  constexpr double kSmallestVoxel = 0.001;  // [m]: keys of smaller ones would overflow
  if (config.online.map_voxel > 0.0 && config.online.map_voxel < kSmallestVoxel) {
    throw ConfigError("online.map_voxel = " + text(config.online.map_voxel) +
                      " must be 0 or at least " + text(kSmallestVoxel));
  }
  if (config.matrix.bits_below >= config.matrix.n_bit) {
    throw ConfigError("matrix.bits_below = " + text(config.matrix.bits_below) +
                      " must be less than matrix.n_bit = " + text(config.matrix.n_bit));
  }
  if (config.fine_ground.bin_height > config.matrix.res_h) {
    throw ConfigError("fine_ground.bin_height = " + text(config.fine_ground.bin_height) +
                      " must not exceed matrix.res_h = " + text(config.matrix.res_h));
  }
}

std::vector<ParameterInfo> listParameters(const Config& config) {
  Config copy = config;
  Lister lister;
  copy.describe(lister);
  return lister.list;
}

std::string toYaml(const Config& config) {
  std::string out, group;
  for (const ParameterInfo& p : listParameters(config)) {
    const auto dot = p.name.find('.');
    if (p.name.substr(0, dot) != group) {
      group = p.name.substr(0, dot);
      out += group + ":\n";
    }
    out += "  " + p.name.substr(dot + 1) + ": " + p.value + "  # ";
    if (!p.unit.empty()) out += "[" + p.unit + "] ";
    out += p.meaning + "\n";
  }
  return out;
}

}  // namespace beautymap
