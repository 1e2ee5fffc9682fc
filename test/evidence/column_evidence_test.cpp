// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/evidence/column_evidence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "test_scenes.h"

namespace beautymap {
namespace {

using test::Random;

// What the counters of a cell hold at most. Each stretch of frees is counted on its own first.
constexpr int kMaxHits = 1023;
constexpr int kMaxStretch = 255;
constexpr int kMaxBetween = 1023;
constexpr int kMaxGaps = 1023;
constexpr int kMaxFew = 15;

bool isSet(Bits bits, int bit) { return (bits >> bit & 1) != 0; }

/// Sparse, dense, empty and full masks.
Bits randomMask(Random& random) {
  switch (random.integer(0, 5)) {
    case 0:
      return 0;
    case 1:
      return ~Bits{0};
    case 2:
      return random.bits() & random.bits() & random.bits();
    case 3:
      return random.bits() | random.bits() | random.bits();
    default:
      return random.bits();
  }
}

/// The same counters as plain numbers.
template <int kPlanes>
struct CountersAndOracle {
  static constexpr int kMax = (1 << kPlanes) - 1;

  void increment(Bits mask) {
    counters.increment(mask);
    for (int bit = 0; bit < kMaxBits; ++bit) {
      if (isSet(mask, bit)) value(bit) = std::min(kMax, value(bit) + 1);
    }
  }
  template <int kOtherPlanes>
  void add(const CountersAndOracle<kOtherPlanes>& other, Bits mask) {
    counters.add(other.counters, mask);
    for (int bit = 0; bit < kMaxBits; ++bit) {
      if (isSet(mask, bit)) value(bit) = std::min(kMax, value(bit) + other.value(bit));
    }
  }
  void clear(Bits mask) {
    counters.clear(mask);
    for (int bit = 0; bit < kMaxBits; ++bit) {
      if (isSet(mask, bit)) value(bit) = 0;
    }
  }
  void assign(const CountersAndOracle& other, Bits mask) {
    counters.assign(other.counters, mask);
    for (int bit = 0; bit < kMaxBits; ++bit) {
      if (isSet(mask, bit)) value(bit) = other.value(bit);
    }
  }

  void expectEqual() const {
    for (int bit = 0; bit < kMaxBits; ++bit) {
      ASSERT_EQ(counters.count(bit), value(bit)) << "bit " << bit;
      ASSERT_EQ(isSet(counters.any(), bit), value(bit) != 0) << "bit " << bit;
      for (int p = 0; p < kPlanes; ++p) {
        ASSERT_EQ(isSet(counters.plane(p), bit), (value(bit) >> p & 1) != 0) << "plane " << p;
      }
    }
  }
  bool anyFull() const { return std::count(values.begin(), values.end(), kMax) > 0; }

  int& value(int bit) { return values[static_cast<std::size_t>(bit)]; }
  int value(int bit) const { return values[static_cast<std::size_t>(bit)]; }

