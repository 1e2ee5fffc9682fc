// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/offline/pictures.h"

#include <png.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "../base/vector_clones.h"
#include "beautymap/io/new_file.h"
#include "beautymap/io/scan_source.h"

namespace beautymap {
namespace {

constexpr int kMaxSide = 1600;        // [pixels]
constexpr double kFinestPixel = 0.1;  // [m]
constexpr Color kBlue{8, 48, 140};
constexpr Color kGrey{150, 150, 150};
constexpr Color kRemovedColor{214, 39, 40};
constexpr Color kWronglyRemovedColor{255, 127, 14};
constexpr Color kMissedColor{227, 26, 200};

/// A color for each number of points: darker with more, on a logarithmic scale.
std::array<Color, 256> shades(Color dark) {
  std::array<Color, 256> colors;
  for (std::size_t count = 1; count < colors.size(); ++count) {
    const double share = std::min(1.0, 0.35 + 0.13 * std::log2(static_cast<double>(count)));
    const auto mix = [share](std::uint8_t channel) {
      return static_cast<std::uint8_t>(255.0 - share * (255.0 - channel));
    };
    colors[count] = {mix(dark.r), mix(dark.g), mix(dark.b)};
  }
  return colors;
}

/// Purple over green to yellow, close to matplotlib's viridis.
Color heat(double share) {
  constexpr double kStops[5][3] = {
      {68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {253, 231, 37}};
  const double position = std::clamp(share, 0.0, 1.0) * 4.0;
  const int stop = std::min(3, static_cast<int>(position));
  const double rest = position - stop;
  const auto channel = [&](int c) {
    return static_cast<std::uint8_t>(kStops[stop][c] +
                                     rest * (kStops[stop + 1][c] - kStops[stop][c]));
  };
  return {channel(0), channel(1), channel(2)};
}

}  // namespace

void Picture::writePng(const std::string& path) const {
  static_assert(sizeof(Color) == 3, "rows are handed to libpng as they are");
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width_);
  image.height = static_cast<png_uint_32>(height_);
  image.format = PNG_FORMAT_RGB;
  image.flags = PNG_IMAGE_FLAG_FAST;
  NewFile file(path);
  if (!png_image_write_to_stdio(&image, file.stream(), 0, pixels_.data(), 0, nullptr)) {
    throw InputError("cannot write " + path + ": " + image.message);
  }
  file.commit();
}

TopView::TopView(const Eigen::Vector2d& corner, const Eigen::Vector2d& extent)
    : corner_(corner),
      metres_per_pixel_(std::max(kFinestPixel, extent.maxCoeff() / kMaxSide)),
      pixels_per_metre_(1.0 / metres_per_pixel_),
      width_(std::max(1, static_cast<int>(std::ceil(extent.x() / metres_per_pixel_)))),
      height_(std::max(1, static_cast<int>(std::ceil(extent.y() / metres_per_pixel_)))),
      blocks_per_row_((width_ + 7) / 8),
      pixels_(indexOf(0, height_ + 3) + 1) {}

BEAUTYMAP_VECTOR_CLONES
void TopView::findPixels(const Eigen::Vector3d* points, std::size_t count,
                         std::uint32_t* pixels) const {
  for (std::size_t i = 0; i < count; ++i) pixels[i] = pixelOf(points[i]);
}

void TopView::add(const TopView& other) {
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    const Pixel& added = other.pixels_[i];
    pixels_[i].kept = static_cast<std::uint8_t>(std::min(255, pixels_[i].kept + added.kept));
    pixels_[i].marks |= added.marks;
  }
}

template <typename F>
Picture TopView::draw(F color) const {
  Picture picture(width_, height_);
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      picture.at(x, y) = color(pixels_[indexOf(x, y)]);
    }
  }
  return picture;
}

Picture TopView::before() const {
  const auto blue = shades(kBlue);
  return draw(
      [&](const Pixel& p) { return (p.marks & kRemoved) != 0 ? kRemovedColor : blue[p.kept]; });
}

Picture TopView::after() const {
  const auto blue = shades(kBlue);
  return draw([&](const Pixel& p) { return blue[p.kept]; });
}

Picture TopView::mistakes() const {
  const auto grey = shades(kGrey);
  return draw([&](const Pixel& p) {
    if ((p.marks & kKeptMoving) != 0) return kMissedColor;
    if ((p.marks & kRemovedStatic) != 0) return kWronglyRemovedColor;
    return grey[p.kept];
  });
}

Picture drawMatrix(const TileMap& map) {
  ColumnIndex low{INT32_MAX, INT32_MAX}, high{INT32_MIN, INT32_MIN};
  int highest = 1;
  map.forEachTile([&](ColumnIndex index, const Tile& tile) {
    low = {std::min(low.x, index.x), std::min(low.y, index.y)};
    high = {std::max(high.x, index.x), std::max(high.y, index.y)};
    for (const Bits column : tile.occupied) {
      if (column != 0) highest = std::max(highest, highestBitIndex(column));
    }
  });
  if (map.tileCount() == 0) return Picture(1, 1);
  const int tiles = std::max(high.x - low.x, high.y - low.y) + 1;
  // Far apart maps shrink: one pixel then stands for several columns.
  const int step = 1 + tiles * Tile::kSide / (2 * kMaxSide);
  Picture picture((high.x - low.x + 1) * Tile::kSide / step + 1,
                  (high.y - low.y + 1) * Tile::kSide / step + 1);
  map.forEachTile([&](ColumnIndex index, const Tile& tile) {
    for (int i = 0; i < Tile::kColumns; ++i) {
      const Bits column = tile.occupied[static_cast<std::size_t>(i)];
      if (column == 0) continue;
      const int x = ((index.x - low.x) * Tile::kSide + (i >> Tile::kShift)) / step;
      const int y = ((index.y - low.y) * Tile::kSide + (i & (Tile::kSide - 1))) / step;
      picture.at(x, y) = tile.dynamic[static_cast<std::size_t>(i)] != 0
                             ? kRemovedColor
                             : heat(static_cast<double>(highestBitIndex(column)) / highest);
    }
  });
  return picture;
}

}  // namespace beautymap
