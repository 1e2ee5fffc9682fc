// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/beam_visibility.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace beautymap {
namespace {

// Nearer columns span so much of the view that a beam image says little about them.
constexpr float kNearestColumn = 0.5F;  // [m]

/// How far a point that a scan measured at a range may be from where it was [m]: one standard
/// deviation of the scan's pose.
float poseError(float range, const VisibilityConfig& config) {
  const float position = static_cast<float>(config.pose_position);
  const float turned = range * static_cast<float>(config.pose_rotation * 3.14159265358979 / 180.0);
  return std::sqrt(position * position + turned * turned);
}

/// Where one column of the map stands in the beam image.
struct ColumnView {
  int first_azimuth;  ///< pixel, not yet wrapped
  int last_azimuth;
  BeamImage::Pixel behind;  ///< greater pixels have beams that passed the column
  float bottom_slope;       ///< of bit 0, in pixels
  float bit_slopes;         ///< height of a bit in pixels
  float more_slopes;        ///< around a cell [pixels]

  int firstSlope(int bit) const { return slopeOf(bit, -more_slopes); }
  int lastSlope(int bit) const { return slopeOf(bit + 1, more_slopes); }

 private:
  int slopeOf(int bit, float more) const {
    return floorToInt(bottom_slope + static_cast<float>(bit) * bit_slopes + more);
  }
};

ColumnView viewColumn(const BeamImage& beams, float x, float y, float distance, float bottom,
                      const MatrixConfig& matrix, float margin, float around = 0.0F) {
  const float res_g = static_cast<float>(matrix.res_g);
  const float per_metre = 1.0F / distance;
  // The directions to the ends of the column's width, seen from the sensor.
  const float half = (0.5F * res_g + around) * per_metre;
  const float first = beams.azimuthPixel(x + half * y, y - half * x);
  float last = beams.azimuthPixel(x - half * y, y + half * x);
  if (last < first) last += static_cast<float>(beams.azimuthPixels());
  const float bottom_slope = beams.slopePixel(bottom * per_metre);
  const float top_slope = beams.slopePixel((bottom + static_cast<float>(matrix.res_h)) * per_metre);
  return {floorToInt(first),
          floorToInt(last),
          BeamImage::limitFor(distance + 0.5F * res_g + margin),
          bottom_slope,
          top_slope - bottom_slope,
          beams.slopePixel(around * per_metre) - beams.slopePixel(0.0F)};
}

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

/// The beams in the azimuths of a column, summed by slope: those that passed it, and all of them.
class BeamSums {
 public:
  /// From one slope of the image to another.
  void sum(const BeamImage& beams, const ColumnView& view, int first_slope, int last_slope) {
    first_slope_ = first_slope;
    last_slope_ = last_slope;
    rows_.clear();
    for (int u = view.first_azimuth; u <= view.last_azimuth; ++u) {
      rows_.push_back(beams.row(wrapped(u, beams.azimuthPixels())) + first_slope -
                      beams.firstSlope());
    }
    const auto size = static_cast<std::size_t>(last_slope - first_slope) + 1;
    all_.resize(size + 2 * kLanes);
    passed_.resize(size + 2 * kLanes);
    const BeamImage::Pixel limit = view.behind;
    const Lanes behind = {limit, limit, limit, limit};
    for (std::size_t v = 0; v < size; v += 2 * kLanes) {
      Lanes all_low{}, all_high{}, passed_low{}, passed_high{};
      for (const BeamImage::Pixel* row : rows_) {
        add(row + v, behind, all_low, passed_low);
        add(row + v + kLanes, behind, all_high, passed_high);
      }
      store(all_low, &all_[v]);
      store(all_high, &all_[v + kLanes]);
      store(passed_low, &passed_[v]);
      store(passed_high, &passed_[v + kLanes]);
    }
  }

  bool seesFree(int first_slope, int last_slope, const VisibilityConfig& config) const {
    int all = 0, passed = 0;
    const int end = std::min(last_slope, last_slope_) - first_slope_;
    for (int v = std::max(first_slope, first_slope_) - first_slope_; v <= end; ++v) {
      all += all_[static_cast<std::size_t>(v)];
      passed += passed_[static_cast<std::size_t>(v)];
    }
    return passed >= config.min_beams && passed >= config.min_share * all;
  }

 private:
  /// As many pixels as every SIMD unit takes at once.
  static constexpr std::size_t kLanes = 4;
  using Lanes = BeamImage::Pixel __attribute__((vector_size(kLanes * sizeof(BeamImage::Pixel))));
  static_assert(2 * kLanes <= BeamImage::kPadding, "reads that far beyond a row");

  static void add(const BeamImage::Pixel* pixels, const Lanes& behind, Lanes& all, Lanes& passed) {
    Lanes lanes;
    std::memcpy(&lanes, pixels, sizeof(lanes));
    const Lanes counts = BeamImage::countOf(lanes);
    all += counts;
    passed += counts & (lanes > behind);  // a true lane has all bits set
  }
  static void store(const Lanes& lanes, BeamImage::Pixel* to) {
    std::memcpy(to, &lanes, sizeof(lanes));
  }

