// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "bag_check.h"

#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <set>
#include <vector>

namespace beautymap {
namespace {

enum Operation : std::uint8_t {
  kMessage = 2,
  kBagHeader = 3,
  kIndex = 4,
  kChunk = 5,
  kChunkInfo = 6,
  kConnection = 7,
};

/// Thrown within this file only.
struct Damage {
  std::string what;
};

struct Record {
  std::uint64_t begin = 0;
  std::uint64_t data = 0;  ///< where it begins [byte]
  std::uint32_t data_size = 0;
  std::uint8_t operation = 0;
  std::map<std::string, std::string> fields;

  std::uint64_t end() const { return data + data_size; }
  template <typename T>
  T number(const char* name) const {
    const auto found = fields.find(name);
    if (found == fields.end() || found->second.size() != sizeof(T)) {
      throw Damage{std::string("a record without '") + name + "' at byte " + std::to_string(begin)};
    }
    T value;
    std::memcpy(&value, found->second.data(), sizeof(T));
    return value;
  }
};

class BagCheck {
 public:
  explicit BagCheck(const std::string& path) : in_(path, std::ios::binary) {
    in_.seekg(0, std::ios::end);
    size_ = static_cast<std::uint64_t>(in_.tellg());
  }

  void run() {
    std::string version(13, '\0');
    in_.seekg(0);
    in_.read(version.data(), static_cast<std::streamsize>(version.size()));
    if (version != "#ROSBAG V2.0\n") return;  // the library converts what is older
    Record chunk;
    bool in_chunk = false;
    for (std::uint64_t at = version.size(); at < size_;) {
      const Record record = read(at, size_);
      switch (record.operation) {
        case kBagHeader:
          checkBagHeader(record);
          if (record.number<std::uint64_t>("index_pos") == 0) return;  // the library says so
          break;
        case kChunk:
          chunk = record;
          in_chunk = true;
          chunks_.insert(record.begin);
          checkChunk(record);
          break;
        case kIndex:
          if (!in_chunk) throw Damage{"an index without chunk at byte " + std::to_string(at)};
          checkIndex(record, chunk);
          break;
        case kChunkInfo:
          checkChunkInfo(record);
          break;
        case kConnection:
          record.number<std::uint32_t>("conn");
          readFields(record.data, record.data_size);
          break;
        default:
          throw Damage{"a record of unknown kind at byte " + std::to_string(at)};
      }
      at = record.end();
    }
    for (const std::uint64_t position : promised_chunks_) {
      if (chunks_.count(position) == 0) {
        throw Damage{"no chunk where one is promised, at byte " + std::to_string(position)};
      }
    }
  }

 private:
  std::uint32_t readLength(std::uint64_t at, std::uint64_t limit) {
    std::uint32_t length = 0;
    if (at + sizeof(length) > limit) throw Damage{"it ends at byte " + std::to_string(at)};
    readBytes(at, &length, sizeof(length));
    if (length > limit - at - sizeof(length)) {
      throw Damage{"a length at byte " + std::to_string(at) + " reaches beyond the end"};
    }
    return length;
  }

  void readBytes(std::uint64_t at, void* to, std::size_t size) {
    // Seeking throws the stream's buffer away; most records follow each other.
    if (at != position_) in_.seekg(static_cast<std::streamoff>(at));
    if (!in_.read(static_cast<char*>(to), static_cast<std::streamsize>(size))) {
      throw Damage{"it cannot be read at byte " + std::to_string(at)};
    }
    position_ = at + size;
  }

  std::map<std::string, std::string> readFields(std::uint64_t at, std::uint32_t size) {
    constexpr std::uint32_t kLongest = 1 << 24;  // message definitions
    if (size > kLongest) throw Damage{"a header of " + std::to_string(size) + " bytes"};
    std::string text(size, '\0');
    readBytes(at, text.data(), size);
    std::map<std::string, std::string> fields;
    for (std::size_t i = 0; i < text.size();) {
      std::uint32_t length = 0;
      if (text.size() - i >= sizeof(length)) std::memcpy(&length, &text[i], sizeof(length));
      i += sizeof(length);
      const std::size_t equals = text.find('=', i);
      if (i >= text.size() || length > text.size() - i || equals >= i + length) {
        throw Damage{"a header that is no list of fields at byte " + std::to_string(at)};
      }
      fields[text.substr(i, equals - i)] = text.substr(equals + 1, i + length - equals - 1);
      i += length;
    }
    return fields;
  }

