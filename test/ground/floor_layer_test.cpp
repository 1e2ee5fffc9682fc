// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/ground/floor_layer.h"

#include <gtest/gtest.h>

#include <vector>

#include "beautymap/matrix/binary_encoding.h"
#include "test_scenes.h"

namespace beautymap {
namespace {

using test::Random;

constexpr int kGround = 8;

FloorLayer defaultLayer() { return {GroundLayerConfig(), MatrixConfig()}; }

TEST(FloorLayer, ASurfaceStaysAndWhatIsAboveItDoesNot) {
  const FloorLayer layer = defaultLayer();
  EXPECT_EQ(layer.staticBins({0, 900, 400, 0, 3, 3, 4, 2}), 3);
  // An object as dense as the surface of a deck that was seen less often.
  EXPECT_EQ(layer.staticBins({0, 90, 4, 8, 8, 8, 8, 8}), 2);
  // Noise is part of the surface as far as the counts fall off, but not for ever.
  EXPECT_EQ(layer.staticBins({900, 800, 700, 500, 200, 90, 0, 1}), 6);
  EXPECT_EQ(layer.staticBins({9000, 1000, 1000, 1000, 1000, 1000, 1000, 900}), 7);
}

TEST(FloorLayer, WithoutASurfaceTheWholeCellStays) {
  const FloorLayer layer = defaultLayer();
  EXPECT_EQ(layer.staticBins({}), FloorCell::kBins) << "nothing counted yet";
  EXPECT_EQ(layer.staticBins({50, 3, 50, 50, 50, 50, 50, 50}), FloorCell::kBins) << "a wall";
  EXPECT_EQ(layer.staticBins({0, 0, 0, 0, 0, 0, 0, 50}), FloorCell::kBins) << "at the upper end";
}

TEST(FloorLayer, AFloorIsTheLowestStayingCellBelowADynamicOneAboveTheGround) {
  const auto bit = [](int at) { return Bits{1} << at; };
  const Bits occupied = bit(8) | bit(9) | bit(20) | bit(21) | bit(30) | bit(31);
  EXPECT_EQ(floorBit(occupied, bit(21) | bit(31), kGround), 20);
  EXPECT_EQ(floorBit(occupied, bit(20) | bit(21), kGround), -1);
  EXPECT_EQ(floorBit(occupied, bit(9), kGround), -1) << "the ground has a layer of its own";
  EXPECT_EQ(floorBit(occupied, 0, kGround), -1);
  EXPECT_EQ(floorBit(bit(63), 0, kGround), -1) << "nothing is above the highest bit";
  EXPECT_EQ(floorBit(bit(62) | bit(63), bit(63), kGround), 62);
}

TEST(FloorLayer, BinsDivideTheCellsOfTheEncoding) {
  for (const double res_h : {0.05, 0.2, 0.37}) {
    MatrixConfig matrix;
    matrix.res_h = res_h;
    matrix.n_bit = 40;
    const FloorLayer layer({}, matrix);
    const BinaryEncoding encoding(matrix);
    Random random(1);
    for (int i = 0; i < 20000; ++i) {
      const auto ground = static_cast<float>(random.uniform(-50.0, 50.0));
      const auto z = static_cast<float>(ground + random.uniform(-1.0, 60.0 * res_h));
      const int bin = layer.binOf(z, ground);
      const int bit = encoding.bitIndex(z, ground);
      if (bit == matrix.n_bit - 1) continue;  // it also holds all that is higher
      ASSERT_EQ(bin < 0 ? -1 : bin / FloorCell::kBins, bit) << z << " over " << ground;
    }
    EXPECT_EQ(layer.binOf(test::kNan, 0.0F), -1);
    EXPECT_EQ(layer.binOf(0.0F, Tile::kNoHeight), -1);
    EXPECT_EQ(layer.binOf(test::kInfinity, 0.0F), 40 * FloorCell::kBins);
  }
}

}  // namespace
}  // namespace beautymap
