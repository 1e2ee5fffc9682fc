// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/evidence/beam_visibility.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include "../base/vector_clones.h"
#include "pixel_lanes.h"

namespace beautymap {
namespace {

/// Where one column of the map stands in the beam image.
struct ColumnView {
  int first_azimuth;  ///< pixel, not yet wrapped
  int last_azimuth;
  BeamImage::Pixel behind;  ///< greater pixels have beams that passed the column
  float bottom_slope;       ///< of bit 0, in pixels
  float bit_slopes;         ///< height of a bit in pixels
  float more_slopes;        ///< margin below and above a cell in pixels

  int firstSlope(int bit) const { return slopeOf(bit, -more_slopes); }
  int lastSlope(int bit) const { return slopeOf(bit + 1, more_slopes); }

 private:
  int slopeOf(int bit, float more) const {
    return floorToInt(bottom_slope + static_cast<float>(bit) * bit_slopes + more);
  }
};

/// Some columns of one row of the window. One array per quantity, of a fixed size: the compiler
/// then views several columns at a time.
class ColumnViews {
 public:
  bool full() const { return size_ == kCapacity; }
  void clear() { size_ = 0; }
  /// @param y       index in the row
  /// @param y_m     of the column's centre, seen from the sensor [m]
  /// @param bottom  of its bit 0, from the sensor's height [m]
  void add(int y, float y_m, float bottom) {
    y_[size_] = y;
    y_m_[size_] = y_m;
    bottom_[size_] = bottom;
    ++size_;
  }
  /// @param x_m  of the row, seen from the sensor [m]
  BEAUTYMAP_VECTOR_CLONES
  void view(PixelScale scale, float x_m, const MatrixConfig& matrix) {
    const auto half_width = 0.5F * static_cast<float>(matrix.res_g);
    const auto res_h = static_cast<float>(matrix.res_h);
    for (std::size_t i = 0; i < size_; ++i) {
      const float y_m = y_m_[i];
      const float distance = std::sqrt(x_m * x_m + y_m * y_m);
      const float per_metre = 1.0F / distance;
      // The directions to the ends of the column's width, seen from the sensor.
      const float half = half_width * per_metre;
      first_[i] = scale.azimuthPixel(x_m + half * y_m, y_m - half * x_m);
      last_[i] = scale.azimuthPixel(x_m - half * y_m, y_m + half * x_m);
      bottom_slope_[i] = scale.slopePixel(bottom_[i] * per_metre);
      top_slope_[i] = scale.slopePixel((bottom_[i] + res_h) * per_metre);
      distance_[i] = distance;
    }
  }

  std::size_t size() const { return size_; }
  int y(std::size_t i) const { return y_[i]; }
  float distance(std::size_t i) const { return distance_[i]; }
  /// @param behind_m  what ends so far behind the column's centre has passed it [m]
  ColumnView at(std::size_t i, const BeamImage& beams, float behind_m) const {
    return widerAt(i, beams, behind_m, 0.0F);
  }
  /// The same with a margin around each cell of the column.
  /// @param around_m  [m]
  ColumnView at(std::size_t i, const BeamImage& beams, float behind_m, float around_m,
                const MatrixConfig& matrix) const {
    const float width = last_[i] + turn(i, beams) - first_[i];
    const float wider = width * around_m / static_cast<float>(matrix.res_g);
    const float quarter = 0.25F * static_cast<float>(beams.azimuthPixels());
    ColumnView view = widerAt(i, beams, behind_m, std::min(quarter, wider));
    view.more_slopes = view.bit_slopes * around_m / static_cast<float>(matrix.res_h);
    return view;
  }

 private:
  /// What is to be added to the last azimuth of a column that lies across the first pixel.
  float turn(std::size_t i, const BeamImage& beams) const {
    return last_[i] < first_[i] ? static_cast<float>(beams.azimuthPixels()) : 0.0F;
  }
  ColumnView widerAt(std::size_t i, const BeamImage& beams, float behind_m, float pixels) const {
    return {floorToInt(first_[i] - pixels),
            floorToInt(last_[i] + turn(i, beams) + pixels),
            BeamImage::limitFor(distance_[i] + behind_m),
            bottom_slope_[i],
            top_slope_[i] - bottom_slope_[i],
            0.0F};
  }

  static constexpr std::size_t kCapacity = 64;
  template <typename T>
  using Values = std::array<T, kCapacity>;

