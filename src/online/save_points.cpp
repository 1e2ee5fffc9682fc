// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/online/save_points.h"

#include <utility>

#include "beautymap/io/cloud_fields.h"
#include "beautymap/io/pcd_stream.h"
#include "beautymap/io/scan_conversion.h"
#include "beautymap/io/scan_source.h"

namespace beautymap {

void thinRecords(std::vector<std::uint8_t>& records, const pcl::PCLPointCloud2& layout,
                 double voxel_m) {
  if (voxel_m <= 0.0 || records.empty()) return;
  pcl::PCLPointCloud2 cloud = layout;
  cloud.data = std::move(records);
  cloud.width = static_cast<std::uint32_t>(cloud.data.size() / layout.point_step);
  const PositionReader position(cloud);
  VoxelSet voxels;
  records.clear();
  for (std::size_t i = 0; i < cloud.width; ++i) {
    if (!voxels.insert(voxelKey(position(i), voxel_m))) continue;
    const std::uint8_t* record = cloud.data.data() + i * layout.point_step;
    records.insert(records.end(), record, record + layout.point_step);
  }
}

std::pair<std::uint64_t, std::uint64_t> savePoints(const OnlineCleaner& cleaner,
                                                   const std::string& cleaned_path,
                                                   const std::string& removed_path,
                                                   double voxel_m) {
  const pcl::PCLPointCloud2 layout = cleaner.layout();
  if (layout.fields.empty()) throw InputError("the map is empty: no scan has been added yet");
  PcdStreamWriter cleaned(cleaned_path, layout), removed(removed_path, layout);
  const auto write = [&](std::vector<std::uint8_t>& records, PcdStreamWriter& writer) {
    thinRecords(records, layout, voxel_m);
    for (std::size_t at = 0; at < records.size(); at += layout.point_step) {
      writer.append(records.data() + at);
    }
  };
  for (const ColumnIndex tile : cleaner.tiles()) {
    OnlineCleaner::TileView view;
    if (!cleaner.look(tile, view)) continue;
    write(view.cleaned, cleaned);
    write(view.removed, removed);
  }
  cleaned.close();
  removed.close();
  return {cleaned.size(), removed.size()};
}

}  // namespace beautymap
