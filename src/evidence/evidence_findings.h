// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <utility>

#include "beautymap/evidence/beam_visibility.h"
#include "beautymap/evidence/evidence_judgement.h"
#include "beautymap/evidence/evidence_window.h"

namespace beautymap {

struct EvidenceJudgement::Findings : ScanFindings {
  /// Cells that were asked for, and what the scan says about them.
  struct Seen {
    BitGrid candidates;
    BitGrid free;
    BitGrid few;  ///< passed by too few beams to be sure
  };

  HeightGrid ground;
  BitGrid hit;                     ///< the scan's matrix
  std::array<Seen, 2> seen;        ///< the whole window in the first one, or half of it in each
  std::optional<BeamImage> beams;  ///< large

  // In a map that grows: the cells that the scan hit, by what is known of them.
  EvidenceWindow live;
  BitGrid dynamic;

  void fillBeams(const PlacedScan& scan, const VisibilityConfig& config) {
    if (!beams) beams.emplace(config);
    beams->fill(scan);
  }
  void findSeen(Seen& part, const PlacedScan& scan, const Config& config) const {
    part.free = cellsSeenFree(*beams, part.candidates, ground, scan, config.matrix,
                              config.visibility, std::move(part.free), &part.few);
  }
};

}  // namespace beautymap
