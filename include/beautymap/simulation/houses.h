// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "beautymap/simulation/ground.h"
#include "beautymap/simulation/random.h"
#include "beautymap/simulation/shape.h"

namespace beautymap::simulation {

/// The line along the x axis behind which houses stand.
struct HouseFront {
  double y_m = 0.0;   ///< distance from the x axis
  double side = 1.0;  ///< 1: at positive y, -1: at negative y
};

/// Houses with windows and balconies, shops with panes one can look through, and gaps with fences,
/// hedges and trees, from one end to the other.
void addHouseRow(const HouseFront& front, double begin_x_m, double end_x_m, const Ground& ground,
                 Random& random, Shapes& shapes);

}  // namespace beautymap::simulation
