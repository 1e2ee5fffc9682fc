// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/matrix/scan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "../base/vector_clones.h"

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

/// A block of a cloud's points on its way into a placed scan.
struct Block {
  std::array<float, kBlock> squared_range;  ///< from the sensor
  std::array<std::int32_t, kBlock> usable;
};

/// From the first dropped point on it is noted where points come from.
void noteSources(PlacedScan& placed, std::size_t used) {
  placed.source_index.resize(placed.cloud_size);
  std::iota(placed.source_index.begin(),
            placed.source_index.begin() + static_cast<std::ptrdiff_t>(used), 0U);
}

/// Drops the points of a block that are not usable; the block starts at `first` of the scan's cloud
/// and `used` of the placed points.
void dropPoints(const Scan& scan, std::size_t first, std::size_t size, const Block& block,
                float min_squared, std::size_t used, PlacedScan& placed, DroppedPoints& dropped) {
  std::size_t to = used;
  for (std::size_t i = 0; i < size; ++i) {
    if (block.usable[i] == 0) {
      countDropped(scan.cloud[first + i].getVector3fMap(), block.squared_range[i], min_squared,
                   dropped);
    }
    placed.x[to] = placed.x[used + i];
    placed.y[to] = placed.y[used + i];
    placed.z[to] = placed.z[used + i];
    placed.source_index[to] = static_cast<std::uint32_t>(first + i);
    to +=
        static_cast<std::size_t>(block.usable[i]);  // no branch: which ones are is hard to predict
  }
}

/// A run's lowest and highest point.
void findHeights(const std::vector<float>& z, ColumnRun& run) {
  // In the order of firing most runs have one or two points: no branch for these.
  run.lowest = std::min(z[run.begin], z[run.end - 1]);
  run.highest = std::max(z[run.begin], z[run.end - 1]);
  for (std::uint32_t i = run.begin + 1; i + 1 < run.end; ++i) {
    run.lowest = std::min(run.lowest, z[i]);
    run.highest = std::max(run.highest, z[i]);
  }
}

/// The columns of a block of points, and whether each is another one than the point's before.
struct BlockColumns {
  std::array<std::int32_t, kBlock> x, y, changed;
};

BEAUTYMAP_VECTOR_CLONES
void findColumns(const float* x, const float* y, std::size_t size, float columns_per_metre,
                 BlockColumns& columns) {
  for (std::size_t i = 0; i < size; ++i) {
    columns.x[i] = floorToInt(x[i] * columns_per_metre);
    columns.y[i] = floorToInt(y[i] * columns_per_metre);
  }
  for (std::size_t i = 1; i < size; ++i) {
    const std::int32_t differs =
        (columns.x[i] ^ columns.x[i - 1]) | (columns.y[i] ^ columns.y[i - 1]);
    columns.changed[i] = static_cast<std::int32_t>(differs != 0);
  }
}

/// Appends the runs of a block of points, at least one.
void appendRuns(PlacedScan& placed, std::size_t first, std::size_t size, float columns_per_metre) {
  BlockColumns columns;
  findColumns(&placed.x[first], &placed.y[first], size, columns_per_metre, columns);
  std::array<std::uint32_t, kBlock + 1> begins;
  std::size_t count = 1;
  begins[0] = 0;
  for (std::size_t i = 1; i < size; ++i) {
    begins[count] = static_cast<std::uint32_t>(i);
    count += static_cast<std::size_t>(columns.changed[i]);  // no branch: runs end anywhere
  }
  begins[count] = static_cast<std::uint32_t>(size);
  const std::size_t before = placed.runs.size();
  placed.runs.resize(before + count);
  ColumnRun* runs = &placed.runs[before];
  const auto offset = static_cast<std::uint32_t>(first);
  for (std::size_t run = 0; run < count; ++run) {
    const std::uint32_t begin = begins[run], end = begins[run + 1];
    runs[run] = {columns.x[begin], columns.y[begin], offset + begin, offset + end, 0.0F, 0.0F};
    findHeights(placed.z, runs[run]);
  }
}

/// Marks the usable points of a block.
/// @param x, y, z  where they lie
/// @return  how many they are
BEAUTYMAP_VECTOR_CLONES
std::int32_t findUsable(const pcl::PointXYZ* p, std::size_t size, const float* x, const float* y,
                        const float* z, const Eigen::Vector3f& sensor, float min_squared,
                        float max_squared, Block& block) {
  const float sx = sensor.x(), sy = sensor.y(), sz = sensor.z();
  std::int32_t count = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const float dx = x[i] - sx, dy = y[i] - sy, dz = z[i] - sz;
    const float squared = dx * dx + dy * dy + dz * dz;
    block.squared_range[i] = squared;
    // False for NaN, too. Without short circuits: each would be a branch.
    const int zero = static_cast<int>(p[i].x == 0.0F) & static_cast<int>(p[i].y == 0.0F) &
                     static_cast<int>(p[i].z == 0.0F);
    block.usable[i] = static_cast<int>(squared >= min_squared) &
                      static_cast<int>(squared <= max_squared) & static_cast<int>(squared > 0.0F) &
                      (1 - zero);
    count += block.usable[i];
  }
  return count;
}

