// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/io/moving_labels.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "beautymap/io/cloud_fields.h"
#include "beautymap/io/scan_conversion.h"

namespace beautymap {
namespace {

std::uint32_t toLabel(double value) {
  return value >= 0.0 && value <= 4294967295.0 ? static_cast<std::uint32_t>(value) : 0;
}

PointLabel meaningOf(std::uint32_t label, const ScanSource& source) {
  if (source.isMoving(label)) return PointLabel::kMoving;
  return source.isIgnored(label) ? PointLabel::kIgnored : PointLabel::kStatic;
}

template <typename T>
void store(T value, std::uint8_t* to) {
  std::memcpy(to, &value, sizeof(value));
}

/// A number from 0 to 2 as a value of a field's type.
void storeAs(std::uint8_t datatype, std::uint8_t value, std::uint8_t* to) {
  if (datatype == pcl::PCLPointField::FLOAT32) return store(static_cast<float>(value), to);
  if (datatype == pcl::PCLPointField::FLOAT64) return store(static_cast<double>(value), to);
  std::fill_n(to, fieldTypeSize(datatype), std::uint8_t{0});
  *to = value;  // little-endian
}

}  // namespace

std::vector<PointLabel> labelsOf(const pcl::PCLPointCloud2& cloud, const ScanSource& source) {
  if (!FieldReader::has(cloud, "label")) return {};
  const FieldReader label(cloud, "label");
  const PositionReader position(cloud);
  std::vector<PointLabel> labels(pointCount(cloud), PointLabel::kStatic);
  std::array<double, 1024> block;
  // Neighbouring points mostly have the same label.
  double last = 0.0;
  PointLabel meaning = meaningOf(0, source);
  for (std::size_t first = 0; first < labels.size(); first += block.size()) {
    const std::size_t count = std::min(block.size(), labels.size() - first);
    label.read(first, count, block.data());
    for (std::size_t i = 0; i < count; ++i) {
      if (block[i] != last) meaning = meaningOf(toLabel(block[i]), source);
      last = block[i];
      const Eigen::Vector3d point = position(first + i);
      const bool has_position = point.allFinite() && !point.isZero(0.0);
      labels[first + i] = has_position ? meaning : PointLabel::kIgnored;
    }
  }
  return labels;
}

void unifyLabels(pcl::PCLPointCloud2& cloud, const ScanSource& source) {
  if (!FieldReader::has(cloud, "label")) return;
  const FieldReader label(cloud, "label");
  for (std::size_t i = 0; i < pointCount(cloud); ++i) {
    const std::uint32_t value = toLabel(label(i));
    const PointLabel meaning = meaningOf(value, source);
    const std::uint32_t unified = meaning == PointLabel::kStatic   ? 0
                                  : meaning == PointLabel::kMoving ? 1
                                                                   : std::max(value, 2U);
    if (unified == value) continue;
    storeAs(label.datatype(), static_cast<std::uint8_t>(unified),
            cloud.data.data() + i * cloud.point_step + label.offset());
  }
}

}  // namespace beautymap
