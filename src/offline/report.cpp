// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <nlohmann/json.hpp>

#include "beautymap/offline/offline_cleaner.h"

namespace beautymap {
namespace {

using Json = nlohmann::ordered_json;

Json skippedJson(const OfflineReport& report) {
  Json scans = Json::object();
  for (const auto& s : report.skipped_scans) {
    scans[s.first] = {{"count", s.second.count}, {"example", s.second.example}};
  }
  const DroppedPoints& dropped = report.dropped_points;
  return {{"scans", scans},
          {"points",
           {{"non_finite", dropped.non_finite},
            {"zero", dropped.zero},
            {"too_near", dropped.too_near},
            {"too_far", dropped.too_far}}}};
}

}  // namespace

std::string toJson(const OfflineReport& report, const Config& config) {
  const double scans = static_cast<double>(report.scans);
  Json json = {{"scans", report.scans},
               {"points", report.points},
               {"static_points", report.static_points},
               {"dynamic_points", report.dynamic_points},
               {"skipped", skippedJson(report)},
               {"seconds", report.seconds},
               {"scans_per_s", report.seconds > 0.0 ? scans / report.seconds : 0.0}};
  // Per scan; what runs once for the whole map is shared among the scans.
  for (const auto& stage : report.stages.stages()) {
    json["stages_ms"][stage.first] = stage.second / scans;
  }
  json["peak_memory_mb"] = report.peak_memory_mb;
  json["matrix"] = {{"cell_size_m", report.cell_size_m},
                    {"tiles", report.tiles},
                    {"memory_mb", report.matrix_memory_mb}};
  json["up"] = {{"direction", {report.up.up.x(), report.up.up.y(), report.up.up.z()}},
                {"certain", report.up.isCertain()},
                {"meaning", report.up.describe()}};
  json["coordinates"] = report.float64_coordinates ? "float64" : "float32";
  if (report.score) {
    const Score& s = *report.score;
    json["scores"] = {{"SA", s.SA()},
                      {"DA", s.DA()},
                      {"AA", s.AA()},
                      {"HA", s.HA()},
                      {"static", s.static_points},
                      {"dynamic", s.dynamic_points}};
  }
  for (const ParameterInfo& p : listParameters(config)) {
    const auto dot = p.name.find('.');
    json["config"][p.name.substr(0, dot)][p.name.substr(dot + 1)] =
        p.choices.empty() ? Json::parse(p.value) : Json(p.value);
  }
  return json.dump(2) + "\n";
}

}  // namespace beautymap
