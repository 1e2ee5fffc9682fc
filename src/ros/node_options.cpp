// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/ros/node_options.h"

#include <XmlRpcValue.h>

#include <algorithm>
#include <iomanip>
#include <set>
#include <sstream>

namespace beautymap {
namespace {

using XmlRpc::XmlRpcValue;

// Read by diagnostic_updater.
constexpr const char* kDiagnosticPeriod = "diagnostic_period";

std::string text(const std::string& value) { return value; }
std::string text(bool value) { return value ? "true" : "false"; }
std::string text(const std::vector<std::string>& values) {
  std::string all;
  for (const std::string& value : values) all += (all.empty() ? "" : ", ") + value;
  return "[" + all + "]";
}
template <typename T>
std::string text(T value) {
  std::ostringstream out;
  out << std::setprecision(10) << value;
  return out.str();
}

std::string written(const XmlRpcValue& value) {
  std::ostringstream out;
  value.write(out);
  return out.str();
}

bool convert(const XmlRpcValue& from, std::string& to) {
  if (from.getType() != XmlRpcValue::TypeString) return false;
  to = static_cast<std::string>(XmlRpcValue(from));
  return true;
}
bool convert(const XmlRpcValue& from, bool& to) {
  if (from.getType() != XmlRpcValue::TypeBoolean) return false;
  to = static_cast<bool>(XmlRpcValue(from));
  return true;
}
bool convert(const XmlRpcValue& from, int& to) {
  if (from.getType() != XmlRpcValue::TypeInt) return false;
  to = static_cast<int>(XmlRpcValue(from));
  return true;
}
bool convert(const XmlRpcValue& from, double& to) {
  int whole = 0;
  if (convert(from, whole)) {
    to = whole;
    return true;
  }
  if (from.getType() != XmlRpcValue::TypeDouble) return false;
  to = static_cast<double>(XmlRpcValue(from));
  return true;
}
/// A list, or one string with commas: roslaunch arguments are strings.
bool convert(const XmlRpcValue& from, std::vector<std::string>& to) {
  std::vector<std::string> values;
  std::string one;
  if (convert(from, one)) {
    std::istringstream parts(one);
    while (std::getline(parts, one, ',')) {
      one.erase(0, one.find_first_not_of(" []"));
      one.erase(one.find_last_not_of(" []") + 1);
      if (!one.empty()) values.push_back(one);
    }
  } else if (from.getType() == XmlRpcValue::TypeArray) {
    for (int i = 0; i < from.size(); ++i) {
      if (!convert(from[i], one)) return false;
      values.push_back(one);
    }
  }
  if (values.empty()) return false;
  to = values;
  return true;
}

/// Sets what the parameters name.
class Reader {
 public:
  explicit Reader(const XmlRpcValue& parameters) : parameters_(parameters) {}

  template <typename T>
  void operator()(const char* name, T& value, const char*) {
    known_.insert(name);
    if (!parameters_.hasMember(name)) return;
    if (!convert(parameters_[name], value)) refuse(name, "of type " + typeName(value));
  }
  template <typename T>
  void operator()(const char* name, T& value, T min, T max, const char* unit, const char*) {
    known_.insert(name);
    if (!parameters_.hasMember(name)) return;
    T parsed{};
    // Written so that NaN is refused.
    if (!convert(parameters_[name], parsed) || !(parsed >= min && parsed <= max)) {
      refuse(name, "from " + text(min) + " to " + text(max) + (*unit ? " [" : "") + unit +
                       (*unit ? "]" : ""));
    }
    value = parsed;
  }
  const std::set<std::string>& known() const { return known_; }

 private:
  static std::string typeName(const std::string&) { return "string"; }
  static std::string typeName(const std::vector<std::string>&) { return "list of strings"; }

  [[noreturn]] void refuse(const std::string& name, const std::string& wanted) const {
    throw ConfigError("parameter ~" + name + " = '" + written(parameters_[name]) + "': must be " +
                      wanted);
  }

  const XmlRpcValue& parameters_;
  std::set<std::string> known_;
};

class Lister {
 public:
  template <typename T>
  void operator()(const char* name, T& value, const char* meaning) {
    list.push_back({name, text(value), "", "", "", meaning, "", ""});
  }
  template <typename T>
  void operator()(const char* name, T& value, T min, T max, const char* unit, const char* meaning) {
    list.push_back({name, text(value), unit, text(min), text(max), meaning, "", ""});
  }
  std::vector<ParameterInfo> list;
};

/// The groups of the method's parameters as YAML text.
std::string groupsAsYaml(const XmlRpcValue& parameters, const std::set<std::string>& groups) {
  std::string yaml;
  for (const std::string& group : groups) {
    if (!parameters.hasMember(group)) continue;
    const XmlRpcValue& values = parameters[group];
    if (values.getType() != XmlRpcValue::TypeStruct) {
      throw ConfigError("parameter group ~" + group + " must hold named parameters");
    }
    yaml += group + ":\n";
    XmlRpcValue copy = values;
    for (auto& entry : copy) {
      std::string value;
      bool flag = false;
      double number = 0.0;
      if (convert(entry.second, value)) {
        value = "'" + value + "'";
      } else if (convert(entry.second, flag)) {
        value = text(flag);
      } else if (convert(entry.second, number)) {
        std::ostringstream exact;
        exact << std::setprecision(17) << number;
        value = exact.str();
      } else {
        value = "'" + written(entry.second) + "'";
      }
      yaml += "  " + entry.first + ": " + value + "\n";
    }
  }
  return yaml;
}

}  // namespace

void checkNodeOptions(const NodeOptions& options) {
  if (options.pose_source != "tf" && options.pose_source != "odometry") {
    throw ConfigError("parameter ~pose_source = '" + options.pose_source +
                      "': must be tf or odometry");
  }
  if (options.pose_source == "tf" && options.map_frame.empty()) {
    throw ConfigError("parameter ~map_frame is empty: name the frame of the map");
  }
}

std::pair<NodeOptions, Config> loadParameters(const ros::NodeHandle& private_nh) {
  XmlRpcValue parameters;
  const ros::NodeHandle parent(private_nh);
  if (!parent.getParam(private_nh.getNamespace(), parameters) ||
      parameters.getType() != XmlRpcValue::TypeStruct) {
    parameters = XmlRpcValue();
    parameters.begin();  // an empty struct
  }
  NodeOptions options;
  Reader reader(parameters);
  options.describe(reader);
  checkNodeOptions(options);

  std::set<std::string> groups;
  for (const ParameterInfo& p : listParameters(Config())) {
    groups.insert(p.name.substr(0, p.name.find('.')));
  }
  for (const auto& entry : parameters) {
    const std::string& name = entry.first;
    if (name == kDiagnosticPeriod || groups.count(name) + reader.known().count(name) > 0) continue;
    std::string known;
    for (const std::string& k : reader.known()) known += (known.empty() ? "" : ", ") + k;
    for (const std::string& group : groups) known += ", " + group + "/...";
    throw ConfigError("unknown parameter ~" + name + ": known are " + known);
  }
  return {options, parseConfig(groupsAsYaml(parameters, groups))};
}

std::vector<ParameterInfo> listNodeParameters() {
  NodeOptions options;
  Lister lister;
  options.describe(lister);
  return lister.list;
}

}  // namespace beautymap
