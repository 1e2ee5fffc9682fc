// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "pcd_decode.h"

#include <pcl/io/lzf.h>

#include <cctype>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <vector>

#include "beautymap/io/cloud_fields.h"
#include "beautymap/io/scan_source.h"

namespace beautymap {
namespace {

[[noreturn]] void fail(const std::string& path, const std::string& what) {
  throw InputError(path + ": " + what);
}

pcl::PCLPointCloud2 emptyPoints(const std::string& path, const PcdHeader& header) {
  if (header.points > std::numeric_limits<std::uint32_t>::max()) fail(path, "has too many points");
  pcl::PCLPointCloud2 cloud = header.layout;
  cloud.height = 1;
  cloud.width = static_cast<std::uint32_t>(header.points);
  cloud.data.resize(header.points * cloud.point_step);
  cloud.row_step = static_cast<std::uint32_t>(cloud.data.size());
  return cloud;
}

template <typename T, typename Value>
void store(std::uint8_t* to, Value value) {
  const T converted = static_cast<T>(value);
  std::memcpy(to, &converted, sizeof(T));
}

/// Parses one number at `text` into a field's element; returns where it ends, or `text` without
/// one.
const char* parseNumber(const char* text, std::uint8_t datatype, std::uint8_t* to) {
  char* end = nullptr;
  switch (datatype) {
    case pcl::PCLPointField::FLOAT32:
      store<float>(to, std::strtof(text, &end));
      return end;
    case pcl::PCLPointField::FLOAT64:
      store<double>(to, std::strtod(text, &end));
      return end;
    default:
      break;
  }
  // Two's complement: the lowest bytes are the same for every integer type, signed or not.
  const bool is_negative = *text == '-';
  const auto value = is_negative ? static_cast<std::uint64_t>(std::strtoll(text, &end, 10))
                                 : std::strtoull(text, &end, 10);
  std::memcpy(to, &value, fieldTypeSize(datatype));
  return end;
}

const char* skipSpace(const char* text) {
  while (std::isspace(static_cast<unsigned char>(*text)) != 0) ++text;
  return text;
}

const char* skipWord(const char* text) {
  text = skipSpace(text);
  while (*text != '\0' && std::isspace(static_cast<unsigned char>(*text)) == 0) ++text;
  return text;
}

/// @return false when the line does not hold a number in every column of a field
bool parseLine(const char* text, const PcdHeader& header, std::uint8_t* record) {
  std::size_t column = 0;
  for (std::size_t f = 0; f < header.layout.fields.size(); ++f) {
    const auto& field = header.layout.fields[f];
    for (; column < header.ascii_columns[f]; ++column) text = skipWord(text);
    for (std::size_t element = 0; element < field.count; ++element, ++column) {
      text = skipSpace(text);
      const char* const end = parseNumber(
          text, field.datatype, record + field.offset + element * fieldTypeSize(field.datatype));
      if (end == text) return false;
      text = end;
    }
  }
  return true;
}

/// The bytes of one point without padding.
std::uint64_t packedStep(const pcl::PCLPointCloud2& layout) {
  std::uint64_t bytes = 0;
  for (const auto& field : layout.fields) bytes += fieldTypeSize(field.datatype) * field.count;
  return bytes;
}

std::vector<std::uint8_t> decompress(const std::string& path, const PcdHeader& header) {
  std::ifstream in(path, std::ios::binary);
  in.seekg(static_cast<std::streamoff>(header.data_offset));
  std::uint32_t sizes[2] = {};  // compressed, uncompressed
  in.read(reinterpret_cast<char*>(sizes), sizeof(sizes));
  if (!in) fail(path, "is truncated: the size of the compressed points is missing");
  if (sizes[1] != header.points * packedStep(header.layout)) {
    fail(path, "is damaged: its compressed points are not as many as the header promises");
  }
  in.seekg(0, std::ios::end);
  const auto available =
      static_cast<std::uint64_t>(in.tellg()) - header.data_offset - sizeof(sizes);
  if (sizes[0] > available) {
    fail(path, "is truncated: " + std::to_string(sizes[0]) +
                   " bytes of compressed points are promised, " + std::to_string(available) +
                   " are there");
  }
  // Room for a damaged last token, which may reach beyond the end.
  constexpr std::size_t kLongestToken = 512;
  std::vector<char> packed(sizes[0] + kLongestToken, 0);
  in.seekg(static_cast<std::streamoff>(header.data_offset + sizeof(sizes)));
  in.read(packed.data(), sizes[0]);
  std::vector<std::uint8_t> bytes(sizes[1]);
  if (!in || pcl::lzfDecompress(packed.data(), sizes[0], bytes.data(), sizes[1]) != sizes[1]) {
    fail(path, "is damaged: its points cannot be decompressed");
  }
  return bytes;
}

}  // namespace

pcl::PCLPointCloud2 readPcdAscii(const std::string& path, const PcdHeader& header) {
  pcl::PCLPointCloud2 cloud = emptyPoints(path, header);
  std::ifstream in(path, std::ios::binary);
  in.seekg(static_cast<std::streamoff>(header.data_offset));
  std::string line;
  std::size_t point = 0;
  while (point < pointCount(cloud) && std::getline(in, line)) {
    if (*skipSpace(line.c_str()) == '\0') continue;
    if (!parseLine(line.c_str(), header, cloud.data.data() + point * cloud.point_step)) {
      fail(path, "is damaged: point " + std::to_string(point) +
                     " does not have a number for every "
                     "field");
    }
    ++point;
  }
  if (point < pointCount(cloud)) {
    fail(path, "is truncated: its header promises " + std::to_string(header.points) +
                   " points, but there are " + std::to_string(point));
  }
  return cloud;
}

pcl::PCLPointCloud2 readPcdCompressed(const std::string& path, const PcdHeader& header) {
  pcl::PCLPointCloud2 cloud = emptyPoints(path, header);
  if (header.points == 0) return cloud;
  const std::vector<std::uint8_t> bytes = decompress(path, header);
  // All x, then all y, ...
  const std::uint8_t* from = bytes.data();
  for (const auto& field : cloud.fields) {
    const std::size_t size = fieldTypeSize(field.datatype) * field.count;
    for (std::size_t i = 0; i < pointCount(cloud); ++i, from += size) {
      std::memcpy(cloud.data.data() + i * cloud.point_step + field.offset, from, size);
    }
  }
  return cloud;
}

}  // namespace beautymap
