// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/beam_visibility.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace beautymap {
namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();
// Nearer columns span so much of the view that a beam image says little about them.
constexpr float kNearestColumn = 0.5F;  // [m]

/// Where one column of the map stands in the beam image.
struct ColumnView {
  float distance;     ///< horizontal, of its centre [m]
  int first_azimuth;  ///< pixel, not yet wrapped
  int last_azimuth;
};

/// The beams in a rectangle of pixels that passed beyond a distance, and all of them.
struct BeamCount {
  int passed = 0;
  int all = 0;
};

BeamCount countBeams(const BeamImage& beams, const ColumnView& view, int first_slope,
                     int last_slope, float behind) {
  BeamCount count;
  for (int u = view.first_azimuth; u <= view.last_azimuth; ++u) {
    const int azimuth = u < 0                        ? u + beams.azimuthPixels()
                        : u >= beams.azimuthPixels() ? u - beams.azimuthPixels()
                                                     : u;
    const std::uint16_t* counts = beams.counts(azimuth);
    const float* nearest = beams.nearest(azimuth);
    for (int v = first_slope; v <= last_slope; ++v) {
      count.all += counts[v];
      count.passed += nearest[v] > behind ? counts[v] : 0;
    }
  }
  return count;
}

ColumnView viewColumn(const BeamImage& beams, float x, float y, float distance, float res_g) {
  // The directions to the ends of the column's width, seen from the sensor.
  const float half = 0.5F * res_g / distance;
  const float first = beams.azimuthPixel(x + half * y, y - half * x);
  float last = beams.azimuthPixel(x - half * y, y + half * x);
  if (last < first) last += static_cast<float>(beams.azimuthPixels());
  return {distance, floorToInt(first), floorToInt(last)};
}

}  // namespace

BeamImage::BeamImage(const VisibilityConfig& config)
    : azimuth_pixels_(static_cast<int>(std::ceil(360.0 / config.pixel_deg))) {
  // Four pixels of azimuth are as many as the diamond angle's range, so that all quadrants are
  // alike.
  azimuth_pixels_ = (azimuth_pixels_ + 3) / 4 * 4;
  slope_scale_ = static_cast<float>(1.0 / std::tan(config.pixel_deg * 3.14159265358979 / 180.0));
  slope_pixels_ = static_cast<int>((kMaxSlope - kMinSlope) * slope_scale_) + 1;
  const auto pixels =
      static_cast<std::size_t>(azimuth_pixels_) * static_cast<std::size_t>(slope_pixels_);
  counts_.assign(pixels, 0);
  nearest_.assign(pixels, kNothing);
}

float BeamImage::azimuthPixel(float x, float y) const {
  // The diamond angle: 0 to 4 around the circle.
  const float t = y / (std::abs(x) + std::abs(y));
  const float diamond = x < 0.0F ? 2.0F - t : (t < 0.0F ? 4.0F + t : t);
  return diamond * 0.25F * static_cast<float>(azimuth_pixels_);
}

void BeamImage::fill(const PlacedScan& scan) {
  for (const std::uint32_t pixel : used_) {
    counts_[pixel] = 0;
    nearest_[pixel] = kNothing;
  }
  used_.clear();
  for (const Eigen::Vector3f& point : scan.points) {
    const Eigen::Vector3f ray = point - scan.sensor;
    const float distance = std::sqrt(ray.x() * ray.x() + ray.y() * ray.y());
    if (distance < kNearestColumn) continue;
    const int v = floorToInt(slopePixel(std::clamp(ray.z() / distance, -2.0F, 2.0F)));
    if (v < 0 || v >= slope_pixels_) continue;
    const int u = std::min(static_cast<int>(azimuthPixel(ray.x(), ray.y())), azimuth_pixels_ - 1);
    const auto pixel = static_cast<std::uint32_t>(u * slope_pixels_ + v);
    if (counts_[pixel] == 0) used_.push_back(pixel);
    if (counts_[pixel] < std::numeric_limits<std::uint16_t>::max()) ++counts_[pixel];
    nearest_[pixel] = std::min(nearest_[pixel], distance);
  }
}

BitGrid cellsSeenFree(const BeamImage& beams, const BitGrid& candidates, const HeightGrid& ground,
                      const PlacedScan& scan, const MatrixConfig& matrix,
                      const VisibilityConfig& config) {
  const ColumnWindow& window = candidates.window();
  const float res_g = static_cast<float>(matrix.res_g);
  const float res_h = static_cast<float>(matrix.res_h);
  const float nearest = std::max(kNearestColumn + res_g, static_cast<float>(config.blind_radius));
  BitGrid seen_free(window, 0);
  for (int x = 0; x < window.size; ++x) {
    const float dx =
        (static_cast<float>(window.corner.x - scan.anchor.x + x) + 0.5F) * res_g - scan.sensor.x();
    for (int y = 0; y < window.size; ++y) {
      if (candidates.at(x, y) == 0) continue;
      const float dy = (static_cast<float>(window.corner.y - scan.anchor.y + y) + 0.5F) * res_g -
                       scan.sensor.y();
      const float distance = std::sqrt(dx * dx + dy * dy);
      if (distance < nearest || distance > static_cast<float>(config.max_range)) continue;
      const ColumnView view = viewColumn(beams, dx, dy, distance, res_g);
      const float behind = distance + 0.5F * res_g + static_cast<float>(config.margin);
      const float base = ground.at(x, y) - scan.sensor.z();
      for (Bits rest = candidates.at(x, y); rest != 0; rest &= rest - 1) {
        const int bit = lowestBitIndex(rest);
        const float bottom = base + static_cast<float>(bit) * res_h;
        const int first = floorToInt(beams.slopePixel(bottom / distance));
        const int last = floorToInt(beams.slopePixel((bottom + res_h) / distance));
        if (first < 0 || last >= beams.slopePixels()) continue;
        const BeamCount count = countBeams(beams, view, first, last, behind);
        if (count.passed >= config.min_beams && count.passed >= config.min_share * count.all) {
          seen_free.at(x, y) |= lowestBit(rest);
        }
      }
    }
  }
  return seen_free;
}

}  // namespace beautymap
