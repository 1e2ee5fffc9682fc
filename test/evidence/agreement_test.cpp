// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/evidence/agreement.h"

#include "beautymap/evidence/object_growth.h"

#include <gtest/gtest.h>

#include "test_scenes.h"

namespace beautymap {
namespace {

using test::Random;

constexpr int kGround = 8;

bool isSet(const BitGrid& grid, int x, int y, int bit) {
  return bit >= 0 && bit < kMaxBits && (grid.at(x, y) >> bit & 1) != 0;
}

EvidenceWindow emptyWindow(int size) {
  const BitGrid none(ColumnWindow{{-7, 11}, size}, 0);
  return {none, none, none, none, none, none};
}

/// Cells from `low` to `high`, both included.
struct Cells {
  int x_low, x_high, y_low, y_high, bit_low, bit_high;
};

void set(BitGrid& grid, const Cells& cells) {
  const Bits bits = lowBits(cells.bit_high + 1) & ~lowBits(cells.bit_low);
  for (int x = cells.x_low; x <= cells.x_high; ++x) {
    for (int y = cells.y_low; y <= cells.y_high; ++y) grid.at(x, y) |= bits;
  }
}
void setSuspected(EvidenceWindow& window, const Cells& cells) {
  set(window.occupied, cells);
  set(window.suspected, cells);
}

int countOf(const BitGrid& grid) {
  int count = 0;
  for (int x = 0; x < grid.size(); ++x) {
    for (int y = 0; y < grid.size(); ++y) count += __builtin_popcountll(grid.at(x, y));
  }
  return count;
}

TEST(Agreement, AnIsolatedDynamicCellInAWallIsUnsupported) {
  EvidenceWindow window = emptyWindow(9);
  set(window.occupied, {4, 4, 0, 8, kGround, 30});
  setSuspected(window, {4, 4, 4, 4, 20, 20});
  const AgreementConfig config;
  const BitGrid unsupported = unsupportedCells(window, kGround, config);
  EXPECT_EQ(unsupported.at(4, 4), Bits{1} << 20);
  EXPECT_EQ(countOf(unsupported), 1);
  // Strong evidence does not help it.
  window.strong = window.suspected;
  EXPECT_EQ(unsupportedCells(window, kGround, config).at(4, 4), Bits{1} << 20);
}

TEST(Agreement, ABlockInFreeSpaceIsSupported) {
  EvidenceWindow window = emptyWindow(9);
  setSuspected(window, {3, 5, 3, 5, kGround + 2, kGround + 6});
  EXPECT_EQ(countOf(window.suspected), 45);
  EXPECT_EQ(countOf(unsupportedCells(window, kGround, {})), 0);
}

TEST(Agreement, ABlockOnTheGroundIsSupportedBecauseTheGroundDoesNotCount) {
  EvidenceWindow window = emptyWindow(9);
  set(window.occupied, {0, 8, 0, 8, kGround, kGround});
  setSuspected(window, {3, 5, 3, 5, kGround + 1, kGround + 5});
  EXPECT_EQ(countOf(unsupportedCells(window, kGround, {})), 0);
  // Were the ground below, its cells would count as neighbours that stay.
  EXPECT_GT(countOf(unsupportedCells(window, kGround - 1, {})), 0);
}

TEST(Agreement, StrongEvidenceNeedsFewerNeighbours) {
  // Something thin that went by along a wall.
  EvidenceWindow window = emptyWindow(9);
  set(window.occupied, {3, 3, 0, 8, 10, 30});
  setSuspected(window, {4, 4, 0, 8, 10, 30});
  EXPECT_EQ(unsupportedCells(window, kGround, {}).at(4, 4), lowBits(31) & ~lowBits(10));
  window.strong = window.suspected;
  EXPECT_EQ(countOf(unsupportedCells(window, kGround, {})), 0);
}

TEST(Agreement, TheHighestAndLowestBitsAreNoNeighbours) {
  EvidenceWindow window = emptyWindow(5);
  set(window.occupied, {1, 3, 1, 3, 0, 0});
  setSuspected(window, {2, 2, 2, 2, 61, 63});
  EXPECT_EQ(countOf(unsupportedCells(window, -1, {})), 0);
}

/// The cells near another one, above the ground cell.
struct Around {
  int occupied = 0;
  int dynamic = 0;
  int staying = 0;
  int flickering = 0;  ///< of the dynamic ones
  int suspected = 0;   ///< of the dynamic ones
};

Around look(const EvidenceWindow& window, const BitGrid& dynamic, int x, int y, int bit,
            int ground_bit, int reach = 1) {
  Around around;
  for (int nx = x - reach; nx <= x + reach; ++nx) {
    for (int ny = y - reach; ny <= y + reach; ++ny) {
      for (int at = bit - reach; at <= bit + reach; ++at) {
        if ((nx == x && ny == y && at == bit) || at <= ground_bit) continue;
        const bool occupied = isSet(window.occupied, nx, ny, at),
                   moves = isSet(dynamic, nx, ny, at);
        const bool open = isSet(window.leaning, nx, ny, at) || isSet(window.unknown, nx, ny, at);
        around.occupied += occupied;
        around.dynamic += moves;
        around.staying += occupied && !moves && !open;
        around.flickering += moves && isSet(window.flickering, nx, ny, at);
        around.suspected += moves && isSet(window.suspected, nx, ny, at);
      }
    }
  }
  return around;
}

/// The rule of support, one cell after the other.
bool isSupported(const EvidenceWindow& window, int x, int y, int bit, int ground_bit,
                 const AgreementConfig& config) {
  const Around around = look(window, window.suspected, x, y, bit, ground_bit);
  const bool strong = isSet(window.strong, x, y, bit);
  return around.dynamic >= (strong ? config.min_share_strong : config.min_share) * around.occupied;
}

/// The rule of joining, one cell after the other.
bool joins(const EvidenceWindow& window, const BitGrid& dynamic, int x, int y, int bit,
           int ground_bit, const AgreementConfig& config) {
  if (isSet(dynamic, x, y, bit)) return false;
  const bool leaning = isSet(window.leaning, x, y, bit);
  if (!leaning && !isSet(window.unknown, x, y, bit)) return false;
  const auto agree = [&](const Around& around) {
    const double share = leaning ? config.join_share : config.unknown_share;
    return around.dynamic > 0 && around.dynamic >= share * around.occupied;
  };
  const Around far = look(window, dynamic, x, y, bit, ground_bit, 2);
  const bool across_gaps = config.across_gaps && bit > ground_bit && far.staying == 0 &&
                           !(leaning && isSet(window.flickering, x, y, bit)) && agree(far);
  const bool rests_on_what_stays = bit - 1 > ground_bit && isSet(window.occupied, x, y, bit - 1) &&
                                   !isSet(dynamic, x, y, bit - 1);
  return across_gaps ||
         (!rests_on_what_stays && agree(look(window, dynamic, x, y, bit, ground_bit)));
}

/// The rule of flicker, one cell after the other.
bool isFlicker(const EvidenceWindow& window, const BitGrid& dynamic, int x, int y, int bit,
               int ground_bit, const AgreementConfig& config) {
  if (bit <= ground_bit || !isSet(dynamic, x, y, bit)) return false;
  const Around around = look(window, dynamic, x, y, bit, ground_bit);
  const int flickering = around.flickering + isSet(window.flickering, x, y, bit);
  return flickering > config.flicker_share * (around.dynamic + 1) &&
         around.suspected < config.join_share * around.occupied;
}

/// Noise, full columns and blocks.
EvidenceWindow randomWindow(Random& random, int size) {
  EvidenceWindow window = emptyWindow(size);
  const double density = random.pick<double>({0.1, 0.5, 0.9});
  const auto sparse = [&] { return random.chance(density) ? random.bits() : Bits{0}; };
  for (int x = 0; x < size; ++x) {
    for (int y = 0; y < size; ++y) {
      window.occupied.at(x, y) = random.bits() | sparse();
      window.suspected.at(x, y) = sparse() & sparse();
    }
  }
  for (int block = random.integer(0, 4); block > 0; --block) {
    const int x = random.integer(0, size - 1), y = random.integer(0, size - 1);
    const int bit = random.integer(0, kMaxBits - 1);
    set(window.suspected, {x, random.integer(x, size - 1), y, random.integer(y, size - 1), bit,
                           random.integer(bit, kMaxBits - 1)});
  }
  for (int x = 0; x < size; ++x) {
    for (int y = 0; y < size; ++y) {
      window.suspected.at(x, y) &= window.occupied.at(x, y);
      window.strong.at(x, y) = window.suspected.at(x, y) & random.bits();
      window.leaning.at(x, y) = window.occupied.at(x, y) & random.bits();
      window.unknown.at(x, y) = window.occupied.at(x, y) & ~window.leaning.at(x, y) & random.bits();
      window.flickering.at(x, y) = window.occupied.at(x, y) & random.bits();
    }
  }
  return window;
}

/// The same with few cells, of which none but a few in one column stays: as far away.
EvidenceWindow withoutWhatStays(EvidenceWindow window) {
  for (int x = 0; x < window.occupied.size(); ++x) {
    for (int y = 0; y < window.occupied.size(); ++y) {
      Bits& occupied = window.occupied.at(x, y);
      occupied &= window.flickering.at(x, y) | window.strong.at(x, y);
      for (BitGrid* grid : {&window.suspected, &window.strong, &window.leaning, &window.unknown,
                            &window.flickering}) {
        grid->at(x, y) &= occupied;
      }
      const Bits some = x == 0 && y == 0 ? lowBits(20) : Bits{0};
      window.unknown.at(x, y) = occupied & ~window.leaning.at(x, y) & ~some;
      window.flickering.at(x, y) &= ~window.strong.at(x, y);
    }
  }
  return window;
}

TEST(Agreement, AgreesWithLoopsOverTheNeighbours) {
  int supported = 0, unsupported = 0;
  for (std::uint32_t seed = 0; seed < 400; ++seed) {
    Random random(seed);
    const EvidenceWindow window = randomWindow(random, random.integer(1, 9));
    const int ground_bit = random.integer(-1, 40);
    AgreementConfig config;
    config.min_share = random.pick<double>({0.0, 0.25, 0.5, 0.6, 1.0});
    config.min_share_strong = random.pick<double>({0.0, 0.2, 0.5});
    const BitGrid result = unsupportedCells(window, ground_bit, config);
    const int size = window.suspected.size();
    ASSERT_EQ(result.size(), size);
    ASSERT_EQ(result.window().corner, window.suspected.window().corner);
    for (int x = 0; x < size; ++x) {
      for (int y = 0; y < size; ++y) {
        const bool border = x == 0 || y == 0 || x == size - 1 || y == size - 1;
        ASSERT_EQ(result.at(x, y) & ~window.suspected.at(x, y), Bits{0}) << "seed " << seed;
        if (border) {
          ASSERT_EQ(result.at(x, y), Bits{0}) << "seed " << seed;
          continue;
        }
        for (int bit = 0; bit < kMaxBits; ++bit) {
          if (!isSet(window.suspected, x, y, bit)) continue;
          const bool expected = isSupported(window, x, y, bit, ground_bit, config);
          ASSERT_EQ(!isSet(result, x, y, bit), expected)
              << "seed " << seed << " column " << x << ", " << y << " bit " << bit;
          ++(expected ? supported : unsupported);
        }
      }
    }
  }
  EXPECT_GT(supported, 10000);
  EXPECT_GT(unsupported, 10000);
}

TEST(Agreement, JoiningAgreesWithLoopsOverTheNeighbours) {
  int joining = 0, staying = 0;
  for (std::uint32_t seed = 0; seed < 600; ++seed) {
    Random random(seed);
    EvidenceWindow window = randomWindow(random, random.integer(1, 9));
    if (seed % 2 == 1) window = withoutWhatStays(window);
    const int ground_bit = random.integer(-1, 40);
    AgreementConfig config;
    config.unknown_share = random.pick<double>({0.0, 0.25, 0.6, 1.0});
    config.join_share = random.pick<double>({0.0, 0.2, 0.4, 0.8});
    config.join_rounds = 1;
    config.across_gaps = random.chance(0.75);
    BitGrid result = window.suspected;
    growObjects(window, result, ground_bit, config);
    const int size = result.size();
    for (int x = 0; x < size; ++x) {
      for (int y = 0; y < size; ++y) {
        const bool border = x < 2 || y < 2 || x >= size - 2 || y >= size - 2;
        for (int bit = 0; bit < kMaxBits; ++bit) {
          const bool expected =
              !border && joins(window, window.suspected, x, y, bit, ground_bit, config);
          ASSERT_EQ(isSet(result, x, y, bit), expected || isSet(window.suspected, x, y, bit))
              << "seed " << seed << " column " << x << ", " << y << " bit " << bit;
          ++(expected ? joining : staying);
        }
      }
    }
  }
  EXPECT_GT(joining, 5000);
  EXPECT_GT(staying, 10000);
}

TEST(Agreement, WhatIsThinUponASurfaceIsItsNoise) {
  EvidenceWindow window = emptyWindow(9);
  set(window.occupied, {0, 8, 0, 8, kGround, kGround});
  setSuspected(window, {2, 6, 2, 6, kGround + 1, kGround + 2});
  EXPECT_EQ(countOf(surfaceNoise(window, 0)), 0);
  EXPECT_EQ(countOf(surfaceNoise(window, 1)), 0);  // it is thicker
  EXPECT_EQ(countOf(surfaceNoise(window, 2)), 5 * 5 * 2);
  // Upon a roof it is the same.
  set(window.occupied, {0, 8, 0, 8, 30, 30});
  setSuspected(window, {2, 6, 2, 6, 31, 31});
  EXPECT_EQ(countOf(surfaceNoise(window, 1)), 5 * 5);
  EXPECT_EQ(countOf(dynamicCells(window, kGround, {})), 0);
}

TEST(Agreement, WhatReachesHigherOrTouchesNothingIsNoNoise) {
  EvidenceWindow window = emptyWindow(9);
  set(window.occupied, {0, 8, 0, 8, kGround, kGround});
  setSuspected(window, {3, 5, 3, 5, kGround + 1, kGround + 3});
  EXPECT_EQ(countOf(surfaceNoise(window, 2)), 0);
  // Feet, from which beams missed the way up to the body beside them.
  window = emptyWindow(9);
  set(window.occupied, {0, 8, 0, 8, kGround, kGround});
  setSuspected(window, {4, 4, 4, 4, kGround + 1, kGround + 1});
  setSuspected(window, {5, 5, 4, 4, kGround + 4, kGround + 8});
  EXPECT_EQ(countOf(surfaceNoise(window, 2)), 0);
  // In free space.
  window = emptyWindow(9);
  setSuspected(window, {3, 5, 3, 5, kGround + 3, kGround + 3});
  EXPECT_EQ(countOf(surfaceNoise(window, 2)), 0);
}

TEST(Agreement, ThinLayersOverheadAreNoise) {
  const AgreementConfig config;  // two bits thick, ten bits above the ground
  const int high = kGround + config.overhead_bits;
  EvidenceWindow window = emptyWindow(9);
  setSuspected(window, {2, 6, 2, 6, high, high + 1});
  EXPECT_EQ(countOf(overheadNoise(window, kGround, config)), 5 * 5 * 2);
  EXPECT_EQ(countOf(dynamicCells(window, kGround, config)), 0);
  // What moves below it is as thick as before, and no reason to remove the ceiling.
  setSuspected(window, {3, 4, 3, 4, kGround + 1, high - 5});
  EXPECT_EQ(countOf(overheadNoise(window, kGround, config)), 5 * 5 * 2);
  // A bus, of which beams missed the middle.
  window = emptyWindow(9);
  setSuspected(window, {2, 6, 2, 6, high - 3, high - 3});
  setSuspected(window, {2, 6, 2, 6, high, high});
  EXPECT_EQ(countOf(overheadNoise(window, kGround, config)), 0);
  // Lower layers may be the far parts of objects.
  window = emptyWindow(9);
  setSuspected(window, {2, 6, 2, 6, high - 1, high - 1});
  EXPECT_EQ(countOf(overheadNoise(window, kGround, config)), 0);
  AgreementConfig off;
  off.surface_bits = 0;
  setSuspected(window, {2, 6, 2, 6, high, high});
  EXPECT_EQ(countOf(overheadNoise(window, kGround, off)), 0);
  off = config;
  off.overhead_bits = 64;
  EXPECT_EQ(countOf(overheadNoise(window, kGround, off)), 0);
}

/// The rule of noise, one cell after the other.
bool isNoise(const EvidenceWindow& window, int x, int y, int bit, int surface_bits) {
  int height = 0;  // of the cell above the surface that stays
  while (bit - height >= 0 && isSet(window.suspected, x, y, bit - height)) ++height;
  if (height == 0 || height > surface_bits) return false;
  const int surface = bit - height;
  if (!isSet(window.occupied, x, y, surface) || isSet(window.leaning, x, y, surface)) return false;
  const int first_above = surface + surface_bits + 1;
  for (int nx = x - 1; nx <= x + 1; ++nx) {
    for (int ny = y - 1; ny <= y + 1; ++ny) {
      for (int at = first_above; at < first_above + 3; ++at) {
        if (isSet(window.suspected, nx, ny, at)) return false;
      }
    }
  }
  return true;
}

TEST(Agreement, SurfaceNoiseAgreesWithLoopsOverTheNeighbours) {
  int noise = 0, others = 0;
  for (std::uint32_t seed = 0; seed < 300; ++seed) {
    Random random(seed);
    const EvidenceWindow window = randomWindow(random, random.integer(1, 9));
    const int surface_bits = random.integer(0, 4);
    const BitGrid result = surfaceNoise(window, surface_bits);
    const int size = result.size();
    for (int x = 0; x < size; ++x) {
      for (int y = 0; y < size; ++y) {
        const bool border = x == 0 || y == 0 || x == size - 1 || y == size - 1;
        for (int bit = 0; bit < kMaxBits; ++bit) {
          const bool expected = !border && isNoise(window, x, y, bit, surface_bits);
          ASSERT_EQ(isSet(result, x, y, bit), expected)
              << "seed " << seed << " column " << x << ", " << y << " bit " << bit;
          ++(expected ? noise : others);
        }
      }
    }
  }
  EXPECT_GT(noise, 200);
  EXPECT_GT(others, 10000);
}

/// A car of which only the outline was seen free.
EvidenceWindow carThatLeft() {
  EvidenceWindow window = emptyWindow(20);
  set(window.occupied, {0, 19, 0, 19, kGround, kGround});
  setSuspected(window, {4, 14, 4, 13, kGround + 1, kGround + 6});
  const Cells inside{6, 12, 6, 11, kGround + 1, kGround + 4};
  for (int x = inside.x_low; x <= inside.x_high; ++x) {
    for (int y = inside.y_low; y <= inside.y_high; ++y) {
      window.suspected.at(x, y) &= ~(lowBits(inside.bit_high + 1) & ~lowBits(inside.bit_low));
    }
  }
  set(window.leaning, inside);
  return window;
}

TEST(Agreement, AnObjectGrowsOverItsLeaningCells) {
  EvidenceWindow window = carThatLeft();
  AgreementConfig config;
  const int car = 11 * 10 * 6, inside = 7 * 6 * 4;
  EXPECT_EQ(countOf(dynamicCells(window, kGround, config)), car);
  config.join_rounds = 0;
  EXPECT_EQ(countOf(dynamicCells(window, kGround, config)), car - inside);
  config.join_rounds = 1;
  const int after_one = countOf(dynamicCells(window, kGround, config));
  EXPECT_GT(after_one, car - inside);
  EXPECT_LT(after_one, car);
  // Cells that nothing speaks for do not join; the two upon them are then noise of theirs.
  window.leaning = BitGrid(window.leaning.window(), 0);
  EXPECT_EQ(countOf(dynamicCells(window, kGround, config)), car - inside - 7 * 6 * 2);
}

TEST(Agreement, UnknownAndLeaningCellsHaveSharesOfTheirOwn) {
  // A far object of which the beams saw one row free: 3 of 8 neighbours of the next are dynamic.
  EvidenceWindow window = emptyWindow(9);
  setSuspected(window, {4, 4, 2, 6, 20, 20});
  set(window.occupied, {4, 4, 2, 6, 21, 22});
  EvidenceWindow leaning = window;
  set(window.unknown, {4, 4, 2, 6, 21, 21});
  set(leaning.leaning, {4, 4, 2, 6, 21, 21});
  AgreementConfig config;
  config.join_rounds = 1;
  config.unknown_share = 0.3;
  config.join_share = 0.4;
  BitGrid of_unknown = window.suspected, of_leaning = leaning.suspected;
  growObjects(window, of_unknown, kGround, config);
  growObjects(leaning, of_leaning, kGround, config);
  EXPECT_NE(of_unknown.at(4, 4) >> 21 & 1, Bits{0});
  EXPECT_EQ(of_leaning.at(4, 4) >> 21 & 1, Bits{0});
}

TEST(Agreement, WhatRestsOnACellThatStaysDoesNotJoin) {
  // Seen over the roof of a parked car, beside one that drove by.
  EvidenceWindow window = emptyWindow(12);
  setSuspected(window, {2, 4, 4, 6, kGround + 1, kGround + 8});
  set(window.occupied, {5, 5, 4, 6, kGround + 1, kGround + 7});
  set(window.leaning, {5, 5, 4, 6, kGround + 7, kGround + 7});
  EXPECT_EQ(dynamicCells(window, kGround, {}).at(5, 5), Bits{0});
  window.leaning = window.occupied;  // nothing below stays
  EXPECT_NE(dynamicCells(window, kGround, {}).at(5, 5), Bits{0});
}

TEST(Agreement, AnObjectGrowsAcrossGapsWhereNothingStays) {
  // A far object of which a scan hits every second row of cells, each by one beam.
  EvidenceWindow window = emptyWindow(9);
  setSuspected(window, {4, 4, 3, 5, kGround + 2, kGround + 2});
  const Cells row_above{4, 4, 3, 5, kGround + 4, kGround + 4};
  set(window.occupied, row_above);
  set(window.unknown, row_above);
  EXPECT_EQ(countOf(dynamicCells(window, kGround, {})), 6);
  AgreementConfig without;
  without.across_gaps = false;
  EXPECT_EQ(countOf(dynamicCells(window, kGround, without)), 3);
  // Beside a wall the beams say too little.
  EvidenceWindow at_wall = window;
  set(at_wall.occupied, {6, 6, 3, 5, kGround + 4, kGround + 4});
  EXPECT_EQ(countOf(dynamicCells(at_wall, kGround, {})), 3);
  // The ground is no reason to doubt.
  set(window.occupied, {0, 8, 0, 8, kGround, kGround});
  EXPECT_EQ(countOf(dynamicCells(window, kGround, {})), 6);
  // What leans joins as well, if it does not flicker.
  window.unknown = emptyWindow(9).unknown;
  set(window.leaning, row_above);
  EXPECT_EQ(countOf(dynamicCells(window, kGround, {})), 6);
  set(window.flickering, row_above);
  EXPECT_EQ(countOf(dynamicCells(window, kGround, {})), 3);
}

TEST(Agreement, FlickeringEdgesAreTakenAway) {
  // Beams pass a bush: its cells flicker, a few were seen free so often that they are held for
  // dynamic.
  EvidenceWindow window = emptyWindow(30);
  const Cells bush{13, 16, 13, 16, kGround + 1, kGround + 4};
  set(window.occupied, bush);
  set(window.leaning, bush);
  set(window.flickering, bush);
  setSuspected(window, {13, 14, 14, 15, kGround + 4, kGround + 4});
  window.strong = window.suspected;
  AgreementConfig config;
  EXPECT_EQ(countOf(dynamicCells(window, kGround, config)), 0);
  config.flicker_share = 1.0;
  EXPECT_EQ(countOf(dynamicCells(window, kGround, config)), 2);
  // What its own evidence holds for dynamic is not taken away for some that flicker.
  setSuspected(window, bush);
  EXPECT_EQ(countOf(dynamicCells(window, kGround, {})), 4 * 4 * 4);
}

TEST(Agreement, FlickerAgreesWithLoopsOverTheNeighbours) {
  int flicker = 0, others = 0;
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    Random random(seed);
    const EvidenceWindow window = randomWindow(random, random.integer(1, 9));
    const int ground_bit = random.integer(-1, 40);
    AgreementConfig config;
    config.flicker_share = random.pick<double>({0.0, 0.3, 0.5, 1.0});
    config.join_share = random.pick<double>({0.2, 0.4, 0.8});
    BitGrid result = window.occupied, expected = window.occupied;
    excludeFlicker(window, result, ground_bit, config);
    for (int round = 0; round < 3; ++round) {
      const BitGrid before = expected;
      for (int x = 1; x + 1 < before.size(); ++x) {
        for (int y = 1; y + 1 < before.size(); ++y) {
          for (int bit = 0; bit < kMaxBits; ++bit) {
            if (!isFlicker(window, before, x, y, bit, ground_bit, config)) continue;
            expected.at(x, y) &= ~(Bits{1} << bit);
            ++flicker;
          }
        }
      }
    }
    for (int x = 0; x < result.size(); ++x) {
      for (int y = 0; y < result.size(); ++y) {
        ASSERT_EQ(result.at(x, y), expected.at(x, y)) << "seed " << seed;
      }
    }
    others += countOf(expected);
  }
  EXPECT_GT(flicker, 5000);
  EXPECT_GT(others, 5000);
}

TEST(Agreement, CellsInsideTheMarginDoNotDependOnWhatIsOutside) {
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    Random random(seed);
    AgreementConfig config;
    config.join_rounds = random.integer(0, 3);
    const int margin = agreementMargin(config);
    const int inner = random.integer(1, 5), outer = inner + 2 * margin + 2;
    const EvidenceWindow large = randomWindow(random, outer);
    const auto cut = [&](const BitGrid& grid) {
      BitGrid part(ColumnWindow{{0, 0}, outer - 2}, 0);
      for (int x = 0; x < part.size(); ++x) {
        for (int y = 0; y < part.size(); ++y) part.at(x, y) = grid.at(x + 1, y + 1);
      }
      return part;
    };
    const EvidenceWindow small{cut(large.occupied), cut(large.suspected), cut(large.strong),
                               cut(large.leaning),  cut(large.unknown),   cut(large.flickering)};
    const BitGrid of_large = dynamicCells(large, kGround, config);
    const BitGrid of_small = dynamicCells(small, kGround, config);
    for (int x = margin; x < margin + inner; ++x) {
      for (int y = margin; y < margin + inner; ++y) {
        ASSERT_EQ(of_small.at(x, y), of_large.at(x + 1, y + 1)) << "seed " << seed;
      }
    }
  }
}

TEST(Agreement, WindowsWithoutAnInsideHaveNoCells) {
  for (const int size : {0, 1, 2}) {
    EvidenceWindow window = emptyWindow(size);
    if (size > 0) setSuspected(window, {0, size - 1, 0, size - 1, 0, 63});
    EXPECT_EQ(countOf(unsupportedCells(window, kGround, {})), 0);
  }
}

}  // namespace
}  // namespace beautymap