  std::size_t size_ = 0;
  Values<int> y_;
  Values<float> y_m_, bottom_, distance_, first_, last_, bottom_slope_, top_slope_;
};

int wrapped(int azimuth, int pixels) {
  return azimuth < 0 ? azimuth + pixels : azimuth >= pixels ? azimuth - pixels : azimuth;
}

bool anyBeamPassed(const BeamImage& beams, const ColumnView& view) {
  for (int u = view.first_azimuth; u <= view.last_azimuth; ++u) {
    if (beams.farthest(wrapped(u, beams.azimuthPixels())) > view.behind) return true;
  }
  return false;
}

/// The candidates of a column whose slopes the image has beams of.
Bits inImage(Bits candidates, const BeamImage& beams, const ColumnView& view) {
  const float lowest =
      (static_cast<float>(beams.firstSlope()) - view.bottom_slope) / view.bit_slopes;
  const float end =
      (static_cast<float>(beams.lastSlope() + 1) - view.bottom_slope) / view.bit_slopes;
  constexpr auto kEnd = static_cast<float>(kMaxBits);
  // One bit more to each side: what rounding adds has no beams and is not seen free anyway.
  const int first = static_cast<int>(std::clamp(lowest - 1.0F, 0.0F, kEnd));
  const int last = static_cast<int>(std::clamp(end + 1.0F, 0.0F, kEnd));
  return candidates & lowBits(last) & ~lowBits(first);
}

/// The sums over rows of pixels: of all beams, and of those that passed.
/// @param all, passed  have room for kLanes more
BEAUTYMAP_VECTOR_CLONES
void sumRows(const std::vector<const BeamImage::Pixel*>& rows, std::size_t size,
             BeamImage::Pixel behind, BeamImage::Pixel* all, BeamImage::Pixel* passed) {
  for (std::size_t v = 0; v < size; v += kLanes) {
    Lanes all_lanes{}, passed_lanes{};
    for (const BeamImage::Pixel* row : rows) {
      Lanes lanes;
      std::memcpy(&lanes, row + v, sizeof(lanes));
      const Lanes counts = lanes & BeamImage::kMaxCount;
      all_lanes += counts;
      passed_lanes += counts & (lanes > behind);
    }
    std::memcpy(all + v, &all_lanes, sizeof(all_lanes));
    std::memcpy(passed + v, &passed_lanes, sizeof(passed_lanes));
  }
}

/// The beams in the azimuths of a column, summed by slope: those that passed it, and all of them.
class BeamSums {
 public:
  /// From one slope of the image to another.
  void sum(const BeamImage& beams, const ColumnView& view, int first_slope, int last_slope) {
    first_slope_ = first_slope;
    last_slope_ = last_slope;
    rows_.resize(static_cast<std::size_t>(view.last_azimuth - view.first_azimuth) + 1);
    int azimuth = wrapped(view.first_azimuth, beams.azimuthPixels());
    for (const BeamImage::Pixel*& row : rows_) {
      row = beams.row(azimuth) + first_slope - beams.firstSlope();
      if (++azimuth == beams.azimuthPixels()) azimuth = 0;
    }
    const auto size = static_cast<std::size_t>(last_slope - first_slope) + 1;
    // up_to[v] counts the slopes below v.
    all_up_to_.resize(size + kLanes + 1);
    passed_up_to_.resize(size + kLanes + 1);
    sumRows(rows_, size, view.behind, &all_up_to_[1], &passed_up_to_[1]);
    std::int32_t all = 0, passed = 0;
    all_up_to_[0] = passed_up_to_[0] = 0;
    for (std::size_t v = 1; v <= size; ++v) {
      all_up_to_[v] = all += all_up_to_[v];
      passed_up_to_[v] = passed += passed_up_to_[v];
    }
  }

  Seen see(int first_slope, int last_slope, const VisibilityConfig& config) const {
    const int begin = std::max(first_slope, first_slope_) - first_slope_;
    const int end = std::min(last_slope, last_slope_) - first_slope_ + 1;
    if (begin >= end) return Seen::kNot;
    const auto from = static_cast<std::size_t>(begin), to = static_cast<std::size_t>(end);
    const int all = all_up_to_[to] - all_up_to_[from];
    const int passed = passed_up_to_[to] - passed_up_to_[from];
    return seenBy(passed, all, config);
  }

