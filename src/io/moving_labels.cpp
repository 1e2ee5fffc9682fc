// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/io/moving_labels.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "beautymap/io/cloud_fields.h"

namespace beautymap {
namespace {

std::uint32_t toLabel(double value) {
  return value >= 0.0 && value <= 4294967295.0 ? static_cast<std::uint32_t>(value) : 0;
}

}  // namespace

std::vector<bool> movingPoints(const pcl::PCLPointCloud2& cloud, const ScanSource& source) {
  if (!FieldReader::has(cloud, "label")) return {};
  const FieldReader label(cloud, "label");
  std::vector<bool> moving(pointCount(cloud), false);
  std::array<double, 1024> block;
  // Neighbouring points mostly have the same label, and most do not move.
  double last = 0.0;
  bool last_moves = source.isMoving(0);
  for (std::size_t first = 0; first < moving.size(); first += block.size()) {
    const std::size_t count = std::min(block.size(), moving.size() - first);
    label.read(first, count, block.data());
    for (std::size_t i = 0; i < count; ++i) {
      if (block[i] != last) last_moves = source.isMoving(toLabel(block[i]));
      last = block[i];
      if (last_moves) moving[first + i] = true;
    }
  }
  return moving;
}

void clearStaticLabels(pcl::PCLPointCloud2& cloud, const ScanSource& source) {
  if (!FieldReader::has(cloud, "label")) return;
  const FieldReader label(cloud, "label");
  const auto field = std::find_if(cloud.fields.begin(), cloud.fields.end(),
                                  [](const auto& candidate) { return candidate.name == "label"; });
  const std::size_t bytes = fieldTypeSize(field->datatype);
  for (std::size_t i = 0; i < pointCount(cloud); ++i) {
    const std::uint32_t value = toLabel(label(i));
    if (value == 0 || source.isMoving(value)) continue;
    std::fill_n(cloud.data.data() + i * cloud.point_step + field->offset, bytes, std::uint8_t{0});
  }
}

}  // namespace beautymap
