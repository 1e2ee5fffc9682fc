// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "beautymap/config/evidence_config.h"
#include "beautymap/evidence/column_evidence.h"
#include "beautymap/ground/ground_layer.h"
#include "beautymap/matrix/tile_map.h"

namespace beautymap {

/// Whether the ground cell below an object may hold the object's lower end and no ground: its own
/// evidence for that is strong; or it is hardly known, and the lowest cells were hit in less than
/// min_contrast times the scans that hit the object above them. So a flight of stairs is seen from
/// below, where no beam meets the steps: people's feet are the lowest points then.
bool mayBeObject(const ColumnEvidence& evidence, Bits dynamic, double min_contrast, int ground_bit,
                 const EvidenceConfig& config);

/// How many bins of a column with these dynamic cells are ground. None where all speaks against
/// ground: the cell above is dynamic, the ground cell may be of an object, and no surface stands
/// out in it.
int groundBinsOf(const Tile& tile, std::size_t column, Bits dynamic, const GroundLayer& layer,
                 int ground_bit, const EvidenceConfig& config);

/// Sets how many bins are ground in the columns of a tile that have dynamic cells; in the others
/// nothing depends on it.
void findGroundLayers(Tile& tile, const GroundLayer& layer, int ground_bit,
                      const EvidenceConfig& evidence);

}  // namespace beautymap
