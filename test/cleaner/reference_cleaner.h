// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "beautymap/cleaner/map_cleaner.h"
#include "published/ray_oracle.h"

namespace beautymap::test {

/// The whole published method once more, in double, with lists of points and sets of bits, as slow
/// and obvious as possible. Not decided (no value) is what depends on a comparison that float may
/// round to either side.
class ReferenceCleaner {
 public:
  ReferenceCleaner(const Config& config, const std::vector<Scan>& scans) : config_(config) {
    for (const Scan& scan : scans) scans_.push_back(place(scan));
    estimateGround();
    for (PlacedPoints& scan : scans_) encode(scan);
    for (const PlacedPoints& scan : scans_) compare(scan);
    for (auto& entry : columns_) segment(entry.second);
  }

  std::optional<PointClass> classOf(std::size_t scan, std::size_t point) const {
    const Point& p = scans_[scan].points[point];
    if (!p.used) return PointClass::kDropped;
    const Column& column = columns_.at(p.column);
    if (p.bit < 0) return PointClass::kStatic;
    if (column.dynamic.count(p.bit) != 0) return PointClass::kDynamic;
    if (column.maybe.count(p.bit) != 0) return std::nullopt;
    if (p.bit != *column.occupied.begin()) return PointClass::kStatic;
    if (column.split_maybe) return std::nullopt;
    return fineBinOf(p.z, column) >= column.ground_bins ? PointClass::kDynamic
                                                        : PointClass::kStatic;
  }

 private:
  using Index = std::pair<int, int>;
  struct Point {
    bool used = false;
    Index column;
    double z = 0.0;
    int bit = -1;
    Eigen::Vector3d position;
  };
  struct PlacedPoints {
    Eigen::Vector3d sensor;
    std::vector<Point> points;
    std::map<Index, std::set<int>> bits;
  };
  struct Column {
    double lowest = std::numeric_limits<double>::infinity();
    double ground = 0.0;
    bool below_ground = false;
    std::set<int> occupied, dynamic, maybe;
    std::vector<double> ground_cell;  ///< heights of the points in the lowest occupied cell
    int ground_bins = std::numeric_limits<int>::max();
    bool split_maybe = false;
  };

  Index columnOf(const Eigen::Vector3d& position) const {
    return {static_cast<int>(std::floor(position.x() / config_.matrix.res_g)),
            static_cast<int>(std::floor(position.y() / config_.matrix.res_g))};
  }

  PlacedPoints place(const Scan& scan) {
    PlacedPoints placed{scan.sensor_in_map, {}, {}};
    for (const pcl::PointXYZ& raw : scan.cloud) {
      Point point;
      const Eigen::Vector3d local = raw.getVector3fMap().cast<double>();
      point.position = scan.T_map_cloud * local;
      const double range = (point.position - scan.sensor_in_map).norm();
      point.used = local.allFinite() && local.norm() > 0.0 && range > 0.0 &&
                   range >= config_.scan.min_range && range <= config_.scan.max_range;
      if (point.used) {
        point.column = columnOf(point.position);
        point.z = point.position.z();
        Column& column = columns_[point.column];
        column.lowest = std::min(column.lowest, point.z);
      }
      placed.points.push_back(point);
    }
    return placed;
  }

  static double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return (values[(values.size() - 1) / 2] + values[values.size() / 2]) / 2.0;
  }

  void estimateGround() {
    double lowest_of_all = std::numeric_limits<double>::infinity();
    for (const auto& c : columns_) lowest_of_all = std::min(lowest_of_all, c.second.lowest);
    const int r = config_.coarse_ground.radius;
    for (auto& entry : columns_) {
      Column& column = entry.second;
      column.ground = config_.coarse_ground.enabled ? column.lowest : lowest_of_all;
      if (!config_.coarse_ground.enabled) continue;
      std::vector<double> neighbours;
      for (const auto& other : columns_) {
        const int dx = other.first.first - entry.first.first;
        const int dy = other.first.second - entry.first.second;
        if ((dx != 0 || dy != 0) && std::abs(dx) <= r && std::abs(dy) <= r) {
          neighbours.push_back(other.second.lowest);
        }
      }
      const int possible = (2 * r + 1) * (2 * r + 1) - 1;
      const double share = static_cast<double>(neighbours.size()) / possible;
      if (neighbours.empty() || share < config_.coarse_ground.min_share) continue;
      const double middle = median(neighbours);
      for (double& height : neighbours) height = std::abs(height - middle);
      const double margin = config_.coarse_ground.mad_factor * median(neighbours);
      column.ground = std::min(std::max(column.lowest, middle - margin), middle + margin);
      column.below_ground = column.lowest < middle - margin;
    }
  }

  void encode(PlacedPoints& scan) {
    for (Point& point : scan.points) {
      if (!point.used) continue;
      Column& column = columns_[point.column];
      const double k = std::floor((point.z - column.ground) / config_.matrix.res_h);
      if (k < 0.0) continue;
      point.bit = static_cast<int>(std::min(k, config_.matrix.n_bit - 1.0));
      column.occupied.insert(point.bit);
      scan.bits[point.column].insert(point.bit);
    }
  }

