// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "beautymap/matrix/scan.h"

namespace beautymap::benchmarks {

/// Scans of a simulated street by a spinning LiDAR with that many beams, 1920 firings a turn; made
/// at the first call.
const std::vector<Scan>& simulatedDrive(int beams);

/// A scan and its sensor moved by a distance [m].
Scan shifted(const Scan& scan, double x_m, double y_m);

}  // namespace beautymap::benchmarks