  Record read(std::uint64_t at, std::uint64_t limit) {
    Record record;
    record.begin = at;
    const std::uint32_t header_size = readLength(at, limit);
    at += sizeof(header_size);
    record.fields = readFields(at, header_size);
    record.operation = record.number<std::uint8_t>("op");
    at += header_size;
    record.data_size = readLength(at, limit);
    record.data = at + sizeof(record.data_size);
    return record;
  }

  void checkBagHeader(const Record& record) {
    record.number<std::uint32_t>("conn_count");
    record.number<std::uint32_t>("chunk_count");
    const auto index = record.number<std::uint64_t>("index_pos");
    if (index > size_) throw Damage{"its index lies beyond its end"};
  }

  void checkChunk(const Record& chunk) {
    const auto size = chunk.number<std::uint32_t>("size");
    const std::string compression =
        chunk.fields.count("compression") > 0 ? chunk.fields.at("compression") : std::string();
    message_offsets_.clear();
    is_plain_ = compression == "none";
    // lz4 packs no more than 255 bytes into one, and a little for its frame.
    const bool too_large = compression == "lz4" && size / 256 > chunk.data_size;
    if (too_large || (is_plain_ && size != chunk.data_size)) {
      throw Damage{"a chunk of an impossible size at byte " + std::to_string(chunk.begin)};
    }
    if (!is_plain_) return;
    for (std::uint64_t at = chunk.data; at < chunk.end();) {
      const Record record = read(at, chunk.end());
      if (record.operation == kMessage) {
        record.number<std::uint32_t>("conn");
        record.number<std::uint64_t>("time");
        message_offsets_.insert(static_cast<std::uint32_t>(at - chunk.data));
      } else if (record.operation != kConnection) {
        throw Damage{"a record that does not belong into a chunk at byte " + std::to_string(at)};
      }
      at = record.end();
    }
  }

  void checkIndex(const Record& index, const Record& chunk) {
    const auto version = index.number<std::uint32_t>("ver");
    const auto count = index.number<std::uint32_t>("count");
    index.number<std::uint32_t>("conn");
    constexpr std::uint32_t kEntry = 12;  // time, offset
    if (version != 1 || std::uint64_t{count} * kEntry != index.data_size) {
      throw Damage{"an index of an impossible size at byte " + std::to_string(index.begin)};
    }
    const auto size = chunk.number<std::uint32_t>("size");
    for (std::uint32_t i = 0; i < count; ++i) {
      std::uint32_t entry[3];
      readBytes(index.data + std::uint64_t{i} * kEntry, entry, sizeof(entry));
      const bool is_there = is_plain_ ? message_offsets_.count(entry[2]) > 0 : entry[2] < size;
      if (!is_there) {
        throw Damage{"an index at byte " + std::to_string(index.begin) +
                     " names a message that is not there"};
      }
    }
  }

  void checkChunkInfo(const Record& info) {
    constexpr std::uint32_t kEntry = 8;  // connection, messages
    if (std::uint64_t{info.number<std::uint32_t>("count")} * kEntry != info.data_size) {
      throw Damage{"a chunk info of an impossible size at byte " + std::to_string(info.begin)};
    }
    promised_chunks_.push_back(info.number<std::uint64_t>("chunk_pos"));
  }

  std::ifstream in_;
  std::uint64_t size_ = 0;
  std::uint64_t position_ = 0;
  bool is_plain_ = false;
  std::set<std::uint32_t> message_offsets_;  ///< in the last chunk, if it is not compressed
  std::set<std::uint64_t> chunks_;
  std::vector<std::uint64_t> promised_chunks_;
};

}  // namespace

std::optional<std::string> findBagDamage(const std::string& path) {
  try {
    BagCheck(path).run();
  } catch (const Damage& damage) {
    return damage.what;
  }
  return std::nullopt;
}

}  // namespace beautymap