  BitCounters<kPlanes> counters;
  std::array<int, kMaxBits> values{};
};

template <int kPlanes, int kOtherPlanes>
void compareWithNumbers(std::uint32_t seed) {
  Random random(seed);
  CountersAndOracle<kPlanes> counters, spare;
  CountersAndOracle<kOtherPlanes> other;
  bool was_full = false;
  for (int step = 0; step < 400; ++step) {
    const Bits mask = randomMask(random);
    switch (random.integer(0, 9)) {
      case 0:
        counters.clear(mask & random.bits() & random.bits());
        break;
      case 1:
        counters.assign(spare, mask);
        break;
      case 2:
        spare.assign(counters, mask);
        break;
      case 3:
      case 4:
        counters.add(other, mask);
        break;
      case 5:
        counters.add(spare, mask);
        break;
      case 6:
        other.add(other, mask);
        break;
      case 7:
        other.increment(mask);
        spare.increment(mask);
        break;
      default:
        counters.increment(mask);
        break;
    }
    ASSERT_NO_FATAL_FAILURE(counters.expectEqual()) << "seed " << seed << " step " << step;
    ASSERT_NO_FATAL_FAILURE(other.expectEqual()) << "seed " << seed << " step " << step;
    was_full = was_full || counters.anyFull();
  }
  EXPECT_TRUE(was_full);
}

TEST(BitCounters, AgreeWithPlainNumbersAtAnyWidth) {
  for (std::uint32_t seed = 0; seed < 5; ++seed) {
    ASSERT_NO_FATAL_FAILURE((compareWithNumbers<1, 1>(seed)));
    ASSERT_NO_FATAL_FAILURE((compareWithNumbers<2, 1>(seed)));
    ASSERT_NO_FATAL_FAILURE((compareWithNumbers<3, 3>(seed)));
    ASSERT_NO_FATAL_FAILURE((compareWithNumbers<5, 2>(seed)));
    ASSERT_NO_FATAL_FAILURE((compareWithNumbers<8, 8>(seed)));
    ASSERT_NO_FATAL_FAILURE((compareWithNumbers<10, 8>(seed)));
    ASSERT_NO_FATAL_FAILURE((compareWithNumbers<16, 10>(seed)));
  }
}

TEST(BitCounters, AFullCounterStaysFullAndTouchesNoOther) {
  BitCounters<8> counters;
  for (int i = 0; i < 255; ++i) counters.increment(Bits{1} << 17);
  EXPECT_EQ(counters.count(17), 255);
  BitCounters<8> one;
  one.increment(~Bits{0});
  counters.increment(Bits{1} << 17);
  counters.add(one, Bits{1} << 17);
  EXPECT_EQ(counters.count(17), 255);
  EXPECT_EQ(counters.any(), Bits{1} << 17);
}

enum class Event { kUnseen, kHit, kFree, kFewBeams };

/// One scan's events of all cells of a column.
using Events = std::array<Event, kMaxBits>;

/// Events that hold on for a while: each cell changes with its own probability.
std::vector<Events> randomEvents(Random& random, int scans) {
  std::array<double, kMaxBits> change{};
  for (double& c : change) c = random.pick<double>({0.0, 0.002, 0.005, 0.05, 0.5});
  const auto any = [&] {
    return random.pick<Event>(
        {Event::kUnseen, Event::kHit, Event::kHit, Event::kFree, Event::kFree, Event::kFewBeams});
  };
  Events now{};
  for (Event& e : now) e = any();
  std::vector<Events> all;
  for (int s = 0; s < scans; ++s) {
    for (std::size_t bit = 0; bit < now.size(); ++bit) {
      if (random.chance(change[bit])) now[bit] = any();
    }
    all.push_back(now);
  }
  return all;
}

void observe(ColumnEvidence& evidence, const Events& events) {
  Bits hit = 0, free = 0, few = 0;
  for (std::size_t bit = 0; bit < events.size(); ++bit) {
    if (events[bit] == Event::kHit) hit |= Bits{1} << bit;
    if (events[bit] == Event::kFree) free |= Bits{1} << bit;
    if (events[bit] == Event::kFewBeams) few |= Bits{1} << bit;
  }
  evidence.observe(hit, free, few);
}

ColumnEvidence observed(const std::vector<Events>& scans, std::size_t first, std::size_t end) {
  ColumnEvidence evidence;
  for (std::size_t s = first; s < end; ++s) observe(evidence, scans[s]);
  return evidence;
}
ColumnEvidence observed(const std::vector<Events>& scans) {
  return observed(scans, 0, scans.size());
}

/// The counters of one cell.
struct Counts {
  int hits = 0;
  int before = 0;
  int between = 0;
  int after = 0;
  int gaps = 0;
  int few = 0;
};

/// From the plain list of a cell's events.
Counts countsOf(const std::vector<Events>& scans, int bit) {
  std::vector<Event> seen;
  Counts counts;
  for (const Events& events : scans) {
    const Event e = events[static_cast<std::size_t>(bit)];
    if (e == Event::kFewBeams) counts.few = std::min(kMaxFew, counts.few + 1);
    if (e == Event::kHit || e == Event::kFree) seen.push_back(e);
  }
  const auto hit_count = static_cast<int>(std::count(seen.begin(), seen.end(), Event::kHit));
  counts.hits = std::min(kMaxHits, hit_count);
  int hits_so_far = 0;
  int stretch = 0;  // frees in a row
  for (const Event e : seen) {
    if (e == Event::kFree) {
      ++stretch;
      continue;
    }
    if (hits_so_far == 0) counts.before = std::min(kMaxStretch, stretch);
    if (hits_so_far > 0) {
      counts.between += std::min(kMaxStretch, stretch);
      counts.gaps += stretch > 0;
    }
    ++hits_so_far;
    stretch = 0;
  }
  (hits_so_far == 0 ? counts.before : counts.after) = std::min(kMaxStretch, stretch);
  counts.between = std::min(kMaxBetween, counts.between);
  counts.gaps = std::min(kMaxGaps, counts.gaps);
  return counts;
}

void expectCounts(const ColumnEvidence& evidence, const std::vector<Events>& scans) {
  for (int bit = 0; bit < kMaxBits; ++bit) {
    const Counts expected = countsOf(scans, bit);
    ASSERT_EQ(evidence.hits(bit), expected.hits) << "bit " << bit;
    ASSERT_EQ(evidence.freeBefore(bit), expected.before) << "bit " << bit;
    ASSERT_EQ(evidence.freeBetween(bit), expected.between) << "bit " << bit;
    ASSERT_EQ(evidence.freeAfter(bit), expected.after) << "bit " << bit;
    ASSERT_EQ(evidence.gaps(bit), expected.gaps) << "bit " << bit;
    ASSERT_EQ(evidence.passedByFew(bit), expected.few) << "bit " << bit;
    ASSERT_EQ(isSet(evidence.everPassedByFew(), bit), expected.few > 0) << "bit " << bit;
    ASSERT_EQ(isSet(evidence.everFree(), bit),
              expected.before + expected.between + expected.after > 0)
        << "bit " << bit;
  }
}

TEST(ColumnEvidence, CountsAsTheListOfEventsSays) {
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    Random random(seed);
    const std::vector<Events> scans = randomEvents(random, random.integer(0, 60));
    ASSERT_NO_FATAL_FAILURE(expectCounts(observed(scans), scans)) << "seed " << seed;
  }
}

TEST(ColumnEvidence, LongDrivesFillTheCountersAndNoMore) {
  Counts most;
  for (std::uint32_t seed = 0; seed < 6; ++seed) {
    Random random(seed);
    const std::vector<Events> scans = randomEvents(random, 4000);
    const ColumnEvidence evidence = observed(scans);
    ASSERT_NO_FATAL_FAILURE(expectCounts(evidence, scans)) << "seed " << seed;
    for (int bit = 0; bit < kMaxBits; ++bit) {
      most.hits = std::max(most.hits, evidence.hits(bit));
      most.before = std::max(most.before, evidence.freeBefore(bit));
      most.between = std::max(most.between, evidence.freeBetween(bit));
      most.after = std::max(most.after, evidence.freeAfter(bit));
    }
  }
  EXPECT_EQ(most.hits, kMaxHits);
  EXPECT_EQ(most.before, kMaxStretch);
  EXPECT_EQ(most.between, kMaxBetween);
  EXPECT_EQ(most.after, kMaxStretch);
}

TEST(ColumnEvidence, ACellThatIsHitIsNotFreeInTheSameScan) {
  ColumnEvidence evidence;
  evidence.observe(Bits{1}, Bits{3}, Bits{7});
  EXPECT_EQ(evidence.everPassedByFew(), Bits{4});
  EXPECT_EQ(evidence.hits(0), 1);
  EXPECT_EQ(evidence.everFree(), Bits{2});
}

/// Appends evidence of consecutive stretches, in any order of appending that keeps their order.
ColumnEvidence appended(const std::vector<ColumnEvidence>& stretches, int first, int end,
                        Random& random) {
  if (end - first == 1) return stretches[static_cast<std::size_t>(first)];
  const int middle = random.integer(first + 1, end - 1);
  ColumnEvidence evidence = appended(stretches, first, middle, random);
  evidence.append(appended(stretches, middle, end, random));
  return evidence;
}

void expectAnyCutGivesTheSame(const std::vector<Events>& scans, Random& random) {
  std::vector<int> cuts{0, static_cast<int>(scans.size())};
  for (int i = random.integer(1, 4); i > 0; --i) cuts.push_back(random.integer(0, cuts[1]));
  std::sort(cuts.begin(), cuts.end());
  std::vector<ColumnEvidence> stretches;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    stretches.push_back(
        observed(scans, static_cast<std::size_t>(cuts[i]), static_cast<std::size_t>(cuts[i + 1])));
  }
  const int count = static_cast<int>(stretches.size());
  for (int bracketing = 0; bracketing < 3; ++bracketing) {
    ASSERT_NO_FATAL_FAILURE(expectCounts(appended(stretches, 0, count, random), scans));
  }
}

