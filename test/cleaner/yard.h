// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "beautymap/cleaner/online_map.h"
#include "test_scenes.h"

namespace beautymap::test {

/// Walls around a yard, in which a box is where `visitor` says.
inline BoxWorld yard(const std::vector<Box>& visitor) {
  BoxWorld world;
  world.boxes = {{{-12, -12, 0}, {-11, 12, 4}},
                 {{11, -12, 0}, {12, 12, 4}},
                 {{-12, -12, 0}, {12, -11, 4}},
                 {{-12, 11, 0}, {12, 12, 4}}};
  world.boxes.insert(world.boxes.end(), visitor.begin(), visitor.end());
  return world;
}
constexpr int kVisitor = 4;  ///< index of the visitor's box

inline Box person(double x, double y) { return {{x - 0.3, y - 0.3, 0.0}, {x + 0.3, y + 0.3, 1.8}}; }

inline LabelledScan look(const std::vector<Box>& visitor,
                         const Eigen::Vector3d& offset = {0, 0, 0}) {
  LabelledScan labelled =
      castScan(yard(visitor), Eigen::Vector3d(0.1, 0.2, 1.5), 64, -25.0, 15.0, 720);
  labelled.scan.T_map_cloud = Eigen::Translation3d(offset);
  labelled.scan.sensor_in_map += offset;
  return labelled;
}

inline void add(OnlineMap& map, const Scan& scan) {
  map.addHits(scan);
  map.addSeenFree();
}

/// Share of a visitor's points, higher than the ground layer, with a class.
inline double shareOf(const LabelledScan& labelled, const std::vector<PointClass>& classes,
                      PointClass wanted) {
  int all = 0, found = 0;
  for (std::size_t i = 0; i < classes.size(); ++i) {
    if (labelled.box[i] != kVisitor || labelled.scan.cloud[i].z < 0.45F) continue;
    ++all;
    found += classes[i] == wanted ? 1 : 0;
  }
  return all == 0 ? -1.0 : static_cast<double>(found) / all;
}

}  // namespace beautymap::test
