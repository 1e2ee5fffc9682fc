// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "beautymap/config/evidence_config.h"

namespace beautymap {

/// What the pixels of an image of beams hold. One pixel is one word, so that a point touches one
/// cache line: the nearest distance at which a beam ended [mm] above its lowest byte, which counts
/// the beams up to 255.
struct BeamPixels {
  using Pixel = std::int32_t;
  static constexpr int kCountBits = 8;
  static constexpr Pixel kMaxCount = (1 << kCountBits) - 1;
  static constexpr float kFarthest = 8000.0F;  // [m]
  static constexpr Pixel kEmpty = 0x7FFFFF00;  // farther than any beam, and none

  /// What is nearer [m] spans so much of the view that an image says little about it.
  static constexpr float kNearest = 0.5F;
  /// So many pixels more than it needs an image has, so that several can be read at once.
  static constexpr std::size_t kPadding = 8;

  static Pixel countOf(Pixel pixel) { return pixel & kMaxCount; }
  /// A pixel is greater than this if all its beams ended farther away.
  static Pixel limitFor(float distance_m) { return endAt(distance_m) | kMaxCount; }
  /// A beam without its count.
  static Pixel endAt(float distance_m) {
    return static_cast<Pixel>(std::min(distance_m, kFarthest) * 1000.0F) << kCountBits;
  }
  static void addBeam(Pixel& pixel, Pixel end) {
    pixel = std::min(pixel & ~kMaxCount, end) | std::min(countOf(pixel) + 1, kMaxCount);
  }
};

/// What a scan says about a cell that it did not hit.
enum class Seen : std::uint8_t { kNot, kByFewBeams, kFree };

/// @param all     beams in the cell's footprint
/// @param passed  those of them that ended behind it
inline Seen seenBy(int passed, int all, const VisibilityConfig& config) {
  if (passed == 0 || passed < config.min_share * all) return Seen::kNot;
  return passed < config.min_beams ? Seen::kByFewBeams : Seen::kFree;
}

inline bool isPoseUnsure(const VisibilityConfig& config) {
  return config.pose_position > 0.0 || config.pose_rotation > 0.0;
}

/// How far a point that a scan measured at a range may be from where it was [m]: one standard
/// deviation of the scan's pose.
inline float poseError(float range, const VisibilityConfig& config) {
  const auto position = static_cast<float>(config.pose_position);
  const auto turned = range * static_cast<float>(config.pose_rotation * (M_PI / 180.0));
  return std::sqrt(position * position + turned * turned);
}

}  // namespace beautymap