  int first_slope_ = 0;
  int last_slope_ = -1;
  std::vector<const BeamImage::Pixel*> rows_;
  std::vector<BeamImage::Pixel> all_;
  std::vector<BeamImage::Pixel> passed_;
};

Bits seenFree(Bits candidates, const BeamImage& beams, const ColumnView& view,
              const VisibilityConfig& config, BeamSums& sums) {
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
    if (sums.seesFree(view.firstSlope(bit), view.lastSlope(bit), config)) free |= lowestBit(rest);
  }
  return free;
}

}  // namespace

BeamImage::BeamImage(const VisibilityConfig& config)
    : azimuth_pixels_(static_cast<int>(std::ceil(360.0 / config.pixel_deg))) {
  // Four pixels of azimuth are as many as the diamond angle's range, so that all quadrants are
  // alike.
  azimuth_pixels_ = (azimuth_pixels_ + 3) / 4 * 4;
  slope_scale_ = static_cast<float>(1.0 / std::tan(config.pixel_deg * 3.14159265358979 / 180.0));
  slope_pixels_ = static_cast<int>((kMaxSlope - kMinSlope) * slope_scale_) + 1;
  farthest_.assign(static_cast<std::size_t>(azimuth_pixels_), 0);
  first_slope_ = slope_pixels_;
  last_slope_ = -1;
}

float BeamImage::azimuthPixel(float x, float y) const {
  // The diamond angle: 0 to 4 around the circle.
  const float t = y / (std::abs(x) + std::abs(y));
  const float diamond = x < 0.0F ? 2.0F - t : (t < 0.0F ? 4.0F + t : t);
  return diamond * 0.25F * static_cast<float>(azimuth_pixels_);
}

void BeamImage::fill(const PlacedScan& scan) {
  incoming_.clear();
  std::fill(farthest_.begin(), farthest_.end(), 0);
  first_slope_ = slope_pixels_;
  last_slope_ = -1;
  for (const Eigen::Vector3f& point : scan.points) {
    const Eigen::Vector3f ray = point - scan.sensor;
    const float distance = std::sqrt(ray.x() * ray.x() + ray.y() * ray.y());
    if (distance < kNearestColumn) continue;
    const int v = floorToInt(slopePixel(std::clamp(ray.z() / distance, -2.0F, 2.0F)));
    if (v < 0 || v >= slope_pixels_) continue;
    const int u = std::min(static_cast<int>(azimuthPixel(ray.x(), ray.y())), azimuth_pixels_ - 1);
    incoming_.push_back({static_cast<std::int16_t>(u), static_cast<std::int16_t>(v),
                         limitFor(distance) & ~kMaxCount});
    first_slope_ = std::min(first_slope_, v);
    last_slope_ = std::max(last_slope_, v);
  }
  // Most sensors use a small part of the slopes: the image is then small enough for the cache.
  const auto slopes = static_cast<std::size_t>(std::max(0, last_slope_ - first_slope_ + 1));
  pixels_.assign(static_cast<std::size_t>(azimuth_pixels_) * slopes + kPadding, kEmpty);
  for (const Beam& beam : incoming_) {
    const auto u = static_cast<std::size_t>(beam.azimuth);
    Pixel& pixel = pixels_[u * slopes + static_cast<std::size_t>(beam.slope - first_slope_)];
    pixel = std::min(pixel & ~kMaxCount, beam.end) | std::min(countOf(pixel) + 1, kMaxCount);
    farthest_[u] = std::max(farthest_[u], beam.end | 1);
  }
}

BitGrid cellsSeenFree(const BeamImage& beams, const BitGrid& candidates, const HeightGrid& ground,
                      const PlacedScan& scan, const MatrixConfig& matrix,
                      const VisibilityConfig& config) {
  const ColumnWindow& window = candidates.window();
  const float res_g = static_cast<float>(matrix.res_g);
  const float nearest = std::max(kNearestColumn + res_g, static_cast<float>(config.blind_radius));
  BitGrid seen_free(window, 0);
  BeamSums sums;
  for (int x = 0; x < window.size; ++x) {
    const float dx =
        (static_cast<float>(window.corner.x - scan.anchor.x + x) + 0.5F) * res_g - scan.sensor.x();
    for (int y = 0; y < window.size; ++y) {
      if (candidates.at(x, y) == 0) continue;
      const float dy = (static_cast<float>(window.corner.y - scan.anchor.y + y) + 0.5F) * res_g -
                       scan.sensor.y();
      const float distance = std::sqrt(dx * dx + dy * dy);
      if (distance < nearest || distance > static_cast<float>(config.max_range)) continue;
      const float bottom = ground.at(x, y) - scan.sensor.z();
      const float unsure = poseError(distance, config);
      const float margin = static_cast<float>(config.margin) + unsure;
      const ColumnView view = viewColumn(beams, dx, dy, distance, bottom, matrix, margin);
      const Bits judged = inImage(candidates.at(x, y), beams, view);
      if (judged == 0 || !anyBeamPassed(beams, view)) continue;
      Bits free = seenFree(judged, beams, view, config, sums);
      if (unsure > 0.0F) {
        // The cell may be anywhere around where the pose puts it: all of that must be free.
        free = seenFree(free, beams,
                        viewColumn(beams, dx, dy, distance, bottom, matrix, margin, unsure), config,
                        sums);
      }
      seen_free.at(x, y) = free;
    }
  }
  return seen_free;
}

}  // namespace beautymap
