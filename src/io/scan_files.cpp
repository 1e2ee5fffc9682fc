// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "scan_files.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>

namespace beautymap {
namespace {

bool isDigit(char c) { return c >= '0' && c <= '9'; }

/// The digits that start at `at`, without leading zeros; `at` moves behind them.
std::string takeNumber(const std::string& text, std::size_t& at) {
  while (at < text.size() && text[at] == '0') ++at;
  const std::size_t begin = at;
  while (at < text.size() && isDigit(text[at])) ++at;
  return text.substr(begin, at - begin);
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

}  // namespace

bool naturalLess(const std::string& a, const std::string& b) {
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    if (isDigit(a[i]) && isDigit(b[j])) {
      const std::string m = takeNumber(a, i);
      const std::string n = takeNumber(b, j);
      if (m.size() != n.size()) return m.size() < n.size();
      if (m != n) return m < n;
    } else {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i;
      ++j;
    }
  }
  const bool a_ends = i == a.size();
  const bool b_ends = j == b.size();
  return a_ends != b_ends ? a_ends : a < b;
}

std::vector<std::filesystem::path> listFiles(const std::filesystem::path& folder,
                                             const std::string& extension) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (name[0] != '.' && lower(entry.path().extension().string()) == extension &&
        entry.is_regular_file(error)) {
      files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) {
    return naturalLess(a.filename().string(), b.filename().string());
  });
  return files;
}

std::string describePose(const Eigen::Isometry3d& T_map_sensor) {
  const Eigen::Vector3d t = T_map_sensor.translation();
  const double yaw_rad = std::atan2(T_map_sensor.linear()(1, 0), T_map_sensor.linear()(0, 0));
  char text[160];
  std::snprintf(text, sizeof(text), "x %.2f y %.2f z %.2f m, yaw %.1f deg", t.x(), t.y(), t.z(),
                yaw_rad * 180.0 / M_PI);
  return text;
}

bool makePose(const Eigen::Vector3d& translation, const Eigen::Quaterniond& rotation,
              Eigen::Isometry3d& pose) {
  // Quaternions written as text or float32 are off by some 1e-6; anything beyond a tenth is no
  // rotation (all zero: a message that nobody filled in).
  constexpr double kTolerance = 0.1;
  const double norm = rotation.norm();
  // The earth's centre is nearer; what is farther is no place of a robot, and would take the
  // millimetres from all others.
  constexpr double kFarthest = 1e7;  // [m]
  if (!(translation.cwiseAbs().maxCoeff() <= kFarthest) || !translation.allFinite() ||
      !(std::abs(norm - 1.0) < kTolerance)) {
    return false;
  }
  pose.setIdentity();
  pose.linear() = rotation.normalized().toRotationMatrix();
  pose.translation() = translation;
  return true;
}

}  // namespace beautymap