  double steepestSlope(const PlacedPoints& scan) const {
    std::vector<double> slopes;
    for (const Point& point : scan.points) {
      const Eigen::Vector3d ray = point.position - scan.sensor;
      const double distance = std::hypot(ray.x(), ray.y());
      if (point.used && distance > 0.0) slopes.push_back(ray.z() / distance);
    }
    if (slopes.empty()) return -std::numeric_limits<double>::infinity();
    std::sort(slopes.begin(), slopes.end());
    const double rank = config_.restoration.steepest_share * static_cast<double>(slopes.size() - 1);
    return slopes[static_cast<std::size_t>(rank)];
  }

  /// Whether the scan could have seen a cell at all.
  std::optional<bool> inSight(const PlacedPoints& scan, double slope, const Column& column,
                              const std::set<int>& hits, double distance, int bit) const {
    constexpr double kRounding = 1e-4;
    const RestorationConfig& c = config_.restoration;
    if (std::abs(distance - c.blind_radius) < kRounding) return std::nullopt;
    if (std::abs(distance - c.sight_range) < kRounding) return std::nullopt;
    if (distance < c.blind_radius) return false;
    if (hits.count(0) == 0 && distance > c.sight_range) return false;
    const int highest = hits.empty() ? 0 : *hits.rbegin();
    if (highest > 0 && !column.below_ground) return bit < highest;
    const double bits_in_view =
        (scan.sensor.z() + slope * distance - column.ground) / config_.matrix.res_h;
    if (std::abs(bits_in_view - std::round(bits_in_view)) < kRounding) return std::nullopt;
    return bit < std::ceil(bits_in_view);
  }

  void compare(const PlacedPoints& scan) {
    const double res_g = config_.matrix.res_g;
    const double slope = steepestSlope(scan);
    const RayOracle rays(
        [&](int x, int y) {
          HitColumn hit;
          const auto found = scan.bits.find({x, y});
          if (found == scan.bits.end() || !inRegion(scan, {x, y})) return hit;
          for (const int bit : found->second) hit.hits |= Bits{1} << bit;
          hit.ground = columns_.at({x, y}).ground;
          return hit;
        },
        res_g, config_.matrix.res_h, config_.matrix.n_bit);
    for (auto& entry : columns_) {
      if (!inRegion(scan, entry.first)) continue;
      Column& column = entry.second;
      const auto found = scan.bits.find(entry.first);
      const std::set<int> hits = found == scan.bits.end() ? std::set<int>() : found->second;
      Eigen::Vector3d centre((entry.first.first + 0.5) * res_g, (entry.first.second + 0.5) * res_g,
                             0);
      const double distance = (centre - scan.sensor).head<2>().norm();
      for (const int bit : column.occupied) {
        if (hits.count(bit) != 0) continue;
        std::optional<bool> sight(true), hidden(false);
        if (config_.restoration.enabled) {
          if (bit == *column.occupied.begin()) continue;
          sight = inSight(scan, slope, column, hits, distance, bit);
          if (sight && !*sight) continue;
          centre.z() = column.ground + (bit + 0.5) * config_.matrix.res_h;
          hidden = rays.hidden(centre, scan.sensor);
          if (hidden && *hidden) continue;
        }
        (sight && hidden ? column.dynamic : column.maybe).insert(bit);
      }
    }
  }

  bool inRegion(const PlacedPoints& scan, const Index& column) const {
    const int half = std::max(
        1, static_cast<int>(std::floor(config_.matrix.roi_size / 2.0 / config_.matrix.res_g)));
    const Index sensor = columnOf(scan.sensor);
    return std::abs(column.first - sensor.first) <= half &&
           std::abs(column.second - sensor.second) <= half;
  }

  int fineBinOf(double z, const Column& column) const {
    const double bottom = column.ground + *column.occupied.begin() * config_.matrix.res_h;
    const double bins = std::ceil(config_.matrix.res_h / config_.fine_ground.bin_height);
    return static_cast<int>(
        std::min(std::floor((z - bottom) / config_.fine_ground.bin_height), bins - 1.0));
  }

  void segment(Column& column) {
    if (!config_.coarse_ground.enabled || !config_.fine_ground.enabled) return;
    if (column.occupied.empty()) return;
    const int above = *column.occupied.begin() + 1;
    column.split_maybe = column.dynamic.count(above) == 0 && column.maybe.count(above) != 0;
    if (column.dynamic.count(above) == 0) return;
    std::map<int, double> counts;
    double all = 0.0, from_below = 0.0;
    for (const PlacedPoints& scan : scans_) {
      for (const Point& p : scan.points) {
        if (!p.used || p.bit != above - 1 || &columns_[p.column] != &column) continue;
        ++counts[fineBinOf(p.z, column)];
        ++all;
      }
    }
    for (const auto& bin : counts) {
      from_below += bin.second;
      column.ground_bins = bin.first + 1;
      if (from_below / all >= config_.fine_ground.ground_ratio) return;
    }
  }

  Config config_;
  std::vector<PlacedPoints> scans_;
  std::map<Index, Column> columns_;
};

}  // namespace beautymap::test
