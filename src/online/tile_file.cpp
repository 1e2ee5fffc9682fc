// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/online/tile_file.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <utility>

#include "beautymap/cleaner/make_judgement.h"
#include "beautymap/io/scan_source.h"

namespace beautymap {
namespace {

constexpr char kMagic[] = "beautymap tiles 8\n";
constexpr std::uint32_t kTile = 0x454c4954;  // "TILE"
constexpr std::uint32_t kEnd = 0x20444e45;   // "END "

/// What a tile's bits and bins depend on.
struct Meaning {
  double res_g, res_h, layer_bin_height, fine_bin_height;
  std::int32_t n_bit, bits_below, fine_bins, layer_enabled;
};

Meaning meaningOf(const Config& config) {
  return {config.matrix.res_g,
          config.matrix.res_h,
          config.ground_layer.bin_height,
          config.fine_ground.bin_height,
          config.matrix.n_bit,
          config.matrix.bits_below,
          makeJudgement(config)->newMap().fineBins(),
          config.ground_layer.enabled ? 1 : 0};
}

/// Calls f(data, bytes) for each array of a tile.
template <typename TileType, typename F>
void forEachArray(TileType& tile, F f) {
  f(tile.lowest.data(), sizeof(tile.lowest));
  f(tile.ground.data(), sizeof(tile.ground));
  f(tile.level.data(), sizeof(tile.level));
  f(tile.level_scans.data(), sizeof(tile.level_scans));
  f(tile.below_ground.data(), sizeof(tile.below_ground));
  f(tile.occupied.data(), sizeof(tile.occupied));
  f(tile.dynamic.data(), sizeof(tile.dynamic));
  f(tile.static_bins.data(), sizeof(tile.static_bins));
  f(tile.fine_counts.data(), tile.fine_counts.size() * sizeof(tile.fine_counts[0]));
}

}  // namespace

TileFileWriter::TileFileWriter(std::string path, const Header& header, const Config& config)
    : path_(std::move(path)), temporary_path_(path_ + ".tmp") {
  file_ = std::fopen(temporary_path_.c_str(), "wb");
  if (file_ == nullptr) {
    throw InputError("cannot write '" + path_ + "': " + std::strerror(errno));
  }
  const auto number = [&](std::uint64_t value) { write(&value, sizeof(value)); };
  const auto text = [&](const std::string& value) {
    number(value.size());
    write(value.data(), value.size());
  };
  write(kMagic, sizeof(kMagic) - 1);
  text(config.judgement.method);
  const Meaning meaning = meaningOf(config);
  write(&meaning, sizeof(meaning));
  write(&header.z_origin, sizeof(header.z_origin));
  write(header.up.data(), sizeof(header.up));
  text(header.map_frame);
  number(header.layout.point_step);
  number(header.layout.fields.size());
  for (const pcl::PCLPointField& field : header.layout.fields) {
    text(field.name);
    number(field.offset);
    number(field.datatype);
    number(field.count);
  }
}

TileFileWriter::~TileFileWriter() {
  if (file_ == nullptr) return;
  std::fclose(file_);
  std::remove(temporary_path_.c_str());
}

void TileFileWriter::write(const void* data, std::size_t size) {
  if (std::fwrite(data, 1, size, file_) == size) return;
  throw InputError("cannot write '" + path_ + "': " + std::strerror(errno));
}

void TileFileWriter::append(ColumnIndex index, const Tile& tile, const TilePoints& points) {
  write(&kTile, sizeof(kTile));
  write(&index, sizeof(index));
  forEachArray(tile, [&](const void* data, std::size_t size) { write(data, size); });
  (*tile.state).write(*this);
  writeVector(points.records);
  writeVector(points.column);
  writeVector(points.z);
  writeVector(points.voxels.keys());
}

void TileFileWriter::close() {
  write(&kEnd, sizeof(kEnd));
  std::FILE* file = file_;
  file_ = nullptr;
  const bool written = std::fflush(file) == 0;
  if (std::fclose(file) == 0 && written &&
      std::rename(temporary_path_.c_str(), path_.c_str()) == 0) {
    return;
  }
  const std::string reason = std::strerror(errno);
  std::remove(temporary_path_.c_str());
  throw InputError("cannot write '" + path_ + "': " + reason);
}

TileFileReader::TileFileReader(const std::string& path, const Config& config) : path_(path) {
  std::error_code error;
  size_ = std::filesystem::file_size(path, error);
  file_.reset(error ? nullptr : std::fopen(path.c_str(), "rb"));
  if (!file_) throw InputError("cannot read '" + path + "'");
  char magic[sizeof(kMagic) - 1];
  read(magic, sizeof(magic));
  if (!std::equal(magic, magic + sizeof(magic), kMagic)) {
    throw InputError("'" + path + "' holds no session of this version");
  }
  const auto number = [&] {
    std::uint64_t value = 0;
    read(&value, sizeof(value));
    return value;
  };
  const auto text = [&] {
    std::vector<char> value;
    readVector(value);
    return std::string(value.begin(), value.end());
  };
  const std::string method = text();
  if (method != config.judgement.method) {
    throw InputError("'" + path + "' was made with judgement.method = " + method + ", not with " +
                     config.judgement.method + ": go on with that, or begin a new map");
  }
  Meaning written;
  read(&written, sizeof(written));
  cell_size_ = written.res_g;
  Meaning wanted = meaningOf(config);
  // A session of a room goes on as one, also where the present scans would not say so.
  if (written.res_g == config.matrix.resInRoom()) wanted.res_g = written.res_g;
  if (std::memcmp(&written, &wanted, sizeof(wanted)) != 0) {
    throw InputError("'" + path +
                     "' was written with other matrix, ground_layer or fine_ground parameters: go "
                     "on with those, or begin a new map");
  }
  read(&header_.z_origin, sizeof(header_.z_origin));
  read(header_.up.data(), sizeof(header_.up));
  // Written so that NaN is refused.
  if (!(std::abs(header_.up.norm() - 1.0) < 1e-6)) throw InputError("'" + path + "' is damaged");
  header_.map_frame = text();
  header_.layout.height = 1;
  header_.layout.point_step = static_cast<std::uint32_t>(number());
  for (std::uint64_t left = std::min<std::uint64_t>(number(), 1000); left > 0; --left) {
    pcl::PCLPointField field;
    field.name = text();
    field.offset = static_cast<std::uint32_t>(number());
    field.datatype = static_cast<std::uint8_t>(number());
    field.count = static_cast<std::uint32_t>(number());
    header_.layout.fields.push_back(field);
  }
}

void TileFileReader::read(void* data, std::size_t size) {
  if (std::fread(data, 1, size, file_.get()) == size) return;
  throw InputError("'" + path_ + "' is truncated or damaged");
}

std::size_t TileFileReader::checkedCount(std::uint64_t bytes, std::size_t value_size) const {
  if (bytes > size_ || bytes % value_size != 0) {
    throw InputError("'" + path_ + "' is truncated or damaged");
  }
  return bytes / value_size;
}

bool TileFileReader::next(ColumnIndex& index, Tile& tile, TilePoints& points) {
  std::uint32_t kind = 0;
  read(&kind, sizeof(kind));
  if (kind == kEnd) return false;
  if (kind != kTile) throw InputError("'" + path_ + "' is damaged");
  read(&index, sizeof(index));
  forEachArray(tile, [&](void* data, std::size_t size) { read(data, size); });
  const bool has_state = (*tile.state).read(*this);
  readVector(points.records);
  readVector(points.column);
  readVector(points.z);
  std::vector<std::uint64_t> keys;
  readVector(keys);
  for (const std::uint64_t key : keys) points.voxels.insert(key);
  const bool consistent = has_state && points.z.size() == points.size() &&
                          points.records.size() == points.size() * header_.layout.point_step &&
                          std::all_of(points.column.begin(), points.column.end(),
                                      [](std::uint16_t column) { return column < Tile::kColumns; });
  if (!consistent) throw InputError("'" + path_ + "' is damaged");
  return true;
}

}  // namespace beautymap