TEST(ColumnEvidence, AnyCutOfTheScansAppendedInAnyBracketingGivesTheSame) {
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    const std::vector<Events> scans = randomEvents(random, random.integer(0, 60));
    ASSERT_NO_FATAL_FAILURE(expectAnyCutGivesTheSame(scans, random)) << "seed " << seed;
  }
}

TEST(ColumnEvidence, AnyCutGivesTheSameWhenCountersAreFull) {
  for (std::uint32_t seed = 0; seed < 8; ++seed) {
    Random random(seed);
    const std::vector<Events> scans = randomEvents(random, random.integer(1000, 4000));
    ASSERT_NO_FATAL_FAILURE(expectAnyCutGivesTheSame(scans, random)) << "seed " << seed;
  }
}

/// A number of scans of one cell.
struct Stretch {
  Event event;
  int scans;
};
constexpr int kCell = 5;

/// The evidence of one cell of a column.
ColumnEvidence evidenceOf(const std::vector<Stretch>& story) {
  ColumnEvidence evidence;
  for (const Stretch& stretch : story) {
    Events events{};
    events[kCell] = stretch.event;
    for (int s = 0; s < stretch.scans; ++s) observe(evidence, events);
  }
  return evidence;
}

bool isDynamic(const std::vector<Stretch>& story, const EvidenceConfig& config = {}) {
  return evidenceOf(story).isDynamic(kCell, config);
}
bool isStrong(const std::vector<Stretch>& story, const EvidenceConfig& config = {}) {
  return evidenceOf(story).isStrong(kCell, config);
}

