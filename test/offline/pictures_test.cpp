// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/offline/pictures.h"

#include <gtest/gtest.h>
#include <png.h>

#include <string>
#include <vector>

#include "beautymap/io/scan_source.h"
#include "offline/offline_test_helpers.h"

namespace beautymap {
namespace {

bool isWhite(const Color& c) { return c.r == 255 && c.g == 255 && c.b == 255; }
bool isReddish(const Color& c) { return c.r > 150 && c.g < 100 && c.b < 100; }
bool isBluish(const Color& c) { return c.b > c.r && c.b > c.g; }
bool isGrey(const Color& c) { return c.r == c.g && c.g == c.b && c.r < 255; }
bool isOrange(const Color& c) { return c.r > 200 && c.g > 80 && c.g < 200 && c.b < 80; }
bool isMagenta(const Color& c) { return c.r > 180 && c.g < 80 && c.b > 120; }

/// 20 x 10 m with pixels of 0.1 m; its corner at (-5, 100).
TopView smallView() { return TopView({-5.0, 100.0}, {20.0, 10.0}); }

/// The pixel of a position in smallView().
Color& pixelAt(Picture& picture, double x, double y) {
  return picture.at(static_cast<int>((x + 5.0) / 0.1), static_cast<int>((y - 100.0) / 0.1));
}

TEST(Picture, RowsAreWrittenFromTopToBottom) {
  const test::OutputFolder folder;
  Picture picture(3, 2);
  picture.at(0, 0) = {1, 2, 3};
  picture.at(2, 1) = {4, 5, 6};
  picture.writePng(folder.file("p.png"));
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_file(&image, folder.file("p.png").c_str()));
  image.format = PNG_FORMAT_RGB;
  ASSERT_EQ(image.width, 3U);
  ASSERT_EQ(image.height, 2U);
  std::vector<std::uint8_t> rgb(PNG_IMAGE_SIZE(image));
  ASSERT_TRUE(png_image_finish_read(&image, nullptr, rgb.data(), 0, nullptr));
  // The upper row first, so that +y is up: (2, 1) is the last pixel of the first row.
  const std::vector<std::uint8_t> expected{255, 255, 255, 255, 255, 255, 4,   5,   6,
                                           1,   2,   3,   255, 255, 255, 255, 255, 255};
  EXPECT_EQ(rgb, expected);
  EXPECT_EQ(folder.names(), std::set<std::string>{"p.png"}) << "no unfinished file is left";
}

TEST(Picture, AFileThatCannotBeWrittenIsNamed) {
  try {
    Picture(2, 2).writePng("/does/not/exist/p.png");
    FAIL() << "nothing was thrown";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("/does/not/exist/p.png"), std::string::npos);
  }
}

TEST(TopView, ColoursSayWhatBecameOfThePoints) {
  TopView view = smallView();
  view.add({0.05, 101.05, 0.0}, false, false);  // kept
  view.add({1.05, 101.05, 0.0}, true, true);    // a ghost, removed
  view.add({2.05, 101.05, 0.0}, true, false);   // removed by mistake
  view.add({3.05, 101.05, 0.0}, false, true);   // a ghost, missed
  Picture before = view.before(), after = view.after(), mistakes = view.mistakes();
  EXPECT_TRUE(isBluish(pixelAt(before, 0.05, 101.05)));
  EXPECT_TRUE(isReddish(pixelAt(before, 1.05, 101.05)));
  EXPECT_TRUE(isReddish(pixelAt(before, 2.05, 101.05)));
  EXPECT_TRUE(isBluish(pixelAt(after, 0.05, 101.05)));
  EXPECT_TRUE(isWhite(pixelAt(after, 1.05, 101.05)));
  EXPECT_TRUE(isWhite(pixelAt(after, 2.05, 101.05)));
  EXPECT_TRUE(isBluish(pixelAt(after, 3.05, 101.05)));
  EXPECT_TRUE(isGrey(pixelAt(mistakes, 0.05, 101.05)));
  EXPECT_TRUE(isWhite(pixelAt(mistakes, 1.05, 101.05))) << "removed as it should be";
  EXPECT_TRUE(isOrange(pixelAt(mistakes, 2.05, 101.05)));
  EXPECT_TRUE(isMagenta(pixelAt(mistakes, 3.05, 101.05)));
  EXPECT_TRUE(isWhite(pixelAt(before, 4.05, 101.05))) << "no point";
}

TEST(TopView, RemovedPointsLieOnTopOfKeptOnes) {
  TopView view = smallView();
  for (int i = 0; i < 100; ++i) view.add({0.05, 101.05, 0.0}, false, false);
  view.add({0.05, 101.05, 3.0}, true, false);
  Picture before = view.before();
  EXPECT_TRUE(isReddish(pixelAt(before, 0.05, 101.05)));
}

