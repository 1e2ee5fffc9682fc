// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/scan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace beautymap {
namespace {

// Half of what an int32 holds, so that windows around a column never overflow.
constexpr double kMaxColumn = 1e9;

void countDropped(const Eigen::Vector3f& point, float squared_range, float min_squared,
                  DroppedPoints& dropped) {
  if (!point.allFinite()) {
    ++dropped.non_finite;
  } else if (point.isZero(0.0F) || squared_range == 0.0F) {
    ++dropped.zero;
  } else {
    ++(squared_range < min_squared ? dropped.too_near : dropped.too_far);
  }
}

// Points at a time: their intermediate results stay in the fastest cache.
constexpr std::size_t kBlock = 512;

/// Drops the points of a block that are not usable; the block starts at `first` of the scan's cloud
/// and `used` of the placed points.
/// @return  how many stay
std::size_t dropPoints(const Scan& scan, std::size_t first, std::size_t size,
                       const std::int32_t* usable, const float* squared_range, float min_squared,
                       std::size_t used, PlacedScan& placed, DroppedPoints& dropped) {
  std::size_t to = used;
  for (std::size_t i = 0; i < size; ++i) {
    if (usable[i] == 0) {
      countDropped(scan.cloud[first + i].getVector3fMap(), squared_range[i], min_squared, dropped);
    }
    placed.x[to] = placed.x[used + i];
    placed.y[to] = placed.y[used + i];
    placed.z[to] = placed.z[used + i];
    placed.source_index[to] = static_cast<std::uint32_t>(first + i);
    to += static_cast<std::size_t>(usable[i]);  // no branch: which ones are is hard to predict
  }
  return to - used;
}

/// @param move  a point's x, y, z -> where it lies; a branch in it would cost its vectorization
template <typename Move>
void movePoints(const Scan& scan, const ScanConfig& config, PlacedScan& placed,
                DroppedPoints& dropped, Move move) {
  const float min_squared = static_cast<float>(config.min_range * config.min_range);
  const float max_squared = static_cast<float>(config.max_range * config.max_range);
  const float sx = placed.sensor.x(), sy = placed.sensor.y(), sz = placed.sensor.z();
  const std::size_t cloud_size = scan.cloud.size();
  placed.cloud_size = cloud_size;
  for (std::vector<float>* coordinate : {&placed.x, &placed.y, &placed.z}) {
    coordinate->resize(cloud_size);
  }
  placed.source_index.resize(cloud_size);
  std::array<float, kBlock> squared_range;
  std::array<std::int32_t, kBlock> usable;
  std::size_t used = 0;
  for (std::size_t first = 0; first < cloud_size; first += kBlock) {
    const std::size_t size = std::min(kBlock, cloud_size - first);
    const pcl::PointXYZ* __restrict p = &scan.cloud[first];
    float* __restrict x = &placed.x[used];
    float* __restrict y = &placed.y[used];
    float* __restrict z = &placed.z[used];
    std::int32_t usable_count = 0;
    for (std::size_t i = 0; i < size; ++i) {
      move(p[i].x, p[i].y, p[i].z, x[i], y[i], z[i]);
      const float dx = x[i] - sx, dy = y[i] - sy, dz = z[i] - sz;
      const float squared = dx * dx + dy * dy + dz * dz;
      squared_range[i] = squared;
      // False for NaN, too. Without short circuits: each would be a branch.
      const int zero = static_cast<int>(p[i].x == 0.0F) & static_cast<int>(p[i].y == 0.0F) &
                       static_cast<int>(p[i].z == 0.0F);
      usable[i] = static_cast<int>(squared >= min_squared) &
                  static_cast<int>(squared <= max_squared) & static_cast<int>(squared > 0.0F) &
                  (1 - zero);
      usable_count += usable[i];
    }
    if (static_cast<std::size_t>(usable_count) == size) {
      std::iota(&placed.source_index[used], &placed.source_index[used] + size,
                static_cast<std::uint32_t>(first));
      used += size;
    } else {
      used += dropPoints(scan, first, size, usable.data(), squared_range.data(), min_squared, used,
                         placed, dropped);
    }
  }
  for (std::vector<float>* coordinate : {&placed.x, &placed.y, &placed.z}) {
    coordinate->resize(used);
  }
  placed.source_index.resize(used);
}

}  // namespace