constexpr Event kHit = Event::kHit;
constexpr Event kFree = Event::kFree;
constexpr Event kUnseen = Event::kUnseen;
constexpr Event kFewBeams = Event::kFewBeams;

TEST(EvidenceRules, OneFreeScanRemovesNothing) {
  for (const int hits : {1, 2, 3, 100}) {
    EXPECT_FALSE(isDynamic({{kFree, 1}, {kHit, hits}}));
    EXPECT_FALSE(isDynamic({{kHit, hits}, {kFree, 1}}));
    EXPECT_FALSE(isDynamic({{kHit, hits}, {kFree, 1}, {kHit, hits}}));
  }
}

TEST(EvidenceRules, WhatPassesByIsDynamic) {
  EXPECT_TRUE(isDynamic({{kFree, 10}, {kHit, 1}, {kFree, 10}}));
  EXPECT_TRUE(isDynamic({{kHit, 1}, {kFree, 2}}));
  EXPECT_TRUE(isDynamic({{kFree, 4}, {kHit, 3}}));
}

TEST(EvidenceRules, WhatIsNeverSeenFreeIsStatic) {
  EXPECT_FALSE(isDynamic({}));
  EXPECT_FALSE(isDynamic({{kHit, 1}, {kUnseen, 100}}));
  EXPECT_FALSE(isDynamic({{kHit, 5000}}));
}

TEST(EvidenceRules, AParkedCarThatDrivesAwayIsDynamic) {
  // Far fewer frees than hits, but they all come after the last hit.
  EXPECT_TRUE(isDynamic({{kHit, 40}, {kFree, 5}}));
  EXPECT_TRUE(isDynamic({{kHit, 40}, {kUnseen, 200}, {kFree, 5}}));
  EXPECT_FALSE(isDynamic({{kHit, 40}, {kFree, 4}}));
  EXPECT_FALSE(isDynamic({{kHit, 100}, {kFree, 10}}));
  EXPECT_TRUE(isDynamic({{kHit, 100}, {kFree, 11}}));
}

TEST(EvidenceRules, WhatArrivesAndStaysBecomesStaticAgain) {
  EXPECT_TRUE(isDynamic({{kFree, 10}, {kHit, 90}}));
  EXPECT_FALSE(isDynamic({{kFree, 10}, {kHit, 130}}));
  EXPECT_FALSE(isDynamic({{kFree, 10}, {kHit, 10000}}));
}

TEST(EvidenceRules, FreesBetweenHitsAreNoOrder) {
  EXPECT_TRUE(isDynamic({{kHit, 60}, {kFree, 20}}));
  EXPECT_FALSE(isDynamic({{kHit, 30}, {kFree, 20}, {kHit, 30}}));
  EXPECT_TRUE(isDynamic({{kHit, 30}, {kFree, 61}, {kHit, 30}}));
}

TEST(EvidenceRules, FreesBeforeAndAfterCountTogetherOnlyForTheRatio) {
  EXPECT_FALSE(isDynamic({{kFree, 4}, {kHit, 40}, {kFree, 4}}));
  EXPECT_TRUE(isDynamic({{kFree, 4}, {kHit, 7}, {kFree, 4}}));
}

