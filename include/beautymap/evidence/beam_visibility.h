// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "beautymap/config/config.h"
#include "beautymap/evidence/beam_image.h"
#include "beautymap/matrix/column_grid.h"
#include "beautymap/matrix/scan.h"

namespace beautymap {

/// The candidates that the scan saw free: beams went through the cell's angular footprint, and
/// nearly all of those in it ended behind the cell. With a stated error of the pose the same must
/// hold for the cell with that margin around it, so that drift does not wear down walls: a margin
/// can only make fewer cells seen free.
/// @param recycled  an earlier result whose memory is used again
/// @param few       becomes the candidates that would be seen free if fewer beams were enough; none
///                  with a stated error of the pose
BitGrid cellsSeenFree(const BeamImage& beams, const BitGrid& candidates, const HeightGrid& ground,
                      const PlacedScan& scan, const MatrixConfig& matrix,
                      const VisibilityConfig& config, BitGrid recycled = {},
                      BitGrid* few = nullptr);

}  // namespace beautymap
