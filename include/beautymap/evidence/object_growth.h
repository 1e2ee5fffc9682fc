// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "beautymap/config/evidence_config.h"
#include "beautymap/evidence/evidence_window.h"
#include "beautymap/matrix/column_grid.h"

namespace beautymap {

/// Adds, round by round, the leaning and unknown cells that join dynamic ones as parts of the same
/// object: a share of their occupied neighbours is dynamic, and they do not rest on a cell that
/// stays (what is seen over the roof of a parked car is no reason to remove the roof). Sparse scans
/// leave gaps in an object: where nothing stays within two cells, the cells within two are the
/// neighbours, too. The two columns at the window's border do not change.
/// @param dynamic  the dynamic cells of the same window
void growObjects(const EvidenceWindow& window, BitGrid& dynamic, int ground_bit,
                 const AgreementConfig& config);

constexpr int kFlickerRounds = 3;  ///< edges are a few cells thick

/// Takes away, from outside to inside, dynamic cells that are but the flickering edges of what
/// stays (a bush, a fence, a rim): more than flicker_share of the dynamic cells around flickers,
/// and less than join_share of the occupied ones is dynamic by its own evidence.
/// @param dynamic  the dynamic cells of the same window; its border does not change
void excludeFlicker(const EvidenceWindow& window, BitGrid& dynamic, int ground_bit,
                    const AgreementConfig& config);

}  // namespace beautymap
