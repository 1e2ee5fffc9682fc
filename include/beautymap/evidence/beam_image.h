// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "beautymap/config/evidence_config.h"
#include "beautymap/evidence/beam_pixels.h"
#include "beautymap/evidence/polar_cap.h"
#include "beautymap/matrix/scan.h"

namespace beautymap {

/// Where directions lie in a BeamImage. A small value, to be copied before a loop over many of
/// them: the compiler then need not expect that the loop's results change it.
struct PixelScale {
  static constexpr float kMinSlope = -1.5F;
  static constexpr float kMaxSlope = 1.5F;

  float pixels_per_turn;
  float pixels_per_slope;

  /// Azimuth of a direction in pixels. Not an angle but a monotonic function of it without
  /// trigonometry.
  float azimuthPixel(float x, float y) const {
    // The diamond angle: 0 to 4 around the circle.
    const float t = y / (std::abs(x) + std::abs(y));
    // Chosen constants, not chosen expressions: that is vectorized.
    const float right = t < 0.0F ? 4.0F : 0.0F;
    const float turn = x < 0.0F ? 2.0F : right;
    const float sign = x < 0.0F ? -1.0F : 1.0F;
    const float diamond = turn + sign * t;
    return diamond * 0.25F * pixels_per_turn;
  }
  float slopePixel(float slope) const { return (slope - kMinSlope) * pixels_per_slope; }
};

/// The beams of one scan by direction: how many returned from each pixel of azimuth and slope
/// (height over horizontal distance), and the nearest return. Made from the points alone;
/// directions without a return are unknown. Steeper beams are in two caps.
class BeamImage : public BeamPixels {
 public:
  /// In place of a slope's pixel: a beam too near or too steep for the image.
  static constexpr std::int32_t kOutside = -1;

  explicit BeamImage(const VisibilityConfig& config);

  /// Replaces the contents by the beams of a scan.
  void fill(const PlacedScan& scan);

  PixelScale scale() const { return scale_; }
  int azimuthPixels() const { return azimuth_pixels_; }
  int slopePixels() const { return slope_pixels_; }

  /// The lowest and highest pixel of slope that any beam has; first > last without beams. The image
  /// is only stored between them.
  int firstSlope() const { return first_slope_; }
  int lastSlope() const { return last_slope_; }
  /// The pixels of one azimuth from firstSlope() on. Reading up to kPadding more is harmless.
  const Pixel* row(int azimuth) const {
    return pixels_.data() + static_cast<std::ptrdiff_t>(azimuth) * (last_slope_ - first_slope_ + 1);
  }
  /// The farthest beam of one azimuth, as a pixel.
  Pixel farthest(int azimuth) const { return farthest_[static_cast<std::size_t>(azimuth)]; }

  /// The beams below and above; empty where none is too steep for the image.
  const std::array<PolarCap, 2>& caps() const { return caps_; }

 private:
  int azimuth_pixels_;
  int slope_pixels_;
  PixelScale scale_;
  int first_slope_;
  int last_slope_;
  std::vector<Pixel> pixels_;
  std::vector<Pixel> farthest_;
  std::array<PolarCap, 2> caps_;

  /// Fills the three arrays below and the range of slopes.
  void findDirections(const PlacedScan& scan);

  // Of each point of the scan, on its way into the image.
  std::vector<std::int32_t> azimuths_, slopes_, ends_;
};

}  // namespace beautymap
