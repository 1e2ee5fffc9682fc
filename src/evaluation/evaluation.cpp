// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/evaluation/evaluation.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <tuple>

#include "../base/vector_clones.h"

namespace beautymap {
namespace {

// A cell of twice the radius: whatever lies within the radius is in at most two cells an axis.
constexpr double kCellRadii = 2.0;
// Neighbouring cells share a cube of 8 x 8 x 8, to be near each other in memory, too.
constexpr int kCubeShift = 3;
constexpr std::size_t kShelves = 256;
// 4 MB.
constexpr std::size_t kLines = std::size_t{1} << 16;
// Of the indices of a near cell: 4 MB.
constexpr std::uint32_t kNearBits = 10, kNearBitsUp = 5;
// Points that are shown together.
constexpr std::size_t kBlock = 256;
// Of a shelf; equal points are first merged when it is full.
constexpr std::size_t kMinCapacity = 2048;

/// std::floor is a function call without SSE4.1. Beyond what a double counts exactly, and for what
/// is not a number, the result is the limit.
std::int64_t floorToInt64(double value) {
  constexpr double kLimit = 9007199254740992.0;
  const double bounded = std::max(-kLimit, std::min(kLimit, value));
  const auto truncated = static_cast<std::int64_t>(bounded);
  return truncated - static_cast<std::int64_t>(static_cast<double>(truncated) > bounded);
}

/// A key of 18 bits an axis for the cube, and below it 3 bits an axis for the cell in the cube:
/// cells above each other follow each other. Cells so far apart that they share a key add
/// candidates only.
std::uint64_t cellKey(std::int64_t x, std::int64_t y, std::int64_t z) {
  const auto bits = [](std::int64_t value, int count) {
    return static_cast<std::uint64_t>(value) & ((std::uint64_t{1} << count) - 1);
  };
  const std::uint64_t cube =
      bits(x >> kCubeShift, 18) << 36 | bits(y >> kCubeShift, 18) << 18 | bits(z >> kCubeShift, 18);
  return cube << (3 * kCubeShift) | bits(x, kCubeShift) << 6 | bits(y, kCubeShift) << 3 |
         bits(z, kCubeShift);
}

std::uint64_t hashOf(std::uint64_t key) {
  key = (key ^ (key >> 32)) * 0x9E3779B97F4A7C15ULL;
  return key ^ (key >> 29);
}

/// Index of a near cell on one axis, counted from far below. It never falls where the coordinate
/// rises; beyond what it can count, and for what is not a number, it is the limit.
std::uint32_t nearIndex(double coordinate, double cells_per_m) {
  constexpr double kHalf = 1 << 30;
  const double index = coordinate * cells_per_m + kHalf;
  const double bounded = std::max(0.0, std::min(2.0 * kHalf - 1.0, index));
  return static_cast<std::uint32_t>(static_cast<std::int32_t>(bounded));
}

/// Its place among all bits. A word has 4 x 4 x 4 cells: that of the next point is mostly the same.
std::uint32_t nearBit(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  constexpr std::uint32_t kAxis = (1U << kNearBits) - 1, kAxisUp = (1U << kNearBitsUp) - 1;
  x &= kAxis;
  y &= kAxis;
  z &= kAxisUp;
  const std::uint32_t word = ((x >> 2) << (kNearBits - 2) | y >> 2) << (kNearBitsUp - 2) | z >> 2;
  return word << 6 | (x & 3) << 4 | (y & 3) << 2 | (z & 3);
}

BEAUTYMAP_VECTOR_CLONES
void findNearBits(const Eigen::Vector3d* points, std::size_t count, double cells_per_m,
                  std::uint32_t* bits) {
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d& p = points[i];
    bits[i] = nearBit(nearIndex(p.x(), cells_per_m), nearIndex(p.y(), cells_per_m),
                      nearIndex(p.z(), cells_per_m));
  }
}

std::uint64_t hashOfCube(std::uint64_t cell) { return hashOf(cell >> (3 * kCubeShift)); }

double percent(std::uint64_t part, std::uint64_t all) {
  return all == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(all);
}

}  // namespace

double Score::SA() const { return percent(kept_static, static_points); }
double Score::DA() const { return percent(dynamic_points - kept_dynamic, dynamic_points); }
double Score::AA() const { return std::sqrt(SA() * DA()); }
double Score::HA() const { return SA() + DA() > 0.0 ? 2.0 * SA() * DA() / (SA() + DA()) : 0.0; }

