// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "beautymap/column_grid.h"
#include "beautymap/config.h"

namespace beautymap {

/// Cells of a window that the evidence holds for dynamic, and what is around them.
struct DynamicWindow {
  BitGrid occupied;
  BitGrid dynamic;
  BitGrid strong;  ///< those of the dynamic ones whose evidence is strong
};

/// The dynamic cells that stand without support: a moving object fills neighbouring cells, an edge
/// or a leaf does not. A cell is supported when, of the occupied cells among its 26 neighbours
/// above the ground cell, a share is dynamic; strong evidence needs a smaller share. And what moves
/// is tall: some vertical run of dynamic cells, within the columns around, contains the cell.
/// @return  for the columns one in from the window's border; no bits at the border
BitGrid unsupportedCells(const DynamicWindow& window, int ground_bit,
                         const AgreementConfig& config);

}  // namespace beautymap
