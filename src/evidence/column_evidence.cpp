// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/evidence/column_evidence.h"

#include <algorithm>

namespace beautymap {

void ColumnEvidence::observe(Bits hit, Bits seen_free, Bits passed_by_few) {
  const Bits free = seen_free & ~hit;
  few_.increment(passed_by_few & ~(hit | seen_free));
  if (hit != 0) {
    hits_.increment(hit);
    // A hit ends the stretch of frees after the hit before it.
    const Bits ended = hit & after_.any();
    if (ended != 0) {
      between_.add(after_, ended);
      gaps_.increment(ended);
      after_.clear(ended);
    }
  }
  if (free != 0) {
    const Bits was_hit = hits_.any();
    before_.increment(free & ~was_hit);
    after_.increment(free & was_hit);
  }
}

void ColumnEvidence::append(const ColumnEvidence& later) {
  const Bits hit = hits_.any();
  const Bits hit_later = later.hits_.any();
  before_.add(later.before_, ~hit);
  after_.add(later.before_, hit);
  const Bits ended = hit & hit_later;
  between_.add(after_, ended);
  between_.add(later.between_, hit_later);
  gaps_.increment(after_.any() & ended);
  gaps_.add(later.gaps_, hit_later);
  few_.add(later.few_, ~Bits{0});
  after_.assign(later.after_, hit_later);
  hits_.add(later.hits_, ~Bits{0});
}

void ColumnEvidence::shift(int bits, Bits mask) {
  hits_.shift(bits, mask);
  before_.shift(bits, mask);
  between_.shift(bits, mask);
  after_.shift(bits, mask);
  gaps_.shift(bits, mask);
  few_.shift(bits, mask);
}

bool ColumnEvidence::flickers(int bit, const EvidenceConfig& config) const {
  const int gap_count = gaps(bit);
  if (config.flicker_gaps == 0 || gap_count < config.flicker_gaps) return false;
  const int hit = hits(bit);
  return hit <= config.flicker_hits * (gap_count + 1) &&
         std::max(freeBefore(bit), freeAfter(bit)) <= config.flicker_order * hit;
}

bool ColumnEvidence::isStrong(int bit, const EvidenceConfig& config) const {
  return freeBefore(bit) + freeAfter(bit) > config.strong_ratio * hits(bit);
}

bool ColumnEvidence::isLeaning(int bit, const EvidenceConfig& config) const {
  const int free = freeBefore(bit) + freeAfter(bit);
  return free > 0 && free >= config.leaning_ratio * hits(bit);
}

bool ColumnEvidence::isDynamic(int bit, const EvidenceConfig& config) const {
  if (gaps(bit) >= config.doubt_gaps && flickers(bit, config)) return false;
  const int hit = hits(bit);
  const int before = freeBefore(bit);
  const int after = freeAfter(bit);
  double free = before + freeBetween(bit) + after;
  if (hit <= config.few_beams_hits) free += 0.5 * passedByFew(bit);
  // A full counter of hits stands for any number of them: what was seen free before or between them
  // is outvoted.
  const bool hits_known = hit < decltype(hits_)::kMax;
  if (hits_known && free >= config.min_free && free > config.free_ratio * hit) return true;
  const auto decides = [&](int in_order) {
    return in_order >= config.min_free && in_order > config.order_ratio * hit;
  };
  return (hits_known && decides(before)) || decides(after);
}

}  // namespace beautymap
