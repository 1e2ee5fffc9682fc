// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "beautymap/config/evidence_config.h"
#include "beautymap/evidence/evidence_window.h"
#include "beautymap/matrix/column_grid.h"

namespace beautymap {

/// The suspected cells that stand without support: a moving object fills neighbouring cells, an
/// edge or a leaf does not. A cell is supported when, of the occupied cells among its 26 neighbours
/// above the ground cell, a share is suspected; strong evidence needs a smaller share.
/// @return  for the columns one in from the window's border; no bits at the border
BitGrid unsupportedCells(const EvidenceWindow& window, int ground_bit,
                         const AgreementConfig& config);

/// The suspected cells that are but the noise of a surface that stays (the ground, a roof, a
/// table): with noise of ranges and poses some scans hit the cells upon it, and most see them free.
/// They are up to surface_bits high upon a cell that stays and does not even lean, and right above
/// them nothing else is suspected in their column and those around: what moves is thicker.
/// @return  for the columns one in from the window's border; no bits at the border
BitGrid surfaceNoise(const EvidenceWindow& window, int surface_bits);

/// The suspected cells that are but the noise of a surface overhead (a ceiling, a roof), which
/// beams graze: overhead_bits above the ground cell or higher, and nothing is suspected in their
/// column and those around from surface_bits + 1 to twice surface_bits below and above them. What
/// moves up there is thicker.
/// @return  for the columns one in from the window's border; no bits at the border
BitGrid overheadNoise(const EvidenceWindow& window, int ground_bit, const AgreementConfig& config);

/// How far from its border a window is needed to know the dynamic cells within [columns].
int agreementMargin(const AgreementConfig& config);

/// The dynamic cells: the suspected ones with support that are no noise, and what joins them round
/// by round, without flickering edges.
/// @return  valid for the columns agreementMargin() in from the window's border
BitGrid dynamicCells(const EvidenceWindow& window, int ground_bit, const AgreementConfig& config);

}  // namespace beautymap
