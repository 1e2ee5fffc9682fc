// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "beautymap/column_grid.h"
#include "beautymap/config.h"
#include "beautymap/scan.h"

namespace beautymap {

/// The beams of one scan by direction: how many returned from each pixel of azimuth and slope
/// (height over horizontal distance), and the nearest return. Made from the points alone;
/// directions without a return are unknown.
class BeamImage {
 public:
  /// One pixel in one word, so that a point touches one cache line: the nearest horizontal distance
  /// at which a beam ended [mm] above its lowest byte, which counts the beams up to 255.
  using Pixel = std::int32_t;
  template <typename Pixels>
  static Pixels countOf(Pixels pixels) {
    return pixels & kMaxCount;
  }
  /// A pixel is greater than this if all its beams ended farther away.
  static Pixel limitFor(float distance_m) {
    return static_cast<Pixel>(std::min(distance_m, kFarthest) * 1000.0F) << kCountBits | kMaxCount;
  }

  explicit BeamImage(const VisibilityConfig& config);

  /// Replaces the contents by the beams of a scan.
  void fill(const PlacedScan& scan);

  /// Azimuth of a direction in pixels. Not an angle but a monotonic function of it without
  /// trigonometry.
  float azimuthPixel(float x, float y) const;
  float slopePixel(float slope) const { return (slope - kMinSlope) * slope_scale_; }
  /// Its inverse.
  float slopeAt(float pixel) const { return pixel / slope_scale_ + kMinSlope; }
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
  static constexpr std::size_t kPadding = 8;
  /// The farthest beam of one azimuth, as a pixel.
  Pixel farthest(int azimuth) const { return farthest_[static_cast<std::size_t>(azimuth)]; }

 private:
  static constexpr int kCountBits = 8;
  static constexpr Pixel kMaxCount = (1 << kCountBits) - 1;
  static constexpr float kFarthest = 8000.0F;  // [m]
  static constexpr Pixel kEmpty = 0x7FFFFF00;  // farther than any beam, and none
  static constexpr float kMinSlope = -1.5F;
  static constexpr float kMaxSlope = 1.5F;

  int azimuth_pixels_;
  int slope_pixels_;
  float slope_scale_;
  int first_slope_;
  int last_slope_;
  std::vector<Pixel> pixels_;
  std::vector<Pixel> farthest_;

  /// A beam on its way into the image.
  struct Beam {
    std::int16_t azimuth;
    std::int16_t slope;
    Pixel end;
  };
  std::vector<Beam> incoming_;
};

/// The candidates that the scan saw free: beams went through the cell's angular footprint, and
/// nearly all of those in it ended behind the cell. With a stated error of the pose the same must
/// hold for the cell with that margin around it, so that drift does not wear down walls: a margin
/// can only make fewer cells seen free.
BitGrid cellsSeenFree(const BeamImage& beams, const BitGrid& candidates, const HeightGrid& ground,
                      const PlacedScan& scan, const MatrixConfig& matrix,
                      const VisibilityConfig& config);

}  // namespace beautymap
