// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "beautymap/matrix/column_grid.h"

namespace beautymap {

/// The cells of a window of the map, by what their own evidence says.
struct EvidenceWindow {
  BitGrid occupied;
  BitGrid suspected;   ///< held for dynamic
  BitGrid strong;      ///< those of the suspected ones whose evidence is strong
  BitGrid leaning;     ///< not suspected, but seen free before or after their hits
  BitGrid unknown;     ///< never seen free, and seldom hit
  BitGrid flickering;  ///< hit and free in turns, as the edges of what stays are
};

}  // namespace beautymap
