// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/io/pcd_header.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <vector>

#include "beautymap/io/cloud_fields.h"
#include "beautymap/io/new_file.h"
#include "beautymap/io/scan_source.h"

namespace beautymap {
namespace {

using Lines = std::map<std::string, std::vector<std::string>>;

constexpr std::size_t kMaxHeaderBytes = 1 << 20;

[[noreturn]] void fail(const std::string& path, const std::string& what) {
  throw InputError(path + ": " + what);
}

/// std::getline(), but a line without end takes no more than `most` bytes.
bool readLine(std::istream& in, std::string& line, std::size_t most) {
  line.clear();
  for (int c = in.get(); c != std::istream::traits_type::eof(); c = in.get()) {
    if (c == '\n') return true;
    if (line.size() >= most) return false;
    line.push_back(static_cast<char>(c));
  }
  return !line.empty();
}

/// The words of every line up to DATA, by the line's first word.
Lines readLines(std::istream& in, const std::string& path) {
  Lines lines;
  std::size_t bytes = 0;
  std::string line;
  while (readLine(in, line, kMaxHeaderBytes - bytes)) {
    bytes += line.size() + 1;
    if (bytes > kMaxHeaderBytes) break;
    std::istringstream words(line);
    std::string key;
    std::string word;
    if (!(words >> key) || key[0] == '#') continue;
    auto& values = lines[key];
    values.clear();
    while (words >> word) values.push_back(word);
    if (key == "DATA") return lines;
    // Binary files of other kinds would otherwise be searched for a DATA line to their end.
    if (line.find('\0') != std::string::npos) break;
  }
  fail(path, "is not a PCD file (no header with a DATA line)");
}

std::uint64_t toNumber(const std::string& word, const std::string& path, const char* key) {
  char* end = nullptr;
  errno = 0;
  const unsigned long long value = std::strtoull(word.c_str(), &end, 10);
  if (errno != 0 || end == word.c_str() || *end != '\0' || word[0] == '-') {
    fail(path, std::string("the PCD header has '") + word + "' as " + key);
  }
  return value;
}

std::uint8_t toDatatype(std::uint64_t size, const std::string& type) {
  const char t = type.empty() ? '?' : type[0];
  if (t == 'F') return size == 4 ? 7 : size == 8 ? 8 : 0;
  if (t != 'I' && t != 'U') return 0;
  const std::uint8_t is_unsigned = t == 'U' ? 1 : 0;
  switch (size) {
    case 1:
      return static_cast<std::uint8_t>(1 + is_unsigned);
    case 2:
      return static_cast<std::uint8_t>(3 + is_unsigned);
    case 4:
      return static_cast<std::uint8_t>(5 + is_unsigned);
    case 8:
      return static_cast<std::uint8_t>(9 + is_unsigned);
    default:
      return 0;
  }
}

char typeLetter(std::uint8_t datatype) {
  switch (datatype) {
    case 1:
    case 3:
    case 5:
    case 9:
      return 'I';
    case 7:
    case 8:
      return 'F';
    default:
      return 'U';
  }
}

void parseFields(const Lines& lines, const std::string& path, PcdHeader& header) {
  const auto line = [&](const char* key) {
    const auto it = lines.find(key);
    return it == lines.end() ? std::vector<std::string>{} : it->second;
  };
  const auto names = line("FIELDS").empty() ? line("COLUMNS") : line("FIELDS");
  const auto sizes = line("SIZE");
  const auto types = line("TYPE");
  auto counts = line("COUNT");
  if (counts.empty()) counts.assign(names.size(), "1");
  if (names.empty() || sizes.size() != names.size() || types.size() != names.size() ||
      counts.size() != names.size()) {
    fail(path, "FIELDS, SIZE, TYPE and COUNT of the PCD header differ in length");
  }
  std::uint64_t offset = 0;
  std::uint64_t column = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::uint64_t size = toNumber(sizes[i], path, "SIZE");
    const std::uint64_t count = std::max<std::uint64_t>(1, toNumber(counts[i], path, "COUNT"));
    constexpr std::uint64_t kMaxPointStep = 1 << 24;
    if (size == 0 || size > 8 || count > kMaxPointStep || offset + size * count > kMaxPointStep) {
      fail(path, "the field '" + names[i] + "' of the PCD header has an impossible size");
    }
    const bool is_padding = names[i] == "_";
    if (!is_padding) {
      pcl::PCLPointField field;
      field.name = names[i];
      field.offset = static_cast<std::uint32_t>(offset);
      field.datatype = toDatatype(size, types[i]);
      field.count = static_cast<std::uint32_t>(count);
      if (field.datatype == 0) {
        fail(path, "the field '" + names[i] + "' of the PCD header has the unknown type " +
                       types[i] + sizes[i]);
      }
      header.layout.fields.push_back(field);
      header.ascii_columns.push_back(column);
    }
    // Only binary records hold the padding; elsewhere a header could ask for any memory with it.
    if (!is_padding || header.encoding == PcdHeader::Encoding::kBinary) offset += size * count;
    column += count;
  }
  header.layout.point_step = static_cast<std::uint32_t>(offset);
}

void parseCounts(const Lines& lines, const std::string& path, PcdHeader& header) {
  const auto number = [&](const char* key, std::uint64_t otherwise) {
    const auto it = lines.find(key);
    if (it == lines.end() || it->second.empty()) return otherwise;
    return toNumber(it->second[0], path, key);
  };
  constexpr std::uint64_t kUnknown = std::numeric_limits<std::uint64_t>::max();
  const std::uint64_t width = number("WIDTH", kUnknown);
  const std::uint64_t height = number("HEIGHT", 1);
  const bool overflows = height > 0 && width != kUnknown && width > kUnknown / height;
  header.points = number("POINTS", width == kUnknown || overflows ? kUnknown : width * height);
  if (header.points == kUnknown)
    fail(path, "the PCD header does not say how many points there are");
  if (width != kUnknown && (overflows || width * height != header.points)) {
    fail(path, "WIDTH x HEIGHT of the PCD header is not POINTS");
  }
}

void parseViewpoint(const Lines& lines, const std::string& path, PcdHeader& header) {
  const auto it = lines.find("VIEWPOINT");
  if (it == lines.end()) return;
  double v[7] = {};
  if (it->second.size() != 7) fail(path, "VIEWPOINT of the PCD header does not hold 7 numbers");
  for (std::size_t i = 0; i < 7; ++i) v[i] = std::strtod(it->second[i].c_str(), nullptr);
  header.origin = {v[0], v[1], v[2]};
  header.orientation = Eigen::Quaterniond(v[3], v[4], v[5], v[6]);
}

void checkFileSize(const std::string& path, const PcdHeader& header) {
  const std::uint64_t file_size = std::filesystem::file_size(path);
  const std::uint64_t available =
      file_size > header.data_offset ? file_size - header.data_offset : 0;
  // An ascii value takes two characters at least, and LZF packs no more than 264 bytes into three.
  const std::uint64_t values = header.ascii_columns.empty() ? 1
                                                            : header.ascii_columns.back() +
                                                                  header.layout.fields.back().count;
  const std::uint64_t step = header.layout.point_step;
  const std::uint64_t most_points =
      header.encoding == PcdHeader::Encoding::kBinary  ? available / step
      : header.encoding == PcdHeader::Encoding::kAscii ? (available + 1) / (2 * values)
                                                       : available * 100 / step;
  if (header.points > most_points) {
    fail(path, "is truncated: its header promises " + std::to_string(header.points) +
                   " points, but " + std::to_string(available) + " bytes follow it");
  }
}

/// The shortest text that reads back as the same number.
std::string shortest(double value) {
  char text[32];
  for (int digits = 6; digits <= 17; ++digits) {
    std::snprintf(text, sizeof(text), "%.*g", digits, value);
    if (std::strtod(text, nullptr) == value) break;
  }
  return text;
}

}  // namespace