 private:
  int first_slope_ = 0;
  int last_slope_ = -1;
  std::vector<const BeamImage::Pixel*> rows_;
  std::vector<BeamImage::Pixel> all_up_to_, passed_up_to_;
};

/// @param few  becomes the candidates that would be free if fewer beams were enough
Bits seenFree(Bits candidates, const BeamImage& beams, const ColumnView& view,
              const VisibilityConfig& config, BeamSums& sums, Bits& few) {
  few = 0;
  // Cells that reach out of the image's slopes are not judged.
  while (candidates != 0 && view.firstSlope(lowestBitIndex(candidates)) < 0) {
    candidates &= candidates - 1;
  }
  while (candidates != 0 && view.lastSlope(highestBitIndex(candidates)) >= beams.slopePixels()) {
    candidates &= ~(Bits{1} << highestBitIndex(candidates));
  }
  if (candidates == 0) return 0;
  const int first_slope = std::max(view.firstSlope(lowestBitIndex(candidates)), beams.firstSlope());
  const int last_slope = std::min(view.lastSlope(highestBitIndex(candidates)), beams.lastSlope());
  if (first_slope > last_slope) return 0;
  sums.sum(beams, view, first_slope, last_slope);
  Bits free = 0;
  for (Bits rest = candidates; rest != 0; rest &= rest - 1) {
    const int bit = lowestBitIndex(rest);
    const Seen seen = sums.see(view.firstSlope(bit), view.lastSlope(bit), config);
    if (seen == Seen::kFree) free |= lowestBit(rest);
    if (seen == Seen::kByFewBeams) few |= lowestBit(rest);
  }
  return free;
}

}  // namespace

BitGrid cellsSeenFree(const BeamImage& beams, const BitGrid& candidates, const HeightGrid& ground,
                      const PlacedScan& scan, const MatrixConfig& matrix,
                      const VisibilityConfig& config, BitGrid recycled, BitGrid* few) {
  const ColumnWindow& window = candidates.window();
  const float res_g = static_cast<float>(matrix.res_g);
  const float nearest =
      std::max(BeamImage::kNearest + res_g, static_cast<float>(config.blind_radius));
  BitGrid seen_free = std::move(recycled);
  seen_free.reset(window, 0);
  if (few != nullptr) few->reset(window, 0);
  const float margin = 0.5F * res_g + static_cast<float>(config.margin);
  const bool pose_is_unsure = isPoseUnsure(config);
  ColumnViews views;
  BeamSums sums;
  const auto from_sensor = [&](int column, float sensor) {
    return (static_cast<float>(column) + 0.5F) * res_g - sensor;
  };
  const auto judge = [&](int x) {
    views.view(beams.scale(), from_sensor(window.corner.x - scan.anchor.x + x, scan.sensor.x()),
               matrix);
    for (std::size_t i = 0; i < views.size(); ++i) {
      const float distance = views.distance(i);
      if (distance < nearest || distance > static_cast<float>(config.max_range)) continue;
      const float unsure = pose_is_unsure ? poseError(distance, config) : 0.0F;
      const ColumnView view = views.at(i, beams, margin + unsure);
      const Bits judged = inImage(candidates.at(x, views.y(i)), beams, view);
      if (judged == 0 || !anyBeamPassed(beams, view)) continue;
      Bits by_few = 0;
      Bits free = seenFree(judged, beams, view, config, sums, by_few);
      if (free != 0 && pose_is_unsure) {
        // The cell may be anywhere around where the pose puts it: all of that must be free.
        const ColumnView around = views.at(i, beams, margin + unsure, unsure, matrix);
        free = seenFree(free, beams, around, config, sums, by_few);
      }
      seen_free.at(x, views.y(i)) = free;
      if (few != nullptr && !pose_is_unsure) few->at(x, views.y(i)) = by_few;
    }
    views.clear();
  };
  for (int x = 0; x < window.size; ++x) {
    for (int y = 0; y < window.size; ++y) {
      if (candidates.at(x, y) == 0) continue;
      views.add(y, from_sensor(window.corner.y - scan.anchor.y + y, scan.sensor.y()),
                ground.at(x, y) - scan.sensor.z());
      if (views.full()) judge(x);
    }
    judge(x);
  }
  for (const PolarCap& cap : beams.caps()) {
    if (!cap.empty()) cap.addSeenFree(candidates, ground, scan, matrix, config, seen_free, few);
  }
  return seen_free;
}

}  // namespace beautymap
