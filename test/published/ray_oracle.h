// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include "beautymap/matrix/column_grid.h"

namespace beautymap::test {

/// The columns that a scan hit, as a ray sees them.
struct HitColumn {
  Bits hits = 0;
  double ground = 0.0;  ///< [m]
};
using HitColumnAt = std::function<HitColumn(int x, int y)>;

/// Reverse virtual ray casting by walking along the ray in small steps, in double.
class RayOracle {
 public:
  RayOracle(HitColumnAt column_at, double res_g, double res_h, int n_bit)
      : column_at_(std::move(column_at)), res_g_(res_g), res_h_(res_h), n_bit_(n_bit) {}

  /// Whether the ray from a cell's centre to the sensor [m] meets a hit cell in another column. No
  /// answer for a ray that passes a hit cell within 1e-4 of a cell's size inside or outside its
  /// border: there float may come out either way, as some ten roundings of 6e-8 add up along a way
  /// of up to some hundred cells.
  std::optional<bool> hidden(const Eigen::Vector3d& centre, const Eigen::Vector3d& sensor) const {
    // Nearly all rays are decided with large steps: only those near a border need small ones.
    for (const double step : {0.05, 0.005, 5e-4, 1e-4}) {
      const std::optional<bool> answer = hidden(centre, sensor, step);
      if (answer) return answer;
    }
    return std::nullopt;
  }

 private:
  /// In steps of `step` cells; no answer for what passes within one step of a border.
  std::optional<bool> hidden(const Eigen::Vector3d& centre, const Eigen::Vector3d& sensor,
                             double step) const {
    const Eigen::Array3d cell(res_g_, res_g_, res_h_);
    const Eigen::Array3d way = (sensor - centre).array() / cell;
    const auto steps = static_cast<int>(std::ceil(way.abs().maxCoeff() / step)) + 1;
    const int start_x = columnOf(centre.x()), start_y = columnOf(centre.y());
    bool maybe = false;
    for (int i = 0; i <= steps; ++i) {
      const Eigen::Vector3d at = centre + (sensor - centre) * (static_cast<double>(i) / steps);
      int met = 0;
      for (int side = 0; side < 4; ++side) {
        const int x = columnOf(at.x() + ((side & 1) != 0 ? step : -step) * res_g_);
        const int y = columnOf(at.y() + ((side & 2) != 0 ? step : -step) * res_g_);
        if (x == start_x && y == start_y) continue;
        const HitColumn column = column_at_(x, y);
        if (column.hits == 0) continue;
        met += isHit(column, at.z() - step * res_h_) + isHit(column, at.z() + step * res_h_);
      }
      if (met == 8) return true;
      maybe = maybe || met > 0;
    }
    return maybe ? std::nullopt : std::optional<bool>(false);
  }

  int columnOf(double position) const { return static_cast<int>(std::floor(position / res_g_)); }

  int isHit(const HitColumn& column, double z) const {
    const double k = std::floor((z - column.ground) / res_h_);
    if (k < 0.0) return 0;
    return static_cast<int>(column.hits >> static_cast<int>(std::min(k, n_bit_ - 1.0)) & 1);
  }

  HitColumnAt column_at_;
  double res_g_, res_h_;
  int n_bit_;
};

}  // namespace beautymap::test
