// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/io/pcd_stream.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>
#include <utility>

#include "beautymap/io/cloud_fields.h"
#include "beautymap/io/scan_source.h"
#include "pcd_decode.h"

namespace beautymap {
namespace {

constexpr std::size_t kBufferBytes = 1 << 20;

bool sameFields(const std::vector<pcl::PCLPointField>& a,
                const std::vector<pcl::PCLPointField>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& l, const auto& r) {
    return l.name == r.name && l.offset == r.offset && l.datatype == r.datatype &&
           l.count == r.count;
  });
}

pcl::PCLPointCloud2 readWhole(const std::string& path, const PcdHeader& header) {
  pcl::PCLPointCloud2 cloud = header.encoding == PcdHeader::Encoding::kAscii
                                  ? readPcdAscii(path, header)
                                  : readPcdCompressed(path, header);
  if (const auto wrong = normalizeCloud(cloud)) throw InputError(path + ": " + *wrong);
  return cloud;
}

void readBinaryBlocks(const std::string& path, const PcdHeader& header,
                      const std::function<void(const pcl::PCLPointCloud2&)>& block,
                      std::size_t block_points, PcdRange range) {
  pcl::PCLPointCloud2 cloud = header.layout;
  cloud.height = 1;
  if (const auto wrong = normalizeCloud(cloud)) throw InputError(path + ": " + *wrong);
  std::ifstream in(path, std::ios::binary);
  in.seekg(static_cast<std::streamoff>(header.data_offset + range.begin * cloud.point_step));
  for (std::uint64_t done = range.begin; done < range.end; done += cloud.width) {
    cloud.width = static_cast<std::uint32_t>(
        std::min<std::uint64_t>({block_points, range.end - done, 1U << 30}));
    cloud.data.resize(static_cast<std::size_t>(cloud.width) * cloud.point_step);
    cloud.row_step = static_cast<std::uint32_t>(cloud.data.size());
    if (!in.read(reinterpret_cast<char*>(cloud.data.data()),
                 static_cast<std::streamsize>(cloud.data.size()))) {
      throw InputError(path + ": cannot be read to its end: " + std::strerror(errno));
    }
    block(cloud);
  }
}

/// Points [first, first + count) of a normalized cloud.
pcl::PCLPointCloud2 slice(const pcl::PCLPointCloud2& cloud, std::size_t first, std::size_t count) {
  pcl::PCLPointCloud2 part;
  part.header = cloud.header;
  part.fields = cloud.fields;
  part.point_step = cloud.point_step;
  part.is_dense = cloud.is_dense;
  part.is_bigendian = cloud.is_bigendian;
  part.height = 1;
  part.width = static_cast<std::uint32_t>(count);
  const auto begin = cloud.data.begin() + static_cast<std::ptrdiff_t>(first * cloud.point_step);
  part.data.assign(begin, begin + static_cast<std::ptrdiff_t>(count * cloud.point_step));
  part.row_step = static_cast<std::uint32_t>(part.data.size());
  return part;
}

}  // namespace

PcdStreamWriter::PcdStreamWriter(std::string path, const pcl::PCLPointCloud2& like,
                                 const Eigen::Isometry3d& viewpoint)
    : file_(std::move(path)),
      input_fields_(like.fields),
      input_step_(like.point_step),
      buffer_(kBufferBytes) {
  std::size_t offset = 0;
  for (auto field : like.fields) {
    const std::size_t size = fieldTypeSize(field.datatype) * field.count;
    if (size == 0) continue;
    appendRun(runs_, {field.offset, offset, size});
    field.offset = static_cast<std::uint32_t>(offset);
    header_.layout.fields.push_back(field);
    offset += size;
  }
  header_.layout.point_step = static_cast<std::uint32_t>(offset);
  if (offset == 0) throw InputError("cannot write " + file_.path() + ": the points have no fields");
  if (buffer_.size() < offset) buffer_.resize(offset);
  header_.origin = viewpoint.translation();
  header_.orientation = Eigen::Quaterniond(viewpoint.linear());

  // Room for any number of points: close() writes the header again.
  header_.points = std::numeric_limits<std::uint64_t>::max();
  const std::string header = writePcdHeader(header_);
  header_.points = 0;
  header_length_ = header.size();
  std::setvbuf(file_.stream(), nullptr, _IONBF, 0);
  file_.write(header.data(), header.size());
}

void PcdStreamWriter::append(const std::uint8_t* point_records, std::size_t count) {
  const std::size_t step = header_.layout.point_step;
  const bool is_packed = runs_.size() == 1 && runs_[0].from == 0 && input_step_ == step;
  header_.points += count;
  if (is_packed && count * step >= buffer_.size()) {
    flush();
    file_.write(point_records, count * step);
    return;
  }
  while (count > 0) {
    if (buffered_ + step > buffer_.size()) flush();
    const std::size_t fitting = std::min(count, (buffer_.size() - buffered_) / step);
    std::uint8_t* to = buffer_.data() + buffered_;
    if (is_packed) {
      std::memcpy(to, point_records, fitting * step);
    } else {
      for (std::size_t i = 0; i < fitting; ++i) {
        copyRuns(runs_, point_records + i * input_step_, to + i * step);
      }
    }
    buffered_ += fitting * step;
    point_records += fitting * input_step_;
    count -= fitting;
  }
}

void PcdStreamWriter::flush() { file_.write(buffer_.data(), std::exchange(buffered_, 0)); }

void PcdStreamWriter::close() {
  if (closed_) return;
  flush();
  const std::string header = writePcdHeader(header_, header_length_);
  if (std::fseek(file_.stream(), 0, SEEK_SET) != 0) file_.fail();
  file_.write(header.data(), header.size());
  file_.commit();
  closed_ = true;
}

bool PcdStreamWriter::accepts(const pcl::PCLPointCloud2& cloud) const {
  return cloud.point_step == input_step_ && sameFields(cloud.fields, input_fields_);
}

void readPcdBlocks(const std::string& path,
                   const std::function<void(const pcl::PCLPointCloud2&)>& block,
                   std::size_t block_points, PcdRange range) {
  const PcdHeader header = readPcdHeader(path);
  block_points = std::max<std::size_t>(1, block_points);
  range.end = std::min(range.end, header.points);
  if (header.encoding == PcdHeader::Encoding::kBinary) {
    readBinaryBlocks(path, header, block, block_points, range);
    return;
  }
  const pcl::PCLPointCloud2 cloud = readWhole(path, header);
  for (std::size_t first = range.begin; first < range.end; first += block_points) {
    block(slice(cloud, first, std::min<std::size_t>(block_points, range.end - first)));
  }
}

pcl::PCLPointCloud2 readPcd(const std::string& path) {
  const PcdHeader header = readPcdHeader(path);
  if (header.encoding != PcdHeader::Encoding::kBinary) return readWhole(path, header);
  pcl::PCLPointCloud2 whole;
  readBinaryBlocks(path, header, [&](const auto& cloud) { whole = cloud; }, header.points,
                   {0, header.points});
  return whole;
}

}  // namespace beautymap