Evaluator::Evaluator(double radius_m)
    : radius_m_(radius_m),
      cells_per_m_(1.0 / (kCellRadii * radius_m)),
      shelves_(kShelves),
      near_(radius_m) {
  if (!(radius_m >= 1e-6) || !std::isfinite(radius_m)) {
    throw std::invalid_argument("the radius must be a positive number of metres");
  }
}

void Evaluator::addKept(bool moving, std::uint64_t count) {
  (moving ? known_.dynamic_points : known_.static_points) += count;
  (moving ? known_.kept_dynamic : known_.kept_static) += count;
}

void Evaluator::addUnmatched(const Eigen::Vector3d& point, bool moving) {
  if (!point.allFinite()) return;
  ++(moving ? known_.dynamic_points : known_.static_points);
  const std::uint64_t cell = cellOf(point);
  shelfOf(cell).add({cell, point, moving ? 0U : 1U, moving ? 1U : 0U});
}

void Evaluator::finishTruth() {
  for (Shelf& shelf : shelves_) {
    shelf.finish();
    for (const Unmatched& unmatched : shelf.points()) {
      occupied_.insert(unmatched.cell);
      near_.insert(unmatched.point);
    }
  }
}

void Evaluator::showCleaned(const std::vector<Eigen::Vector3d>& points) {
  // The time goes into waiting for memory. So each loop asks for what the next one needs.
  struct Lookup {
    std::uint32_t point;  ///< of the block
    std::uint64_t cell;
  };
  struct Match {
    std::uint32_t point;  ///< of the block
    Shelf* shelf;
    Shelf::Run run;
  };
  std::array<std::uint32_t, kBlock> near;
  std::vector<Lookup> lookups;
  std::vector<Match> matches;
  for (std::size_t begin = 0; begin < points.size(); begin += kBlock) {
    const Eigen::Vector3d* block = &points[begin];
    const std::size_t count = std::min(kBlock, points.size() - begin);
    const std::size_t near_count = near_.select(block, count, near.data());
    lookups.clear();
    for (std::size_t i = 0; i < near_count; ++i) {
      forEachCellInReach(block[near[i]], [&](std::uint64_t cell) {
        if (!occupied_.mayHold(cell)) return;
        lookups.push_back({near[i], cell});
        __builtin_prefetch(shelfOf(cell).firstPlace(cell));
      });
    }
    matches.clear();
    for (const Lookup& lookup : lookups) {
      Shelf& shelf = shelfOf(lookup.cell);
      const Shelf::Run& run = shelf.find(lookup.cell);
      if (run.begin == run.end) continue;
      matches.push_back({lookup.point, &shelf, run});
      __builtin_prefetch(&shelf.points()[run.begin]);
    }
    for (const Match& m : matches) m.shelf->match(m.run, block[m.point], radius_m_);
  }
}

Score Evaluator::score() const {
  Score score = known_;
  for (const Shelf& shelf : shelves_) shelf.addKeptTo(score);
  return score;
}

Evaluator::Shelf& Evaluator::shelfOf(std::uint64_t cell) {
  return shelves_[(hashOfCube(cell) >> 32) % kShelves];
}

std::uint64_t Evaluator::cellOf(const Eigen::Vector3d& point) const {
  return cellKey(floorToInt64(point.x() * cells_per_m_), floorToInt64(point.y() * cells_per_m_),
                 floorToInt64(point.z() * cells_per_m_));
}

template <typename F>
void Evaluator::forEachCellInReach(const Eigen::Vector3d& point, F f) const {
  std::int64_t low[3], high[3];
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = floorToInt64((point[axis] - radius_m_) * cells_per_m_);
    high[axis] = floorToInt64((point[axis] + radius_m_) * cells_per_m_);
  }
  for (std::int64_t x = low[0]; x <= high[0]; ++x) {
    for (std::int64_t y = low[1]; y <= high[1]; ++y) {
      for (std::int64_t z = low[2]; z <= high[2]; ++z) f(cellKey(x, y, z));
    }
  }
}

void Evaluator::Shelf::add(const Unmatched& unmatched) {
  if (points_.size() == points_.capacity()) {
    // The same scan may come more than once: it must not take more memory.
    mergeEqual();
    if (merged_ >= points_.capacity() / 8 * 7) {
      points_.reserve(std::max(kMinCapacity, merged_ / 4 * 5));
    }
  }
  points_.push_back(unmatched);
}

