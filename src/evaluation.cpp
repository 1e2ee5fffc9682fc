// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/evaluation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace beautymap {
namespace {

// A cell of twice the radius: whatever lies within the radius is in at most two cells an axis.
constexpr double kCellRadii = 2.0;
// Coarse cells that only answer "nothing near here", as most points of a cleaned map are far from
// what was removed.
constexpr double kCoarseRadii = 4.0;
constexpr std::size_t kCoarseBits = std::size_t{1} << 25;

// Beyond it, cell numbers would not fit; no map reaches that far.
constexpr double kMaxCoordinate = 1e9;  // [m]

bool isUsable(const Eigen::Vector3d& point) {
  return point.cwiseAbs().maxCoeff() <= kMaxCoordinate && point.allFinite();
}

std::uint64_t hashCell(std::int64_t x, std::int64_t y, std::int64_t z) {
  std::uint64_t h = static_cast<std::uint64_t>(x) * 0x9E3779B97F4A7C15ULL;
  h = (h ^ (h >> 29) ^ static_cast<std::uint64_t>(y)) * 0xBF58476D1CE4E5B9ULL;
  h = (h ^ (h >> 32) ^ static_cast<std::uint64_t>(z)) * 0x94D049BB133111EBULL;
  return h ^ (h >> 31);
}

double percent(std::uint64_t part, std::uint64_t all) {
  return all == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(all);
}

}  // namespace

double Score::SA() const { return percent(kept_static, static_points); }
double Score::DA() const { return percent(dynamic_points - kept_dynamic, dynamic_points); }
double Score::AA() const { return std::sqrt(SA() * DA()); }
double Score::HA() const { return SA() + DA() > 0.0 ? 2.0 * SA() * DA() / (SA() + DA()) : 0.0; }

Evaluator::Evaluator(double radius_m) : radius_m_(radius_m) {
  if (!(radius_m >= 1e-6) || !std::isfinite(radius_m)) {
    throw std::invalid_argument("the radius must be a positive number of metres");
  }
  near_.assign(kCoarseBits, false);
}

void Evaluator::addKept(bool moving) {
  ++(moving ? score_.dynamic_points : score_.static_points);
  ++(moving ? score_.kept_dynamic : score_.kept_static);
}

void Evaluator::addUnmatched(const Eigen::Vector3d& point, bool moving) {
  ++(moving ? score_.dynamic_points : score_.static_points);
  if (!isUsable(point)) return;
  std::vector<Unmatched>& cell = cells_[cellKey(point)];
  // The same scan may come more than once: it must not take more memory.
  auto same =
      std::find_if(cell.begin(), cell.end(), [&](const Unmatched& u) { return u.point == point; });
  if (same == cell.end()) {
    cell.push_back({point, 0, 0});
    same = cell.end() - 1;
    markNear(point);
  }
  ++(moving ? same->moving_count : same->static_count);
}

void Evaluator::showCleaned(const Eigen::Vector3d& point) {
  if (!isUsable(point) || !nearUnmatched(point)) return;
  forEachCellNear(point, kCellRadii * radius_m_,
                  [&](std::uint64_t key) { matchInCell(key, point); });
}

void Evaluator::matchInCell(std::uint64_t key, const Eigen::Vector3d& point) {
  const auto found = cells_.find(key);
  if (found == cells_.end()) return;
  std::vector<Unmatched>& cell = found->second;
  for (std::size_t i = 0; i < cell.size();) {
    if ((cell[i].point - point).norm() < radius_m_) {
      score_.kept_static += cell[i].static_count;
      score_.kept_dynamic += cell[i].moving_count;
      cell[i] = cell.back();
      cell.pop_back();
    } else {
      ++i;
    }
  }
  if (cell.empty()) cells_.erase(found);
}

std::uint64_t Evaluator::cellKey(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d cell = (point / (kCellRadii * radius_m_)).array().floor();
  return hashCell(static_cast<std::int64_t>(cell.x()), static_cast<std::int64_t>(cell.y()),
                  static_cast<std::int64_t>(cell.z()));
}

template <typename F>
void Evaluator::forEachCellNear(const Eigen::Vector3d& point, double cell_m, F f) const {
  const Eigen::Array3d low = ((point.array() - radius_m_) / cell_m).floor();
  const Eigen::Array3d high = ((point.array() + radius_m_) / cell_m).floor();
  for (auto x = static_cast<std::int64_t>(low.x()); x <= static_cast<std::int64_t>(high.x()); ++x) {
    for (auto y = static_cast<std::int64_t>(low.y()); y <= static_cast<std::int64_t>(high.y());
         ++y) {
      for (auto z = static_cast<std::int64_t>(low.z()); z <= static_cast<std::int64_t>(high.z());
           ++z) {
        f(hashCell(x, y, z));
      }
    }
  }
}

void Evaluator::markNear(const Eigen::Vector3d& point) {
  last_cell_.setConstant(std::numeric_limits<double>::infinity());  // its answer may change now
  forEachCellNear(point, kCoarseRadii * radius_m_,
                  [&](std::uint64_t key) { near_[key % kCoarseBits] = true; });
}

bool Evaluator::nearUnmatched(const Eigen::Vector3d& point) {
  const Eigen::Array3d cell = (point / (kCoarseRadii * radius_m_)).array().floor();
  if ((cell != last_cell_).any()) {
    last_cell_ = cell;
    last_near_ =
        near_[hashCell(static_cast<std::int64_t>(cell.x()), static_cast<std::int64_t>(cell.y()),
                       static_cast<std::int64_t>(cell.z())) %
              kCoarseBits];
  }
  return last_near_;
}

}  // namespace beautymap
