// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "beautymap/config/config.h"
#include "beautymap/matrix/scan.h"

namespace beautymap {

/// The horizontal size of a map's cells [m] for the place that its first scan shows. Between the
/// walls of a room people pass so close to what stays that they would share larger cells with it;
/// in the open, smaller cells catch too few beams, and cost time and memory.
/// @return  matrix.room_res_g where nine of ten points lie within matrix.room_range, otherwise
/// matrix.res_g; nothing for a scan with too few usable points to tell
std::optional<double> cellSizeFor(const Scan& scan, const Config& config);

}  // namespace beautymap