void Evaluator::Shelf::mergeEqual() {
  const auto before = [](const Unmatched& a, const Unmatched& b) {
    return std::tie(a.cell, a.point.x(), a.point.y(), a.point.z()) <
           std::tie(b.cell, b.point.x(), b.point.y(), b.point.z());
  };
  const auto added = points_.begin() + static_cast<std::ptrdiff_t>(merged_);
  std::sort(added, points_.end(), before);
  std::inplace_merge(points_.begin(), added, points_.end(), before);
  merged_ = 0;
  for (const Unmatched& next : points_) {
    if (merged_ > 0 && points_[merged_ - 1].point == next.point) {
      points_[merged_ - 1].static_count += next.static_count;
      points_[merged_ - 1].moving_count += next.moving_count;
    } else {
      points_[merged_++] = next;
    }
  }
  points_.resize(merged_, {});
}

void Evaluator::Shelf::finish() {
  mergeEqual();
  kept_ = std::vector<std::atomic<bool>>(points_.size());
  std::size_t cells = 0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    cells += i == 0 || points_[i].cell != points_[i - 1].cell;
  }
  std::size_t places = 2;  // a power of two, and at most half of them taken
  while (places < 2 * cells) places *= 2;
  runs_.assign(places, {});
  for (std::size_t begin = 0, end = 0; begin < points_.size(); begin = end) {
    const std::uint64_t cell = points_[begin].cell;
    while (end < points_.size() && points_[end].cell == cell) ++end;
    const auto place = static_cast<std::size_t>(&find(cell) - runs_.data());
    runs_[place] = {cell, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)};
  }
}

const Evaluator::Shelf::Run* Evaluator::Shelf::firstPlace(std::uint64_t cell) const {
  // Cells above each other follow each other.
  return &runs_[((hashOf(cell >> 2) << 2) + (cell & 3)) & (runs_.size() - 1)];
}

const Evaluator::Shelf::Run& Evaluator::Shelf::find(std::uint64_t cell) const {
  const Run* run = firstPlace(cell);
  while (run->end > 0 && run->cell != cell) {
    if (++run == runs_.data() + runs_.size()) run = runs_.data();
  }
  return *run;
}

void Evaluator::Shelf::match(const Run& run, const Eigen::Vector3d& point, double radius_m) {
  for (std::uint32_t i = run.begin; i < run.end; ++i) {
    if ((points_[i].point - point).squaredNorm() < radius_m * radius_m) {
      kept_[i].store(true, std::memory_order_relaxed);
    }
  }
}

void Evaluator::Shelf::addKeptTo(Score& score) const {
  for (std::size_t i = 0; i < kept_.size(); ++i) {
    if (!kept_[i].load(std::memory_order_relaxed)) continue;
    score.kept_static += points_[i].static_count;
    score.kept_dynamic += points_[i].moving_count;
  }
}

Evaluator::NearCells::NearCells(double radius_m)
    : radius_m_(radius_m),
      cells_per_m_(1.0 / (kCellRadii * radius_m)),
      words_(std::size_t{1} << (2 * kNearBits + kNearBitsUp - 6)) {}

void Evaluator::NearCells::insert(const Eigen::Vector3d& point) {
  const auto low = [&](double value) { return nearIndex(value - radius_m_, cells_per_m_); };
  const auto high = [&](double value) { return nearIndex(value + radius_m_, cells_per_m_); };
  for (std::uint32_t x = low(point.x()); x <= high(point.x()); ++x) {
    for (std::uint32_t y = low(point.y()); y <= high(point.y()); ++y) {
      for (std::uint32_t z = low(point.z()); z <= high(point.z()); ++z) {
        const std::uint32_t bit = nearBit(x, y, z);
        words_[bit / 64] |= std::uint64_t{1} << (bit % 64);
      }
    }
  }
}

std::size_t Evaluator::NearCells::select(const Eigen::Vector3d* points, std::size_t count,
                                         std::uint32_t* selected) const {
  std::array<std::uint32_t, kBlock> bits;
  findNearBits(points, count, cells_per_m_, bits.data());
  // Without a branch, whose way would be hard to predict.
  std::size_t found = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    selected[found] = i;
    found += words_[bits[i] / 64] >> (bits[i] % 64) & 1;
  }
  return found;
}

Evaluator::CellSet::CellSet() : lines_(kLines) {}

void Evaluator::CellSet::insert(std::uint64_t cell) {
  lines_[hashOfCube(cell) % kLines].words[cell >> 6 & 7] |= std::uint64_t{1} << (cell & 63);
}

bool Evaluator::CellSet::mayHold(std::uint64_t cell) const {
  return (lines_[hashOfCube(cell) % kLines].words[cell >> 6 & 7] >> (cell & 63) & 1) != 0;
}

}  // namespace beautymap