TEST(TopView, ViewsOfSomePointsEachAddUpToTheViewOfAll) {
  TopView all = smallView(), parts[2] = {smallView(), smallView()};
  test::Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector3d point(random.uniform(-5, -2), random.uniform(100, 101), 0.0);
    const bool removed = random.chance(0.001), moving = random.chance(0.001);
    all.add(point, removed, moving);
    parts[random.chance(0.5)].add(point, removed, moving);
  }
  for (int i = 0; i < 1000; ++i) {
    all.add({0.05, 105.0, 0.0}, false, false);  // more than a pixel counts
    parts[i % 2].add({0.05, 105.0, 0.0}, false, false);
  }
  parts[0].add(parts[1]);
  const test::OutputFolder folder;
  const auto bytes = [&](const Picture& picture) {
    picture.writePng(folder.file("p.png"));
    return test::bytesOf(folder.file("p.png"));
  };
  EXPECT_EQ(bytes(all.before()), bytes(parts[0].before()));
  EXPECT_EQ(bytes(all.after()), bytes(parts[0].after()));
  EXPECT_EQ(bytes(all.mistakes()), bytes(parts[0].mistakes()));
}

TEST(TopView, MorePointsAreDarker) {
  TopView view = smallView();
  view.add({0.05, 101.05, 0.0}, false, false);
  for (int i = 0; i < 10; ++i) view.add({1.05, 101.05, 0.0}, false, false);
  Picture after = view.after();
  EXPECT_LT(pixelAt(after, 1.05, 101.05).r, pixelAt(after, 0.05, 101.05).r);
}

TEST(TopView, CoversItsExtentAndIgnoresWhatLiesOutside) {
  TopView view = smallView();
  for (const double x : {-5.5, 15.5, 1e12, -1e12}) view.add({x, 101.0, 0.0}, false, false);
  for (const double y : {99.5, 110.5, 1e300, -1e300}) view.add({0.0, y, 0.0}, false, false);
  Picture after = view.after();
  EXPECT_NEAR(after.width(), 200, 1) << "20 / 0.1 may be rounded up";
  EXPECT_NEAR(after.height(), 100, 1);
  for (int x = 0; x < after.width(); ++x) {
    for (int y = 0; y < after.height(); ++y) ASSERT_TRUE(isWhite(after.at(x, y))) << x << ' ' << y;
  }
}

TEST(TopView, PicturesOfLargeMapsStaySmall) {
  const TopView view({-1e6, 0.0}, {3e6, 10.0});
  const Picture before = view.before();
  EXPECT_LE(before.width(), 2000);
  EXPECT_GE(before.width(), 1000);
  EXPECT_GE(before.height(), 1);
  EXPECT_NEAR(view.metresPerPixel() * before.width(), 3e6, view.metresPerPixel());
}

TEST(DrawMatrix, ShowsEachColumnAndWhatWasRemovedInRed) {
  TileMap map(1);
  Tile& tile = map.tileAt({-1, 2});
  tile.occupied[0] = 1;                                  // column (0, 0) of the tile
  tile.occupied[3 << Tile::kShift | 5] = Bits{1} << 40;  // column (3, 5)
  tile.occupied[31 << Tile::kShift | 31] = 3;            // column (31, 31)
  tile.dynamic[31 << Tile::kShift | 31] = 2;
  Picture picture = drawMatrix(map);
  EXPECT_GE(picture.width(), Tile::kSide);
  EXPECT_FALSE(isWhite(picture.at(0, 0)));
  EXPECT_FALSE(isReddish(picture.at(0, 0)));
  EXPECT_GT(picture.at(3, 5).r + picture.at(3, 5).g, 400) << "the highest column is yellow";
  EXPECT_TRUE(isReddish(picture.at(31, 31)));
  EXPECT_TRUE(isWhite(picture.at(1, 0)));
}

TEST(DrawMatrix, AnEmptyMapIsAnEmptyPicture) {
  Picture picture = drawMatrix(TileMap(1));
  EXPECT_TRUE(isWhite(picture.at(0, 0)));
}

TEST(DrawMatrix, MapsOnBothSidesOfTheWorldFit) {
  TileMap map(1);
  map.tileAt({-31250000, 0}).occupied[0] = 1;
  map.tileAt({31249999, 0}).occupied[0] = 1;
  Picture picture = drawMatrix(map);
  EXPECT_LE(picture.width(), 4000);
  EXPECT_FALSE(isWhite(picture.at(0, 0)));
}

}  // namespace
}  // namespace beautymap
