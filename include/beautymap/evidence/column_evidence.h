// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "beautymap/config/evidence_config.h"
#include "beautymap/evidence/bit_counters.h"

namespace beautymap {

/// What scans in the order of time say about the cells of one column: in how many each was hit, and
/// in how many it was seen free before the first hit, between hits, and after the last one. Order
/// is information: what is free before or after a stretch of hits came and went, frees between hits
/// are noise at an edge when they come in many short gaps.
class ColumnEvidence {
 public:
  /// One scan: cells it hit, cells it saw free, and cells that too few beams passed to be sure. A
  /// cell in none was not seen.
  void observe(Bits hit, Bits seen_free, Bits passed_by_few = 0);

  /// Appends the evidence (another object) of the scans that follow this one's. Associative: any
  /// cut of the scans into stretches gives the same.
  void append(const ColumnEvidence& later);

  /// Moves the evidence of every cell to another bit, upwards for bits > 0; what leaves the mask is
  /// lost.
  void shift(int bits, Bits mask);

  /// Cells that were seen free at least once.
  Bits everFree() const { return before_.any() | between_.any() | after_.any(); }
  /// Cells that too few beams passed at least once.
  Bits everPassedByFew() const { return few_.any(); }
  /// Cells that more scans hit than that.
  Bits hitMoreOften(int scans) const { return hits_.above(scans); }
  int hits(int bit) const { return hits_.count(bit); }
  int freeBefore(int bit) const { return before_.count(bit); }
  int freeBetween(int bit) const { return between_.count(bit); }
  int freeAfter(int bit) const { return after_.count(bit); }
  /// In how many scans too few beams passed the cell.
  int passedByFew(int bit) const { return few_.count(bit); }
  /// In how many stretches the frees between hits came.
  int gaps(int bit) const { return gaps_.count(bit); }

  /// Whether the cell is dynamic: seen free often enough for its hits, or often enough before the
  /// first or after the last.
  bool isDynamic(int bit, const EvidenceConfig& config) const;
  /// Whether the cell changes between hit and free as an edge of something that stays does.
  bool flickers(int bit, const EvidenceConfig& config) const;
  /// Whether it was seen free, in the order of something that came or went, so much more often than
  /// hit that few neighbours need to agree.
  bool isStrong(int bit, const EvidenceConfig& config) const;
  /// Whether something speaks for dynamic, though not enough without neighbours that are.
  bool isLeaning(int bit, const EvidenceConfig& config) const;

 private:
  // Free counts before the first and after the last hit join when stretches are appended: equal
  // widths keep that exact.
  BitCounters<10> hits_;
  BitCounters<8> before_;
  BitCounters<10> between_;
  BitCounters<8> after_;
  BitCounters<10> gaps_;
  BitCounters<4> few_;  // only asked for where hits are few
};

}  // namespace beautymap
