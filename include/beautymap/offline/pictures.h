// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "beautymap/matrix/tile_map.h"

namespace beautymap {

struct Color {
  std::uint8_t r = 255, g = 255, b = 255;
};

/// An RGB image with the map's +x to the right and +y up.
class Picture {
 public:
  Picture(int width, int height)
      : width_(width), height_(height), pixels_(static_cast<std::size_t>(width) * height) {}
  int width() const { return width_; }
  int height() const { return height_; }
  Color& at(int x, int y_up) {
    return pixels_[static_cast<std::size_t>(height_ - 1 - y_up) * width_ + x];
  }
  /// @throws InputError when the file cannot be written; it is written beside its target and
  /// renamed.
  void writePng(const std::string& path) const;

 private:
  int width_, height_;
  std::vector<Color> pixels_;
};

/// Counts points per pixel of a top view, and draws them.
class TopView {
 public:
  /// @param corner, extent  of the area that is shown, in the map frame [m]
  TopView(const Eigen::Vector2d& corner, const Eigen::Vector2d& extent);

  /// @param moving  the point's label, false where there are none
  void add(const Eigen::Vector3d& point, bool removed, bool moving) {
    add(pixelOf(point), removed, moving);
  }
  /// The same in two steps. Pixels are far from each other in memory: one loop that finds those of
  /// some points and another that adds to them wait for several at once.
  void findPixels(const Eigen::Vector3d* points, std::size_t count, std::uint32_t* pixels) const;
  void add(std::uint32_t pixel_index, bool removed, bool moving) {
    Pixel& pixel = pixels_[pixel_index];
    if (!removed) pixel.kept = static_cast<std::uint8_t>(pixel.kept + (pixel.kept < 255));
    if (removed || moving) mark(pixel, removed, moving);
  }
  /// Adds the points of another view of the same area.
  void add(const TopView& other);

  /// Static points blue, removed ones red on top of them.
  Picture before() const;
  /// What is left.
  Picture after() const;
  /// Against the labels: removed by mistake orange, missed ghosts magenta, the rest grey.
  Picture mistakes() const;
  double metresPerPixel() const { return metres_per_pixel_; }

 private:
  /// Small, as points come in any order and wait for their pixel.
  struct Pixel {
    std::uint8_t kept = 0;   ///< points; the largest number also stands for more
    std::uint8_t marks = 0;  ///< kRemoved and so on
  };
  static constexpr std::uint8_t kRemoved = 1, kRemovedStatic = 2, kKeptMoving = 4;

  static void mark(Pixel& pixel, bool removed, bool moving) {
    if (removed) {
      pixel.marks |= moving ? kRemoved : kRemoved | kRemovedStatic;
    } else {
      pixel.marks |= kKeptMoving;
    }
  }

  std::uint32_t pixelOf(const Eigen::Vector3d& point) const {
    const double x = (point.x() - corner_.x()) * pixels_per_metre_;
    const double y = (point.y() - corner_.y()) * pixels_per_metre_;
    const bool inside = x >= 0.0 && y >= 0.0 && x < width_ && y < height_;
    // Bounded instead of asked first, so that no branch is needed; 0 for what is not a number.
    const int column = static_cast<int>(std::min(width_ - 1.0, std::max(0.0, x)));
    const int row = static_cast<int>(std::min(height_ - 1.0, std::max(0.0, y)));
    return inside ? indexOf(column, row) : static_cast<std::uint32_t>(pixels_.size() - 1);
  }
  /// Blocks of 8 x 4 pixels follow each other: neighbouring points then share a cache line.
  std::uint32_t indexOf(int x, int y) const {
    const int block = (y >> 2) * blocks_per_row_ + (x >> 3);
    return static_cast<std::uint32_t>(block * 32 + (y & 3) * 8 + (x & 7));
  }
  template <typename F>
  Picture draw(F color) const;

  Eigen::Vector2d corner_;
  double metres_per_pixel_;
  double pixels_per_metre_;
  int width_, height_;
  int blocks_per_row_;
  std::vector<Pixel> pixels_;  ///< and one more for what lies outside
};

/// The binary matrix as a heat map: the height of each column's highest occupied bit, purple to
/// yellow; columns in which something was removed red.
Picture drawMatrix(const TileMap& map);

}  // namespace beautymap
