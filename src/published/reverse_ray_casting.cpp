// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/published/reverse_ray_casting.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace beautymap {
namespace {

/// Walks through the columns between a column's centre and the sensor (Amanatides and Woo, 1987).
/// Coordinates in columns.
class ColumnWalk {
 public:
  ColumnWalk(float from_x, float from_y, float to_x, float to_y)
      : x_(floorToInt(from_x)), y_(floorToInt(from_y)) {
    startAxis(from_x, to_x - from_x, step_x_, delta_x_, next_x_);
    startAxis(from_y, to_y - from_y, step_y_, delta_y_, next_y_);
  }

  /// Goes to the next column; false when the sensor lies in the present one.
  bool advance() {
    enter_ = std::min(next_x_, next_y_);
    if (enter_ >= 1.0F) return false;
    if (next_x_ < next_y_) {
      x_ += step_x_;
      next_x_ += delta_x_;
    } else {
      y_ += step_y_;
      next_y_ += delta_y_;
    }
    return true;
  }

  int x() const { return x_; }
  int y() const { return y_; }
  /// The share of the way at which the walk enters and leaves the column.
  float enter() const { return enter_; }
  float leave() const { return std::min(1.0F, std::min(next_x_, next_y_)); }

 private:
  static void startAxis(float from, float way, int& step, float& delta, float& next) {
    step = way > 0.0F ? 1 : -1;
    delta = way == 0.0F ? std::numeric_limits<float>::infinity() : 1.0F / std::abs(way);
    const float cell = static_cast<float>(floorToInt(from));
    next = way == 0.0F ? delta : (way > 0.0F ? cell + 1.0F - from : from - cell) * delta;
  }

  int x_, y_;
  int step_x_ = 0, step_y_ = 0;
  float delta_x_ = 0, delta_y_ = 0, next_x_ = 0, next_y_ = 0, enter_ = 0;
};

/// Bits of a column that a ray between two heights above its ground, in units of a bit, passes
/// through.
Bits bitsBetween(float a, float b, int n_bit) {
  const float low = std::min(a, b);
  const float high = std::max(a, b);
  if (high < 0.0F) return 0;
  const float top = static_cast<float>(n_bit - 1);
  const int first = static_cast<int>(std::clamp(low, 0.0F, top));
  const int last = static_cast<int>(std::min(high, top));
  return lowBits(last + 1) & ~lowBits(first);
}

/// The candidates of one column that are hidden.
class ColumnRays {
 public:
  ColumnRays(const BitGrid& scan_bits, const HeightGrid& ground, const PlacedScan& scan,
             const MatrixConfig& config)
      : scan_bits_(scan_bits),
        ground_(ground),
        sensor_z_(scan.sensor.z()),
        res_h_(static_cast<float>(config.res_h)),
        n_bit_(config.n_bit) {
    const ColumnWindow& window = scan_bits.window();
    sensor_x_ = scan.sensor.x() / static_cast<float>(config.res_g) +
                static_cast<float>(scan.anchor.x - window.corner.x);
    sensor_y_ = scan.sensor.y() / static_cast<float>(config.res_g) +
                static_cast<float>(scan.anchor.y - window.corner.y);
  }

  Bits hidden(int x, int y, Bits candidates) const {
    const float ground = ground_.at(x, y);
    ColumnWalk walk(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F, sensor_x_,
                    sensor_y_);
    Bits hidden = 0;
    Bits open = candidates;
    while (open != 0 && walk.advance()) {
      if (!scan_bits_.inside(walk.x(), walk.y())) break;
      const Bits hits = scan_bits_.at(walk.x(), walk.y());
      if (hits == 0) continue;
      const float here = ground_.at(walk.x(), walk.y());
      for (Bits rest = open; rest != 0; rest &= rest - 1) {
        const Bits bit = lowestBit(rest);
        const float z = ground + (static_cast<float>(lowestBitIndex(bit)) + 0.5F) * res_h_;
        const float rise = sensor_z_ - z;
        const Bits passed = bitsBetween((z + walk.enter() * rise - here) / res_h_,
                                        (z + walk.leave() * rise - here) / res_h_, n_bit_);
        if ((hits & passed) != 0) hidden |= bit;
      }
      open &= ~hidden;
    }
    return hidden;
  }

 private:
  const BitGrid& scan_bits_;
  const HeightGrid& ground_;
  float sensor_z_, res_h_;
  float sensor_x_ = 0, sensor_y_ = 0;  // [columns] in the window
  int n_bit_;
};

}  // namespace

BitGrid cellsHidden(const BitGrid& candidates, const BitGrid& scan_bits, const HeightGrid& ground,
                    const PlacedScan& scan, const MatrixConfig& config) {
  const ColumnRays rays(scan_bits, ground, scan, config);
  BitGrid hidden(candidates.window(), 0);
  for (int x = 0; x < candidates.size(); ++x) {
    for (int y = 0; y < candidates.size(); ++y) {
      if (candidates.at(x, y) != 0) hidden.at(x, y) = rays.hidden(x, y, candidates.at(x, y));
    }
  }
  return hidden;
}

}  // namespace beautymap
