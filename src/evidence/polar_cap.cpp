// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/evidence/polar_cap.h"

#include <cmath>
#include <cstddef>
#include <cstring>

#include "../base/vector_clones.h"
#include "pixel_lanes.h"

namespace beautymap {
namespace {

/// Beams in some pixels, and those of them that ended behind a limit.
struct BeamCount {
  int all = 0, passed = 0;
};

BEAUTYMAP_VECTOR_CLONES
BeamCount countBeams(const BeamPixels::Pixel* first, int rows, int columns, std::ptrdiff_t stride,
                     BeamPixels::Pixel limit) {
  const Lanes lane{0, 1, 2, 3, 4, 5, 6, 7};
  Lanes all{}, passed{};
  for (int column = 0; column < columns; column += static_cast<int>(kLanes)) {
    const Lanes counted = (lane < columns - column) & BeamPixels::kMaxCount;
    for (int row = 0; row < rows; ++row) {
      Lanes lanes;
      std::memcpy(&lanes, first + row * stride + column, sizeof(lanes));
      const Lanes counts = lanes & counted;
      all += counts;
      passed += counts & (lanes > limit);
    }
  }
  BeamCount count;
  for (std::size_t i = 0; i < kLanes; ++i) {
    count.all += all[i];
    count.passed += passed[i];
  }
  return count;
}

/// Tangents between which a cell lies that reaches from low to high [m] at distances from near to
/// far.
struct Tangents {
  Tangents(float low, float high, float near, float far)
      : lowest(low / (low < 0.0F ? near : far)), highest(high / (high < 0.0F ? far : near)) {}

  float lowest, highest;
};

}  // namespace

PolarCap::PolarCap(Side side, const VisibilityConfig& config)
    : up_(side == Side::kAbove ? 1.0F : -1.0F),
      pixels_per_tangent_(static_cast<float>(1.0 / std::tan(config.pixel_deg * (M_PI / 180.0)))) {}

void PolarCap::fill(const PlacedScan& scan) {
  clear();
  first_u_ = first_v_ = pixelOf(1.0F);
  last_u_ = last_v_ = 0;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const float distance = up_ * (scan.z[i] - scan.sensor.z());
    const float x = scan.x[i] - scan.sensor.x(), y = scan.y[i] - scan.sensor.y();
    // At the sensor's height there is no tangent.
    if (std::max(std::abs(x), std::abs(y)) >= distance) continue;
    const Beam beam{pixelOf(x / distance), pixelOf(y / distance), endAt(distance)};
    first_u_ = std::min(first_u_, beam.u);
    last_u_ = std::max(last_u_, beam.u);
    first_v_ = std::min(first_v_, beam.v);
    last_v_ = std::max(last_v_, beam.v);
    beams_.push_back(beam);
  }
  if (empty()) return;
  const int rows = last_u_ - first_u_ + 1, columns = last_v_ - first_v_ + 1;
  const auto width = static_cast<std::size_t>(columns);
  pixels_.assign(static_cast<std::size_t>(rows) * width + kPadding, kEmpty);
  for (const Beam& beam : beams_) {
    const auto u = static_cast<std::size_t>(beam.u - first_u_);
    addBeam(pixels_[u * width + static_cast<std::size_t>(beam.v - first_v_)], beam.end);
  }
}

bool PolarCap::inImage(const Cell& cell, const VisibilityConfig& config) {
  const float aside = std::max(std::abs(cell.x), std::abs(cell.y)) + cell.half_width;
  return cell.near > std::max({aside, kNearest, static_cast<float>(config.blind_radius)});
}

