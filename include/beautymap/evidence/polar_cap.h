// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "beautymap/config/config.h"
#include "beautymap/evidence/beam_pixels.h"
#include "beautymap/matrix/column_grid.h"
#include "beautymap/matrix/scan.h"

namespace beautymap {

/// The steep beams of one scan, those upwards or those downwards, by where they meet a level plane
/// one metre above or below the sensor, up to a metre to each side: how many returned from each
/// pixel of that plane, and the nearest return by its height above or below the sensor.
class PolarCap : public BeamPixels {
 public:
  enum class Side : std::uint8_t { kBelow, kAbove };

  PolarCap(Side side, const VisibilityConfig& config);

  /// Replaces the contents by the beams of a scan.
  void fill(const PlacedScan& scan);
  void clear() { beams_.clear(); }
  bool empty() const { return beams_.empty(); }

  /// Adds the candidates that these beams saw free, by the rules of cellsSeenFree(): a cell's
  /// footprint is the rectangle around its eight corners, and beams passed it that ended behind its
  /// far face. Cells that reach out of the image are not judged.
  /// @param few  if given: becomes what fewer beams than enough saw free, and was not seen free
  void addSeenFree(const BitGrid& candidates, const HeightGrid& ground, const PlacedScan& scan,
                   const MatrixConfig& matrix, const VisibilityConfig& config, BitGrid& seen_free,
                   BitGrid* few) const;

 private:
  /// A cell seen from the sensor [m].
  struct Cell {
    float x, y;        ///< of its centre
    float half_width;  ///< of its horizontal sides
    float near, far;   ///< distances of its level faces
  };
  struct Beam {
    int u, v;  ///< pixels
    Pixel end;
  };

  static bool inImage(const Cell& cell, const VisibilityConfig& config);
  int pixelOf(float tangent) const { return floorToInt((tangent + 1.0F) * pixels_per_tangent_); }
  /// @param limit  greater pixels have beams that passed the cell
  Seen see(const Cell& cell, Pixel limit, const VisibilityConfig& config) const;
  Seen judge(const Cell& cell, const VisibilityConfig& config) const;
  /// The candidates of one column that are seen free.
  /// @param cell    the column; its near and far are found for each bit
  /// @param bottom  of its bit 0, from the sensor's height [m]
  Bits seenFree(Bits candidates, Cell cell, float bottom, float res_h,
                const VisibilityConfig& config, Bits& few) const;

  float up_;
  float pixels_per_tangent_;
  int first_u_ = 0, last_u_ = -1, first_v_ = 0, last_v_ = -1;  ///< of all beams
  std::vector<Beam> beams_;
  std::vector<Pixel> pixels_;  ///< only between the first and the last ones
};

}  // namespace beautymap
