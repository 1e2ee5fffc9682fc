// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/ros/node_options.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace beautymap {
namespace {

std::string readFile(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

TEST(NodeOptions, TheReadmeListsEveryParameterWithDefaultRangeAndMeaning) {
  const std::string readme = readFile(std::filesystem::path(BEAUTYMAP_SOURCE_DIR) / "README.md");
  for (const ParameterInfo& p : listNodeParameters()) {
    std::string range = p.min.empty() ? "" : p.min + " to " + p.max;
    if (!p.unit.empty()) range += " " + p.unit;
    const std::string row =
        "| `~" + p.name + "` | " + p.value + " | " + range + " | " + p.meaning + " |";
    EXPECT_NE(readme.find(row), std::string::npos) << "README.md lacks: " << row;
  }
}

TEST(NodeOptions, EveryParameterHasADefaultInItsRangeAndAMeaning) {
  for (const ParameterInfo& p : listNodeParameters()) {
    EXPECT_FALSE(p.meaning.empty()) << p.name;
    if (p.min.empty() || p.min == "false") continue;
    EXPECT_LE(std::stod(p.min), std::stod(p.value)) << p.name;
    EXPECT_GE(std::stod(p.max), std::stod(p.value)) << p.name;
  }
}

TEST(NodeOptions, PoseSourcesThatDoNotExistAreRefused) {
  NodeOptions options;
  checkNodeOptions(options);
  options.pose_source = "odometry";
  checkNodeOptions(options);
  options.pose_source = "gps";
  EXPECT_THROW(checkNodeOptions(options), ConfigError);
  options = NodeOptions();
  options.map_frame = "";
  EXPECT_THROW(checkNodeOptions(options), ConfigError);
}

}  // namespace
}  // namespace beautymap
