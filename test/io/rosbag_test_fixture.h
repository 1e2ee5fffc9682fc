// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "io_test_helpers.h"

namespace beautymap {
namespace test {

inline const std::vector<Eigen::Vector3f> kPoints = {{1, 2, 3}, {4, 5, 6}};

/// Clouds in `lidar` at 10.0, 10.1, ... s, the robot drives 1 m/s along x in `map`.
inline BagWriter& writeDrive(BagWriter& bag, double begin = 10.0, int scans = 5) {
  bag.tf(begin, "base_link", "lidar", poseAt(0, 0, 1), "/tf_static");
  for (int i = 0; i < scans; ++i) {
    const double stamp = begin + 0.1 * i;
    bag.tf(stamp, "map", "base_link", poseAt(stamp - begin, 0, 0));
    bag.cloud(stamp, "lidar", makeCloud(kPoints, static_cast<std::uint8_t>(i)));
  }
  return bag;
}

inline std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const auto& line : lines) text += line + "\n";
  return text;
}

/// Opens the bag that a test writes to bag_.
class RosbagTest : public testing::Test {
 protected:
  std::unique_ptr<ScanSource> open() { return openScanSource({bag_}, options_); }
  std::string openError() {
    return inputErrorOf([&] { open(); });
  }
  void expectError(const std::vector<std::string>& words) {
    const std::string error = openError();
    for (const auto& word : words) EXPECT_NE(error.find(word), std::string::npos) << error;
  }

  TempFolder folder_;
  std::string bag_ = folder_ / "a.bag";
  SourceOptions options_;
};

}  // namespace test
}  // namespace beautymap