/// A story that is told so many times.
std::vector<Stretch> repeated(const std::vector<Stretch>& story, int times) {
  std::vector<Stretch> all;
  for (int i = 0; i < times; ++i) all.insert(all.end(), story.begin(), story.end());
  return all;
}

TEST(EvidenceRules, SingleBeamsCountHalfWhereACellWasSeldomHit) {
  EXPECT_FALSE(isDynamic({{kHit, 1}, {kFewBeams, 3}}));
  EXPECT_TRUE(isDynamic({{kHit, 1}, {kFewBeams, 4}}));
  EXPECT_TRUE(isDynamic({{kFewBeams, 2}, {kHit, 1}, {kFree, 1}}));
  EXPECT_FALSE(isDynamic({{kHit, 2}, {kFewBeams, 3}}));
  EXPECT_TRUE(isDynamic({{kHit, 2}, {kFewBeams, 4}}));
  EXPECT_FALSE(isDynamic({{kHit, 3}, {kFewBeams, 100}}));
  EvidenceConfig never;
  never.few_beams_hits = 0;
  EXPECT_FALSE(isDynamic({{kHit, 1}, {kFewBeams, 100}}, never));
}

TEST(EvidenceRules, AnEdgeThatFlickersIsNotDynamicByItself) {
  // Two beams a scan pass the edge of a wall: hit and free take turns.
  const std::vector<Stretch> edge = repeated({{kFree, 3}, {kHit, 2}}, 10);
  EXPECT_FALSE(isDynamic(edge));
  EXPECT_TRUE(evidenceOf(edge).isLeaning(kCell, {}));  // its neighbours may say so
  EvidenceConfig never;
  never.flicker_gaps = 0;
  EXPECT_TRUE(isDynamic(edge, never));
  EXPECT_FALSE(isDynamic(repeated(edge, 100)));  // counters are full
}

TEST(EvidenceRules, TwoGapsAreNoDoubt) {
  std::vector<Stretch> story = repeated({{kFree, 3}, {kHit, 2}}, 3);
  EXPECT_TRUE(isDynamic(story));
  story.insert(story.end(), {{kFree, 1}, {kHit, 2}});
  EXPECT_FALSE(isDynamic(story));
}

TEST(EvidenceRules, PeopleWhoPassOneAfterTheOtherDoNotFlicker) {
  EXPECT_TRUE(isDynamic(repeated({{kHit, 6}, {kFree, 14}}, 5)));
}

TEST(EvidenceRules, WhatFlickeredUntilItDroveAwayIsDynamic) {
  std::vector<Stretch> story = repeated({{kHit, 1}, {kFree, 1}}, 5);
  story.push_back({kFree, 19});
  EXPECT_FALSE(isDynamic(story));
  story.push_back({kFree, 1});
  EXPECT_TRUE(isDynamic(story));
}

TEST(EvidenceRules, FullHitsAreNeverOutvotedByTheRatio) {
  EvidenceConfig config;
  config.order_ratio = 100.0;
  config.free_ratio = 0.5;
  const Stretch short_gap{kFree, 200};
  const std::vector<Stretch> gaps{{kHit, 1}, short_gap, {kHit, 1}, short_gap,
                                  {kHit, 1}, short_gap, {kHit, 1}, short_gap};
  std::vector<Stretch> known = gaps, full = gaps;
  known.push_back({kHit, kMaxHits - 4 - 1});
  full.push_back({kHit, kMaxHits - 4});
  EXPECT_TRUE(isDynamic(known, config));
  EXPECT_FALSE(isDynamic(full, config));
  config.free_ratio = 0.0;
  EXPECT_FALSE(isDynamic(full, config));
  // The hits may also become full when stretches are joined.
  ColumnEvidence joined = evidenceOf(gaps);
  joined.append(evidenceOf({{kHit, 2000}}));
  EXPECT_FALSE(joined.isDynamic(kCell, config));
}

TEST(EvidenceRules, WhatStoodLongerThanTheHitsCountIsDynamicOnceItHasGone) {
  EXPECT_TRUE(isDynamic({{kHit, 5000}, {kFree, 120}}));
  EXPECT_FALSE(isDynamic({{kHit, 5000}, {kFree, 50}}));
}

