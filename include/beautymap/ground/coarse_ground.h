// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "beautymap/config/config.h"
#include "beautymap/matrix/column_grid.h"
#include "beautymap/matrix/tile_map.h"

namespace beautymap {

/// Ground of one column.
struct GroundEstimate {
  float height = Tile::kNoHeight;  ///< g_ij [m]
  bool below_ground = false;       ///< the column's lowest point lies under l_min: an outlier
};

/// Coarse ground of one column (section "coarse ground"): its own lowest height, clamped to
/// median(L) -/+ mad_factor MAD(L), if enough neighbours hold points.
/// @param lowest      lowest height of the column [m]
/// @param neighbours  L, the lowest heights of the columns around it [m]; reordered here
/// @param possible    how many columns the neighbourhood has, with points or not
GroundEstimate coarseGroundOf(float lowest, std::vector<float>& neighbours, int possible,
                              const CoarseGroundConfig& config);

/// Half size of the square around a column that its ground is estimated from [columns].
int coarseGroundMargin(const CoarseGroundConfig& config);

/// The same for a column of a window of lowest heights that reaches coarseGroundMargin() farther.
/// Beyond the paper: where too few neighbours hold points, as far from the sensor, the lowest point
/// of a column may be any point of an object. Its ground lies no higher there than wide_quantile of
/// the lowest heights around it.
/// @param neighbours  memory that is used again
GroundEstimate coarseGroundAt(const HeightGrid& lowest, int x, int y,
                              std::vector<float>& neighbours, const CoarseGroundConfig& config);

/// Coarse ground of every column that has points; a symmetric neighbourhood, so the order is
/// irrelevant.
void estimateCoarseGround(TileMap& map, const CoarseGroundConfig& config);

}  // namespace beautymap
