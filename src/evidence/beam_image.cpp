// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/evidence/beam_image.h"

#include <array>
#include <cmath>

#include "../base/vector_clones.h"
#include "beautymap/matrix/column_grid.h"

namespace beautymap {
namespace {

constexpr double kRadPerDeg = M_PI / 180.0;

/// Finds the pixels of a block of points.
struct DirectionBlock {
  static constexpr std::size_t kSize = 256;

  PixelScale scale;
  int azimuth_pixels, slope_pixels;
  int first_slope, last_slope;  ///< of all blocks
  Eigen::Vector3f sensor;

  void find(const float* x, const float* y, const float* z, std::size_t size,
            std::int32_t* azimuths, std::int32_t* slopes, std::int32_t* ends);
};

BEAUTYMAP_VECTOR_CLONES
void DirectionBlock::find(const float* x, const float* y, const float* z, std::size_t size,
                          std::int32_t* azimuths, std::int32_t* slopes, std::int32_t* ends) {
  const PixelScale to_pixels = scale;
  const float sx = sensor.x(), sy = sensor.y(), sz = sensor.z();
  // Rounding may end at the whole circle.
  const auto last_azimuth = static_cast<float>(azimuth_pixels - 1);
  const int slope_end = slope_pixels;
  int first = first_slope, last = last_slope;
  // Short loops without branches: the compiler takes several points at a time.
  std::array<float, kSize> distance, azimuth, slope;
  for (std::size_t i = 0; i < size; ++i) {
    const float dx = x[i] - sx, dy = y[i] - sy;
    distance[i] = std::sqrt(dx * dx + dy * dy);
    azimuth[i] = to_pixels.azimuthPixel(dx, dy);
    // NaN straight above the sensor.
    const float pixel = to_pixels.slopePixel((z[i] - sz) / distance[i]);
    slope[i] = distance[i] < BeamImage::kNearest ? -1.0F : pixel;
  }
  for (std::size_t i = 0; i < size; ++i) {
    ends[i] = BeamImage::endAt(distance[i]);
    // The order of the arguments makes NaN the lower limit.
    azimuths[i] = static_cast<std::int32_t>(std::max(0.0F, std::min(azimuth[i], last_azimuth)));
    const int pixel =
        floorToInt(std::max(-1.0F, std::min(slope[i], static_cast<float>(slope_end))));
    slopes[i] = pixel < slope_end ? pixel : BeamImage::kOutside;
  }
  for (std::size_t i = 0; i < size; ++i) {
    first = std::min(first, slopes[i] < 0 ? slope_end : slopes[i]);
    last = std::max(last, slopes[i]);
  }
  first_slope = first;
  last_slope = last;
}

}  // namespace

BeamImage::BeamImage(const VisibilityConfig& config)
    : azimuth_pixels_(static_cast<int>(std::ceil(360.0 / config.pixel_deg))),
      caps_{PolarCap(PolarCap::Side::kBelow, config), PolarCap(PolarCap::Side::kAbove, config)} {
  // Four pixels of azimuth are as many as the diamond angle's range, so that all quadrants are
  // alike.
  azimuth_pixels_ = (azimuth_pixels_ + 3) / 4 * 4;
  scale_ = {static_cast<float>(azimuth_pixels_),
            static_cast<float>(1.0 / std::tan(config.pixel_deg * kRadPerDeg))};
  slope_pixels_ = static_cast<int>(scale_.slopePixel(PixelScale::kMaxSlope)) + 1;
  farthest_.assign(static_cast<std::size_t>(azimuth_pixels_), 0);
  first_slope_ = slope_pixels_;
  last_slope_ = -1;
}

void BeamImage::findDirections(const PlacedScan& scan) {
  for (std::vector<std::int32_t>* values : {&azimuths_, &slopes_, &ends_}) {
    values->resize(scan.size());
  }
  DirectionBlock block{scale_,        azimuth_pixels_, slope_pixels_,
                       slope_pixels_, kOutside,        scan.sensor};
  for (std::size_t begin = 0; begin < scan.size(); begin += DirectionBlock::kSize) {
    const std::size_t size = std::min(DirectionBlock::kSize, scan.size() - begin);
    block.find(&scan.x[begin], &scan.y[begin], &scan.z[begin], size, &azimuths_[begin],
               &slopes_[begin], &ends_[begin]);
  }
  first_slope_ = block.first_slope;
  last_slope_ = block.last_slope;
}

void BeamImage::fill(const PlacedScan& scan) {
  findDirections(scan);
  // Most sensors use a small part of the slopes: the image is then small enough for the cache.
  const auto slopes = static_cast<std::size_t>(std::max(0, last_slope_ - first_slope_ + 1));
  const auto azimuths = static_cast<std::size_t>(azimuth_pixels_);
  pixels_.assign(azimuths * slopes + kPadding, kEmpty);
  farthest_.assign(azimuths, 0);
  bool any_outside = false;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (slopes_[i] == kOutside) {
      any_outside = true;
      continue;
    }
    const auto u = static_cast<std::size_t>(azimuths_[i]);
    const auto v = static_cast<std::size_t>(slopes_[i] - first_slope_);
    addBeam(pixels_[u * slopes + v], ends_[i]);
    Pixel& farthest = farthest_[u];
    farthest = std::max(farthest, ends_[i] | 1);
  }
  for (PolarCap& cap : caps_) {
    if (any_outside) {
      cap.fill(scan);
    } else {
      cap.clear();
    }
  }
}

}  // namespace beautymap
