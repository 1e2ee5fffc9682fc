// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "beautymap/evidence/beam_pixels.h"

namespace beautymap {

/// So many pixels are summed at once. A true lane has all bits set.
constexpr std::size_t kLanes = 8;
using Lanes = BeamPixels::Pixel __attribute__((vector_size(kLanes * sizeof(BeamPixels::Pixel))));
static_assert(kLanes <= BeamPixels::kPadding, "reads that far beyond the last pixel");

}  // namespace beautymap