/// A transform in float32.
struct RigidMove {
  RigidMove(const Eigen::Matrix3f& rotation, const Eigen::Vector3f& t)
      : xx(rotation(0, 0)),
        xy(rotation(0, 1)),
        xz(rotation(0, 2)),
        tx(t.x()),
        yx(rotation(1, 0)),
        yy(rotation(1, 1)),
        yz(rotation(1, 2)),
        ty(t.y()),
        zx(rotation(2, 0)),
        zy(rotation(2, 1)),
        zz(rotation(2, 2)),
        tz(t.z()) {}
  float xx, xy, xz, tx, yx, yy, yz, ty, zx, zy, zz, tz;
};

// The moves come as copies, which no store can change.
BEAUTYMAP_VECTOR_CLONES
void moveBlock(RigidMove m, const pcl::PointXYZ* __restrict p, std::size_t size,
               float* __restrict x, float* __restrict y, float* __restrict z) {
  for (std::size_t i = 0; i < size; ++i) {
    x[i] = m.xx * p[i].x + m.xy * p[i].y + m.xz * p[i].z + m.tx;
    y[i] = m.yx * p[i].x + m.yy * p[i].y + m.yz * p[i].z + m.ty;
    z[i] = m.zx * p[i].x + m.zy * p[i].y + m.zz * p[i].z + m.tz;
  }
}

/// A registered cloud may hold large coordinates: what is large in float is subtracted in double.
BEAUTYMAP_VECTOR_CLONES
void moveBlock(Eigen::Vector3d shift, const pcl::PointXYZ* __restrict p, std::size_t size,
               float* __restrict x, float* __restrict y, float* __restrict z) {
  const double tx = shift.x(), ty = shift.y(), tz = shift.z();
  for (std::size_t i = 0; i < size; ++i) {
    x[i] = static_cast<float>(static_cast<double>(p[i].x) + tx);
    y[i] = static_cast<float>(static_cast<double>(p[i].y) + ty);
    z[i] = static_cast<float>(static_cast<double>(p[i].z) + tz);
  }
}

/// @param move  for moveBlock()
template <typename Move>
void movePoints(const Scan& scan, const ScanConfig& config, double res_g, PlacedScan& placed,
                DroppedPoints& dropped, const Move& move) {
  const float min_squared = static_cast<float>(config.min_range * config.min_range);
  const float max_squared = static_cast<float>(config.max_range * config.max_range);
  const float columns_per_metre = static_cast<float>(1.0 / res_g);
  const std::size_t cloud_size = scan.cloud.size();
  placed.cloud_size = cloud_size;
  for (std::vector<float>* coordinate : {&placed.x, &placed.y, &placed.z}) {
    coordinate->resize(cloud_size);
  }
  placed.source_index.clear();
  placed.runs.clear();
  Block block;
  std::size_t used = 0;
  for (std::size_t first = 0; first < cloud_size; first += kBlock) {
    const std::size_t size = std::min(kBlock, cloud_size - first);
    const pcl::PointXYZ* p = &scan.cloud[first];
    float *x = &placed.x[used], *y = &placed.y[used], *z = &placed.z[used];
    moveBlock(move, p, size, x, y, z);
    const auto usable = static_cast<std::size_t>(
        findUsable(p, size, x, y, z, placed.sensor, min_squared, max_squared, block));
    if (used == first && usable < size) noteSources(placed, used);
    if (usable < size) {
      dropPoints(scan, first, size, block, min_squared, used, placed, dropped);
    } else if (used < first) {
      std::iota(&placed.source_index[used], &placed.source_index[used] + size,
                static_cast<std::uint32_t>(first));
    }
    if (usable > 0) appendRuns(placed, used, usable, columns_per_metre);
    used += usable;
  }
  for (std::vector<float>* coordinate : {&placed.x, &placed.y, &placed.z}) {
    coordinate->resize(used);
  }
  if (used < cloud_size) placed.source_index.resize(used);
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
    movePoints(scan, config, res_g, placed, dropped, shift);
  } else {
    const RigidMove move(scan.T_map_cloud.linear().cast<float>(), shift.cast<float>());
    movePoints(scan, config, res_g, placed, dropped, move);
  }
  return placed;
}

void findRuns(PlacedScan& placed, double res_g) {
  placed.runs.clear();
  const float columns_per_metre = static_cast<float>(1.0 / res_g);
  for (std::size_t first = 0; first < placed.size(); first += kBlock) {
    appendRuns(placed, first, std::min(kBlock, placed.size() - first), columns_per_metre);
  }
}

}  // namespace beautymap