ColumnIndex columnOf(const Eigen::Vector3d& position_in_map, double res_g) {
  return {static_cast<std::int32_t>(std::floor(position_in_map.x() / res_g)),
          static_cast<std::int32_t>(std::floor(position_in_map.y() / res_g))};
}

PlacedScan placeScan(const Scan& scan, double z_origin, double res_g, const ScanConfig& config,
                     DroppedPoints& dropped, PlacedScan recycled) {
  const Eigen::Vector3d& sensor = scan.sensor_in_map;
  if (!sensor.allFinite() || !scan.T_map_cloud.matrix().allFinite() ||
      sensor.cwiseAbs().maxCoeff() / res_g > kMaxColumn) {
    throw std::invalid_argument("the scan's pose is not finite or too far from the map's origin");
  }
  PlacedScan placed = std::move(recycled);
  placed.anchor = columnOf(sensor, res_g);
  const Eigen::Vector3d origin(placed.anchor.x * res_g, placed.anchor.y * res_g, z_origin);
  placed.sensor = (sensor - origin).cast<float>();

  // The translation is made small in double before it meets the points.
  const Eigen::Vector3d shift = scan.T_map_cloud.translation() - origin;
  if (scan.T_map_cloud.linear().isIdentity(0.0)) {
    // A registered cloud may hold large coordinates: what is large in float is subtracted in
    // double.
    const double tx = shift.x(), ty = shift.y(), tz = shift.z();
    movePoints(scan, config, placed, dropped,
               [=](float px, float py, float pz, float& x, float& y, float& z) {
                 x = static_cast<float>(static_cast<double>(px) + tx);
                 y = static_cast<float>(static_cast<double>(py) + ty);
                 z = static_cast<float>(static_cast<double>(pz) + tz);
               });
  } else {
    const Eigen::Matrix3f rotation = scan.T_map_cloud.linear().cast<float>();
    const Eigen::Vector3f t = shift.cast<float>();
    // Copies that no store can change.
    const float xx = rotation(0, 0), xy = rotation(0, 1), xz = rotation(0, 2), tx = t.x();
    const float yx = rotation(1, 0), yy = rotation(1, 1), yz = rotation(1, 2), ty = t.y();
    const float zx = rotation(2, 0), zy = rotation(2, 1), zz = rotation(2, 2), tz = t.z();
    movePoints(scan, config, placed, dropped,
               [=](float px, float py, float pz, float& x, float& y, float& z) {
                 x = xx * px + xy * py + xz * pz + tx;
                 y = yx * px + yy * py + yz * pz + ty;
                 z = zx * px + zy * py + zz * pz + tz;
               });
  }
  findRuns(placed, res_g);
  return placed;
}

void findRuns(PlacedScan& placed, double res_g) {
  const float columns_per_metre = static_cast<float>(1.0 / res_g);
  std::array<std::int32_t, kBlock> x, y, changed;
  std::array<std::uint32_t, kBlock + 1> begins;
  placed.runs.clear();
  for (std::size_t first = 0; first < placed.size(); first += kBlock) {
    const std::size_t size = std::min(kBlock, placed.size() - first);
    for (std::size_t i = 0; i < size; ++i) {
      x[i] = floorToInt(placed.x[first + i] * columns_per_metre);
      y[i] = floorToInt(placed.y[first + i] * columns_per_metre);
    }
    for (std::size_t i = 1; i < size; ++i) {
      changed[i] = static_cast<std::int32_t>(((x[i] ^ x[i - 1]) | (y[i] ^ y[i - 1])) != 0);
    }
    std::size_t count = 1;
    begins[0] = 0;
    for (std::size_t i = 1; i < size; ++i) {
      begins[count] = static_cast<std::uint32_t>(i);
      count += static_cast<std::size_t>(changed[i]);  // no branch: runs end anywhere
    }
    begins[count] = static_cast<std::uint32_t>(size);
    const std::size_t before = placed.runs.size();
    placed.runs.resize(before + count);
    ColumnRun* runs = &placed.runs[before];
    const auto offset = static_cast<std::uint32_t>(first);
    for (std::size_t run = 0; run < count; ++run) {
      const std::uint32_t begin = begins[run];
      runs[run] = {x[begin], y[begin], offset + begin, offset + begins[run + 1]};
    }
  }
}

}  // namespace beautymap
