// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/evidence/ground_under_objects.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "beautymap/evidence/evidence_tile.h"
#include "ground/whole_bins.h"
#include "test_scenes.h"

namespace beautymap {
namespace {

using test::kCell;
using test::Random;
using test::randomCount;
using test::WholeBins;

TEST(GroundUnderObjects, EachColumnOfAMapGetsItsOwn) {
  Random random(7);
  const WholeBins whole(random);
  const GroundLayer layer(whole.config, kCell);
  TileMap map(layer.bins(), std::make_unique<EvidenceTile>());
  for (const ColumnIndex tile : {ColumnIndex{0, 0}, ColumnIndex{-3, 5}}) {
    for (std::uint32_t& count : map.tileAt(tile).fine_counts) count = randomCount(random);
  }
  constexpr int kGroundBit = 8;
  map.forEachTile([&](ColumnIndex, Tile& tile) {
    for (std::size_t i = 0; i < tile.dynamic.size(); ++i) {
      tile.dynamic[i] = Bits{1} << (kGroundBit + random.integer(1, 2));
      evidenceTile(tile).evidence.touch(i).observe(Bits{1} << kGroundBit, 0);
      for (int free = random.integer(0, 3); free > 0; --free) {
        evidenceTile(tile).evidence.touch(i).observe(0, Bits{1} << kGroundBit);
      }
    }
    findGroundLayers(tile, layer, kGroundBit, EvidenceConfig());
  });
  int tiles = 0, objects = 0;
  map.forEachTile([&](ColumnIndex, const Tile& tile) {
    ++tiles;
    for (std::size_t i = 0; i < tile.static_bins.size(); ++i) {
      const std::size_t first = i * static_cast<std::size_t>(layer.bins());
      const std::uint32_t* counts = tile.fine_counts.data() + first;
      const bool object_above = tile.dynamic[i] == Bits{1} << (kGroundBit + 1);
      const bool object = object_above &&
                          evidenceTile(tile).evidence[i].freeAfter(kGroundBit) > 1 &&
                          !layer.standsOut(counts);
      ASSERT_EQ(tile.static_bins[i], object ? 0 : whole.groundBins(counts, object_above));
      objects += object ? 1 : 0;
    }
  });
  EXPECT_EQ(tiles, 2);
  EXPECT_GT(objects, 50);
}

/// A column whose cells were hit in so many scans, from the ground cell up.
ColumnEvidence hitColumn(int ground_bit, const std::vector<int>& hits) {
  ColumnEvidence evidence;
  for (int scan = 0; scan < *std::max_element(hits.begin(), hits.end()); ++scan) {
    Bits hit = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
      if (scan < hits[i]) hit |= Bits{1} << (static_cast<std::size_t>(ground_bit) + i);
    }
    evidence.observe(hit, 0);
  }
  return evidence;
}

TEST(GroundUnderObjects, TheLowestCellOfATallObjectMayBeTheObjectsWhereItWasHitAsSeldom) {
  constexpr int kGroundBit = 8;
  const EvidenceConfig config;
  const Bits tall = Bits{0x3E} << kGroundBit;  // five cells above the ground cell
  const auto may_be_object = [&](const std::vector<int>& hits, Bits dynamic) {
    return mayBeObject(hitColumn(kGroundBit, hits), dynamic, 4.0, kGroundBit, config);
  };
  EXPECT_TRUE(may_be_object({3, 3, 3, 3, 3, 2}, tall));
  EXPECT_FALSE(may_be_object({12, 3, 3, 3, 3, 2}, tall))
      << "the ground was hit four times as often";
  EXPECT_FALSE(may_be_object({3, 3, 12, 3, 3, 2}, tall)) << "noise of the poses lifts it";
  EXPECT_FALSE(may_be_object({3, 3, 3}, Bits{0x6} << kGroundBit)) << "only noise is so low";
  EXPECT_FALSE(may_be_object({13, 9, 9, 9, 9, 9}, tall)) << "it is well known";
}

TEST(GroundUnderObjects, StrongEvidenceIsEnoughForTheLowestCellToBeOfAnObject) {
  ColumnEvidence evidence;
  evidence.observe(1, 0);
  for (int scan = 0; scan < 2; ++scan) evidence.observe(0, 1);
  EXPECT_TRUE(mayBeObject(evidence, 2, 4.0, 0, EvidenceConfig()));
}

}  // namespace
}  // namespace beautymap
