// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "beautymap/config/config.h"
#include "beautymap/matrix/scan.h"
#include "beautymap/matrix/tile_map.h"

namespace beautymap {

/// Beyond the paper: errors of single poses in height, roll and pitch make the ground as thick as
/// an object is high. A scan whose ground does not lie where that of the other scans does is tilted
/// and raised until it does; only what is judged moves so, never the points that are written.

/// How the heights of one scan change: a plane over the columns, counted from the scan's anchor.
struct Levelling {
  float height = 0.0F;  ///< at the anchor [m]
  float per_x = 0.0F;   ///< [m per column]
  float per_y = 0.0F;   ///< [m per column]

  bool isNone() const { return height == 0.0F && per_x == 0.0F && per_y == 0.0F; }
  float at(std::int32_t x, std::int32_t y) const {
    return height + per_x * static_cast<float>(x) + per_y * static_cast<float>(y);
  }
};

/// A column relative to the scan's anchor, and the lowest of the scan's points in it [m].
struct ColumnLow {
  std::int32_t x, y;
  float z;
};

/// Of all columns no farther from the sensor's than `radius`, in x and in y.
std::vector<ColumnLow> lowestOfColumns(const PlacedScan& scan, int radius);

/// Adds a scan, as it was posed, to the columns' mean lowest heights (Tile::level).
/// @param anchor  of the scan
void addLevels(TileMap& map, ColumnIndex anchor, const std::vector<ColumnLow>& lows);

/// The levelling that brings a scan's lowest heights to the map's, to which they were added.
/// Columns that disagree with most others (something stands there now, another storey) do not
/// count.
/// @return  none where too few columns were seen by several scans, where the heights would change
///          by less than levelling.min_correction, or where they would still disagree
Levelling findLevelling(const TileMap& map, ColumnIndex anchor, const std::vector<ColumnLow>& lows,
                        double res_g, const LevellingConfig& config);

/// Moves the points' and the sensor's heights; x and y stay, which a tilt of a degree would move by
/// centimetres.
void applyLevelling(const Levelling& levelling, PlacedScan& scan);

}  // namespace beautymap
