// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace beautymap {

struct RestorationConfig {
  bool enabled = true;
  double blind_radius = 2.0;
  double sight_range = 15.0;

  // Not parameters: one steep outlier must not open the sky.
  double steepest_share = 0.999;  ///< this quantile of the points' slopes is the steepest view

  template <typename Visitor>
  void describe(Visitor& v) {
    v("enabled", enabled, false, true, "",
      "restore what a scan could not have seen (sight mask, lowest bit, reverse ray casting)");
    v("blind_radius", blind_radius, 0.0, 20.0, "m",
      "columns nearer to the sensor are never judged");
    v("sight_range", sight_range, 0.0, 400.0, "m",
      "a column beyond it is judged only where the scan saw its ground");
  }
};

}  // namespace beautymap
