// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/io/cloud_fields.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

#include "beautymap/io/copy_runs.h"
#include "beautymap/io/scan_source.h"

namespace beautymap {
namespace {

// pcl::PCLPointField names the last three only since PCL 1.12; PointCloud2 messages know the first
// eight.
enum Datatype : std::uint8_t {
  kInt8 = 1,
  kUint8 = 2,
  kInt16 = 3,
  kUint16 = 4,
  kInt32 = 5,
  kUint32 = 6,
  kFloat32 = 7,
  kFloat64 = 8,
  kInt64 = 9,
  kUint64 = 10,
  kBool = 11,
};

const char* const kCoordinates[] = {"x", "y", "z"};

template <typename T>
T load(const std::uint8_t* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

template <typename T>
void store(std::uint8_t* bytes, double value) {
  const T converted = static_cast<T>(value);
  std::memcpy(bytes, &converted, sizeof(T));
}

const pcl::PCLPointField* findField(const pcl::PCLPointCloud2& cloud, const std::string& name) {
  for (const auto& field : cloud.fields) {
    if (field.name == name) return &field;
  }
  return nullptr;
}

std::optional<std::string> checkFields(pcl::PCLPointCloud2& cloud) {
  if (cloud.point_step == 0) return "its point_step is 0";
  for (auto& field : cloud.fields) {
    if (field.count == 0) field.count = 1;
    // A field of unknown type is never read; nothing needs to be known about its size.
    const std::uint64_t size = fieldTypeSize(field.datatype);
    if (size > 0 && field.offset + size * field.count > cloud.point_step) {
      return "its field '" + field.name + "' reaches beyond the point_step of " +
             std::to_string(cloud.point_step) + " bytes";
    }
  }
  for (const char* name : kCoordinates) {
    const auto* field = findField(cloud, name);
    if (field == nullptr) {
      return std::string("it has no field '") + name + "' (fields: " + fieldNames(cloud) + ")";
    }
    if (fieldTypeSize(field->datatype) == 0) {
      return std::string("its field '") + name + "' has the unknown datatype " +
             std::to_string(field->datatype);
    }
  }
  return std::nullopt;
}

/// Checks the sizes and removes row padding.
std::optional<std::string> compactRows(pcl::PCLPointCloud2& cloud) {
  const std::uint64_t points = static_cast<std::uint64_t>(cloud.width) * cloud.height;
  const std::uint64_t available = cloud.data.size() / cloud.point_step;
  const std::string promise = std::to_string(cloud.width) + " x " + std::to_string(cloud.height) +
                              " points of " + std::to_string(cloud.point_step) + " bytes";
  const std::string too_short =
      "its " + std::to_string(cloud.data.size()) + " bytes are too few for " + promise;
  if (points > available) return too_short;
  if (points > std::numeric_limits<std::uint32_t>::max()) return "it has too many points";

  const std::uint64_t row_bytes = static_cast<std::uint64_t>(cloud.width) * cloud.point_step;
  const std::uint64_t row_step =
      cloud.height > 1 && cloud.row_step > 0 ? cloud.row_step : row_bytes;
  if (row_step < row_bytes) {
    return "its row_step of " + std::to_string(cloud.row_step) + " bytes is too small for " +
           promise;
  }
  if (points > 0 && row_step * (cloud.height - 1) + row_bytes > cloud.data.size()) {
    return too_short + " with a row_step of " + std::to_string(cloud.row_step);
  }
  if (points > 0 && row_step > row_bytes) {
    for (std::uint64_t row = 1; row < cloud.height; ++row) {
      std::memmove(cloud.data.data() + row * row_bytes, cloud.data.data() + row * row_step,
                   row_bytes);
    }
  }
  cloud.data.resize(points * cloud.point_step);
  cloud.width = static_cast<std::uint32_t>(points);
  cloud.height = 1;
  cloud.row_step = static_cast<std::uint32_t>(cloud.data.size());
  return std::nullopt;
}

void swapToLittleEndian(pcl::PCLPointCloud2& cloud) {
  // Fields may overlap (rgb and rgba): no byte is swapped twice.
  std::vector<bool> swapped(cloud.point_step, false);
  for (const auto& field : cloud.fields) {
    const std::size_t size = fieldTypeSize(field.datatype);
    if (size < 2) continue;
    for (std::size_t element = 0; element < field.count; ++element) {
      const std::size_t begin = field.offset + element * size;
      const auto first = swapped.begin() + static_cast<std::ptrdiff_t>(begin);
      const auto last = first + static_cast<std::ptrdiff_t>(size);
      if (std::find(first, last, true) != last) continue;
      std::fill(first, last, true);
      for (std::size_t at = begin; at < cloud.data.size(); at += cloud.point_step) {
        std::reverse(cloud.data.data() + at, cloud.data.data() + at + size);
      }
    }
  }
}

/// Moves x, y, z of type T where they are.
template <typename T>
void moveInPlace(pcl::PCLPointCloud2& cloud, const Eigen::Isometry3d& T_map_cloud) {
  const Eigen::Matrix3d r = T_map_cloud.linear();
  const Eigen::Vector3d t = T_map_cloud.translation();
  const std::size_t ox = findField(cloud, "x")->offset;
  const std::size_t oy = findField(cloud, "y")->offset;
  const std::size_t oz = findField(cloud, "z")->offset;
  std::uint8_t* record = cloud.data.data();
  for (std::size_t i = 0; i < pointCount(cloud); ++i, record += cloud.point_step) {
    const double x = load<T>(record + ox);
    const double y = load<T>(record + oy);
    const double z = load<T>(record + oz);
    store<T>(record + ox, r(0, 0) * x + r(0, 1) * y + r(0, 2) * z + t.x());
    store<T>(record + oy, r(1, 0) * x + r(1, 1) * y + r(1, 2) * z + t.y());
    store<T>(record + oz, r(2, 0) * x + r(2, 1) * y + r(2, 2) * z + t.z());
  }
}

bool isCoordinate(const pcl::PCLPointField& field) {
  return field.name == "x" || field.name == "y" || field.name == "z";
}

/// A cloud without points, with the known fields of `cloud` in their order, x, y, z of another
/// type.
/// @param runs  how the other fields are copied
pcl::PCLPointCloud2 packedLayout(const pcl::PCLPointCloud2& cloud, std::uint8_t coordinate_type,
                                 std::vector<CopyRun>& runs) {
  pcl::PCLPointCloud2 out;
  out.header = cloud.header;
  out.is_dense = cloud.is_dense;
  out.is_bigendian = false;
  out.height = 1;
  std::size_t offset = 0;
  for (auto field : cloud.fields) {
    const bool is_repeated = findField(out, field.name) != nullptr;
    if (fieldTypeSize(field.datatype) == 0 || (isCoordinate(field) && is_repeated)) continue;
    const std::size_t from = field.offset;
    field.offset = static_cast<std::uint32_t>(offset);
    if (isCoordinate(field)) {
      field.datatype = coordinate_type;
      field.count = 1;
    } else {
      appendRun(runs, {from, offset, fieldTypeSize(field.datatype) * field.count});
    }
    offset += fieldTypeSize(field.datatype) * field.count;
    out.fields.push_back(field);
  }
  out.point_step = static_cast<std::uint32_t>(offset);
  return out;
}

}  // namespace

std::size_t fieldTypeSize(std::uint8_t datatype) {
  switch (datatype) {
    case kInt8:
    case kUint8:
    case kBool:
      return 1;
    case kInt16:
    case kUint16:
      return 2;
    case kInt32:
    case kUint32:
    case kFloat32:
      return 4;
    case kFloat64:
    case kInt64:
    case kUint64:
      return 8;
    default:
      return 0;
  }
}

std::optional<std::string> normalizeCloud(pcl::PCLPointCloud2& cloud) {
  if (auto wrong = checkFields(cloud)) return wrong;
  if (auto wrong = compactRows(cloud)) return wrong;
  // Without points nothing bounds the point_step.
  if (cloud.is_bigendian && pointCount(cloud) > 0) swapToLittleEndian(cloud);
  cloud.is_bigendian = false;
  return std::nullopt;
}

std::string fieldNames(const pcl::PCLPointCloud2& cloud) {
  std::string names;
  for (const auto& field : cloud.fields) names += (names.empty() ? "" : " ") + field.name;
  return names.empty() ? "none" : names;
}

FieldReader::FieldReader(const pcl::PCLPointCloud2& cloud, const std::string& name) {
  const auto* field = findField(cloud, name);
  if (field == nullptr || fieldTypeSize(field->datatype) == 0) {
    throw InputError("the cloud has no numeric field '" + name + "' (fields: " + fieldNames(cloud) +
                     ")");
  }
  offset_ = field->offset;
  first_ = cloud.data.data() + offset_;
  point_step_ = cloud.point_step;
  datatype_ = field->datatype;
}

bool FieldReader::has(const pcl::PCLPointCloud2& cloud, const std::string& name) {
  const auto* field = findField(cloud, name);
  return field != nullptr && fieldTypeSize(field->datatype) > 0;
}

double FieldReader::operator()(std::size_t point) const {
  double value = 0.0;
  read(point, 1, &value);
  return value;
}

void FieldReader::read(std::size_t first, std::size_t count, double* values) const {
  const auto readAs = [&](auto type) {
    const std::uint8_t* bytes = first_ + first * point_step_;
    for (std::size_t i = 0; i < count; ++i, bytes += point_step_) {
      values[i] = static_cast<double>(load<decltype(type)>(bytes));
    }
  };
  switch (datatype_) {
    case kInt8:
      return readAs(std::int8_t{});
    case kInt16:
      return readAs(std::int16_t{});
    case kUint16:
      return readAs(std::uint16_t{});
    case kInt32:
      return readAs(std::int32_t{});
    case kUint32:
      return readAs(std::uint32_t{});
    case kFloat32:
      return readAs(float{});
    case kFloat64:
      return readAs(double{});
    case kInt64:
      return readAs(std::int64_t{});
    case kUint64:
      return readAs(std::uint64_t{});
    default:  // kUint8 and kBool: the constructor lets no unknown type pass
      return readAs(std::uint8_t{});
  }
}

pcl::PCLPointCloud2 moveCloud(pcl::PCLPointCloud2 cloud, const Eigen::Isometry3d& T_map_cloud,
                              bool as_float64) {
  pcl::PCLPointCloud2 moved;
  moveCloud(cloud, T_map_cloud, as_float64, moved);
  return moved;
}

void moveCloud(pcl::PCLPointCloud2& cloud, const Eigen::Isometry3d& T_map_cloud, bool as_float64,
               pcl::PCLPointCloud2& moved) {
  const std::uint8_t wanted = as_float64 ? kFloat64 : kFloat32;
  const FieldReader x(cloud, "x");
  const FieldReader y(cloud, "y");
  const FieldReader z(cloud, "z");
  if (x.datatype() == wanted && y.datatype() == wanted && z.datatype() == wanted) {
    std::swap(moved, cloud);
    if (T_map_cloud.matrix() == Eigen::Matrix4d::Identity()) return;
    as_float64 ? moveInPlace<double>(moved, T_map_cloud) : moveInPlace<float>(moved, T_map_cloud);
    return;
  }

  std::vector<CopyRun> runs;
  std::vector<std::uint8_t> recycled = std::move(moved.data);
  moved = packedLayout(cloud, wanted, runs);
  moved.data = std::move(recycled);
  moved.width = cloud.width;
  moved.data.resize(pointCount(cloud) * moved.point_step);
  moved.row_step = static_cast<std::uint32_t>(moved.data.size());
  const std::size_t offsets[] = {findField(moved, "x")->offset, findField(moved, "y")->offset,
                                 findField(moved, "z")->offset};
  for (std::size_t i = 0; i < pointCount(cloud); ++i) {
    std::uint8_t* record = moved.data.data() + i * moved.point_step;
    copyRuns(runs, cloud.data.data() + i * cloud.point_step, record);
    const Eigen::Vector3d point = T_map_cloud * Eigen::Vector3d(x(i), y(i), z(i));
    for (int axis = 0; axis < 3; ++axis) {
      as_float64 ? store<double>(record + offsets[axis], point[axis])
                 : store<float>(record + offsets[axis], point[axis]);
    }
  }
}

std::uint64_t voxelKey(const Eigen::Vector3d& position, double voxel_m) {
  constexpr std::uint64_t kMask = (std::uint64_t{1} << 21) - 1;
  const auto axis = [&](double value) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(value / voxel_m))) &
           kMask;
  };
  return axis(position.x()) << 42 | axis(position.y()) << 21 | axis(position.z());
}

}  // namespace beautymap
