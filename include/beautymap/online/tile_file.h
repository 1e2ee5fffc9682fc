// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdio>
#include <memory>
#include <string>

#include "beautymap/config/config.h"
#include "beautymap/matrix/byte_stream.h"
#include "beautymap/matrix/tile_map.h"
#include "beautymap/online/point_store.h"

namespace beautymap {

/// A file of tiles with all their state, from which a map can go on. For the machine and the
/// version that wrote it, not for exchange. Beside its target until close().
class TileFileWriter : private ByteSink {
 public:
  /// What all tiles of a file share.
  struct Header {
    std::string map_frame;
    double z_origin = 0.0;
    Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< see UpDirection
    pcl::PCLPointCloud2 layout;                     ///< of the points' records
  };

  /// @throws InputError when the file cannot be made, or (append, close) the disk is full.
  TileFileWriter(std::string path, const Header& header, const Config& config);
  ~TileFileWriter() override;
  TileFileWriter(const TileFileWriter&) = delete;
  TileFileWriter& operator=(const TileFileWriter&) = delete;
  void append(ColumnIndex index, const Tile& tile, const TilePoints& points);
  void close();

 private:
  void write(const void* data, std::size_t size) override;

  std::string path_;
  std::string temporary_path_;
  std::FILE* file_ = nullptr;
};

class TileFileReader : private ByteSource {
 public:
  /// @throws InputError when it is no such file, or was written with another matrix or
  /// judgement than the configuration's, whose bits and bins would mean something else.
  TileFileReader(const std::string& path, const Config& config);

  const TileFileWriter::Header& header() const { return header_; }
  /// The cells' size [m]: that of the configuration, or in a room.
  double cellSize() const { return cell_size_; }
  /// The next tile; false at the end.
  /// @throws InputError when the file is damaged.
  bool next(ColumnIndex& index, Tile& tile, TilePoints& points);

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  void read(void* data, std::size_t size) override;
  std::size_t checkedCount(std::uint64_t bytes, std::size_t value_size) const override;

  std::string path_;
  std::unique_ptr<std::FILE, Closer> file_;
  std::uint64_t size_ = 0;  ///< of the file [byte]: no damaged count allocates more
  TileFileWriter::Header header_;
  double cell_size_ = 0.0;
};

}  // namespace beautymap