TEST(EvidenceRules, StrongIsFreeBeforeAndAfterInMoreThanTheRatioOfTheHits) {
  EXPECT_FALSE(isStrong({}));
  EXPECT_FALSE(isStrong({{kHit, 10}, {kFree, 10}}));
  EXPECT_TRUE(isStrong({{kHit, 10}, {kFree, 11}}));
  EXPECT_TRUE(isStrong({{kFree, 6}, {kHit, 10}, {kFree, 5}}));
  EXPECT_FALSE(isStrong({{kFree, 5}, {kHit, 5}, {kFree, 50}, {kHit, 5}, {kFree, 5}}));
  EvidenceConfig config;
  config.strong_ratio = 5.0;
  EXPECT_FALSE(isStrong({{kHit, 10}, {kFree, 50}}, config));
  EXPECT_TRUE(isStrong({{kHit, 10}, {kFree, 51}}, config));
}

TEST(EvidenceRules, LeaningIsSeenFreeBeforeOrAfterButOnceInManyHits) {
  const EvidenceConfig config;
  const auto isLeaning = [&](const std::vector<Stretch>& stretches) {
    return evidenceOf(stretches).isLeaning(kCell, config);
  };
  EXPECT_FALSE(isLeaning({}));
  EXPECT_FALSE(isLeaning({{kHit, 3}}));
  EXPECT_TRUE(isLeaning({{kHit, 30}, {kFree, 1}}));
  EXPECT_TRUE(isLeaning({{kFree, 1}, {kHit, 30}}));
  EXPECT_FALSE(isLeaning({{kHit, 40}, {kFree, 1}}));
  EXPECT_FALSE(isLeaning({{kHit, 5}, {kFree, 50}, {kHit, 5}}));
}

TEST(EvidenceRules, AgreeWithTheRulesOnPlainCountsAtRandom) {
  int dynamic = 0, strong = 0, flickering = 0;
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    EvidenceConfig config;
    config.min_free = random.integer(1, 20);
    config.free_ratio = random.uniform(0.0, 2.0);
    config.order_ratio = random.uniform(0.0, 1.0);
    config.strong_ratio = random.uniform(0.0, 4.0);
    config.leaning_ratio = random.uniform(0.0, 0.5);
    config.few_beams_hits = random.integer(0, 20);
    config.flicker_gaps = random.integer(0, 4);
    config.flicker_hits = random.integer(0, 20);
    config.flicker_order = random.uniform(0.0, 10.0);
    config.doubt_gaps = random.integer(0, 6);
    const std::vector<Events> scans = randomEvents(random, random.pick<int>({5, 40, 1500}));
    const ColumnEvidence evidence = observed(scans);
    for (int bit = 0; bit < kMaxBits; ++bit) {
      const Counts c = countsOf(scans, bit);
      const double few = c.hits <= config.few_beams_hits ? 0.5 * c.few : 0.0;
      const double free = c.before + c.between + c.after + few;
      const bool by_ratio =
          c.hits < kMaxHits && free >= config.min_free && free > config.free_ratio * c.hits;
      const auto decides = [&](int ordered) {
        return ordered >= config.min_free && ordered > config.order_ratio * c.hits;
      };
      // What was free before more hits than can be counted has become static.
      const bool by_order = (c.hits < kMaxHits && decides(c.before)) || decides(c.after);
      const bool flickers = config.flicker_gaps > 0 && c.gaps >= config.flicker_gaps &&
                            c.hits <= config.flicker_hits * (c.gaps + 1) &&
                            std::max(c.before, c.after) <= config.flicker_order * c.hits;
      ASSERT_EQ(evidence.flickers(bit, config), flickers) << "seed " << seed;
      const bool doubted = flickers && c.gaps >= config.doubt_gaps;
      const bool is_dynamic = (by_ratio || by_order) && !doubted;
      ASSERT_EQ(evidence.isDynamic(bit, config), is_dynamic) << "seed " << seed;
      flickering += (by_ratio || by_order) && doubted;
      const int in_order = c.before + c.after;
      ASSERT_EQ(evidence.isStrong(bit, config), in_order > config.strong_ratio * c.hits);
      const bool leans = in_order > 0 && in_order >= config.leaning_ratio * c.hits;
      ASSERT_EQ(evidence.isLeaning(bit, config), leans);
      dynamic += is_dynamic;
      strong += in_order > config.strong_ratio * c.hits;
    }
  }
  EXPECT_GT(dynamic, 500);
  EXPECT_LT(dynamic, 9000);
  EXPECT_GT(strong, 500);
  EXPECT_GT(flickering, 200);
}

}  // namespace
}  // namespace beautymap