PcdHeader readPcdHeader(const std::string& path) {
  requireRegularFile(path);
  std::ifstream in(path, std::ios::binary);
  if (!in) fail(path, std::string("cannot be opened: ") + std::strerror(errno));
  const Lines lines = readLines(in, path);
  PcdHeader header;
  const auto& data = lines.at("DATA");
  const std::string encoding = data.empty() ? "" : data[0];
  if (encoding == "binary") {
    header.encoding = PcdHeader::Encoding::kBinary;
  } else if (encoding == "binary_compressed") {
    header.encoding = PcdHeader::Encoding::kBinaryCompressed;
  } else if (encoding != "ascii") {
    fail(path, "the PCD header has '" + encoding + "' as DATA");
  }
  header.data_offset =
      in.eof() ? std::filesystem::file_size(path) : static_cast<std::uint64_t>(in.tellg());
  parseFields(lines, path, header);
  parseCounts(lines, path, header);
  parseViewpoint(lines, path, header);
  checkFileSize(path, header);
  return header;
}

std::string writePcdHeader(const PcdHeader& header, std::size_t length) {
  std::ostringstream fields, sizes, types, counts, viewpoint;
  for (const auto& field : header.layout.fields) {
    fields << ' ' << field.name;
    sizes << ' ' << fieldTypeSize(field.datatype);
    types << ' ' << typeLetter(field.datatype);
    counts << ' ' << field.count;
  }
  const Eigen::Quaterniond& q = header.orientation;
  for (int i = 0; i < 3; ++i) viewpoint << ' ' << shortest(header.origin[i]);
  for (const double v : {q.w(), q.x(), q.y(), q.z()}) viewpoint << ' ' << shortest(v);

  const std::string comment = "# .PCD v0.7 - Point Cloud Data file format";
  std::ostringstream rest;
  rest << "\nVERSION 0.7\nFIELDS" << fields.str() << "\nSIZE" << sizes.str() << "\nTYPE"
       << types.str() << "\nCOUNT" << counts.str() << "\nWIDTH " << header.points
       << "\nHEIGHT 1\nVIEWPOINT" << viewpoint.str() << "\nPOINTS " << header.points
       << "\nDATA binary\n";
  const std::size_t used = comment.size() + rest.str().size();
  return comment + std::string(length > used ? length - used : 0, ' ') + rest.str();
}

}  // namespace beautymap