Seen PolarCap::see(const Cell& cell, Pixel limit, const VisibilityConfig& config) const {
  const float half = cell.half_width;
  const Tangents along_x(cell.x - half, cell.x + half, cell.near, cell.far);
  const Tangents along_y(cell.y - half, cell.y + half, cell.near, cell.far);
  const int u = std::max(pixelOf(along_x.lowest), first_u_);
  const int v = std::max(pixelOf(along_y.lowest), first_v_);
  const int rows = std::min(pixelOf(along_x.highest), last_u_) - u + 1;
  const int columns = std::min(pixelOf(along_y.highest), last_v_) - v + 1;
  if (rows <= 0 || columns <= 0) return Seen::kNot;
  const std::ptrdiff_t stride = last_v_ - first_v_ + 1;
  const Pixel* first = pixels_.data() + (u - first_u_) * stride + (v - first_v_);
  const BeamCount count = countBeams(first, rows, columns, stride, limit);
  return seenBy(count.passed, count.all, config);
}

Seen PolarCap::judge(const Cell& cell, const VisibilityConfig& config) const {
  const auto margin = static_cast<float>(config.margin);
  if (!isPoseUnsure(config)) return see(cell, limitFor(cell.far + margin), config);
  const float unsure = poseError(Eigen::Vector3f(cell.x, cell.y, cell.far).norm(), config);
  // The cell may be anywhere around where the pose puts it: all of that must be free.
  const Cell around{cell.x, cell.y, cell.half_width + unsure, cell.near - unsure,
                    cell.far + unsure};
  const Pixel limit = limitFor(around.far + margin);
  const bool free = inImage(around, config) && see(cell, limit, config) == Seen::kFree &&
                    see(around, limit, config) == Seen::kFree;
  return free ? Seen::kFree : Seen::kNot;
}

Bits PolarCap::seenFree(Bits candidates, Cell cell, float bottom, float res_h,
                        const VisibilityConfig& config, Bits& few) const {
  Bits free = 0;
  // From the farthest cell to the nearest one in the image.
  while (candidates != 0) {
    const int bit = up_ > 0.0F ? highestBitIndex(candidates) : lowestBitIndex(candidates);
    const Bits cell_bit = Bits{1} << bit;
    const float low = bottom + static_cast<float>(bit) * res_h;
    cell.near = up_ > 0.0F ? low : -low - res_h;
    cell.far = cell.near + res_h;
    if (!inImage(cell, config)) break;
    const Seen seen = judge(cell, config);
    if (seen == Seen::kFree) free |= cell_bit;
    if (seen == Seen::kByFewBeams) few |= cell_bit;
    candidates &= ~cell_bit;
  }
  return free;
}

void PolarCap::addSeenFree(const BitGrid& candidates, const HeightGrid& ground,
                           const PlacedScan& scan, const MatrixConfig& matrix,
                           const VisibilityConfig& config, BitGrid& seen_free, BitGrid* few) const {
  const ColumnWindow& window = candidates.window();
  const auto res_g = static_cast<float>(matrix.res_g), res_h = static_cast<float>(matrix.res_h);
  const auto from_sensor = [&](int column, float sensor) {
    return (static_cast<float>(column) + 0.5F) * res_g - sensor;
  };
  Cell cell{0.0F, 0.0F, 0.5F * res_g, 0.0F, 0.0F};
  for (int x = 0; x < window.size; ++x) {
    cell.x = from_sensor(window.corner.x - scan.anchor.x + x, scan.sensor.x());
    for (int y = 0; y < window.size; ++y) {
      const Bits judged = candidates.at(x, y) & ~seen_free.at(x, y);
      if (judged == 0) continue;
      cell.y = from_sensor(window.corner.y - scan.anchor.y + y, scan.sensor.y());
      if (std::hypot(cell.x, cell.y) > static_cast<float>(config.max_range)) continue;
      Bits by_few = 0;
      const float bottom = ground.at(x, y) - scan.sensor.z();
      const Bits free = seenFree(judged, cell, bottom, res_h, config, by_few);
      seen_free.at(x, y) |= free;
      if (few != nullptr) few->at(x, y) = (few->at(x, y) | by_few) & ~free;
    }
  }
}

}  // namespace beautymap
