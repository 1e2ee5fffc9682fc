// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "rosbag_files.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>

#include "bag_check.h"
#include "beautymap/io/new_file.h"
#include "beautymap/io/scan_source.h"

namespace beautymap {
namespace {

bool startsWith(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

/// rosbag's own messages do not say what a file is instead.
void checkSignature(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) throw InputError(path + ": there is no such file");
  requireRegularFile(path);
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError(path + ": cannot be opened: " + std::strerror(errno));
  std::string start(16, '\0');
  in.read(start.data(), static_cast<std::streamsize>(start.size()));
  if (startsWith(start, "#ROSBAG V") || startsWith(start, "#ROSRECORD V")) return;
  if (startsWith(start, "SQLite format 3") || startsWith(start, "\x89MCAP")) {
    throw InputError(path +
                     ": is a ROS 2 bag; convert it first (for instance with rosbags-convert)");
  }
  throw InputError(path + ": is not a ROS bag (it does not begin with #ROSBAG)");
}

/// By its first chunk: rosbag does not tell.
bool isBz2(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  // The record that precedes the first chunk is padded to 4096 bytes.
  std::string start(8192, '\0');
  in.read(start.data(), static_cast<std::streamsize>(start.size()));
  return start.find("compression=bz2") != std::string::npos;
}

std::unique_ptr<rosbag::Bag> openBag(const std::string& path) {
  checkSignature(path);
  const std::string cure =
      ". The recording was probably cut off: run `rosbag reindex " + path + "` and try again";
  if (const auto wrong = findBagDamage(path)) {
    throw InputError(path + ": is truncated or broken (" + *wrong + ")" + cure);
  }
  try {
    // Not opened by its constructor: what open() has read when it throws is then never freed.
    auto bag = std::make_unique<rosbag::Bag>();
    bag->open(path, rosbag::bagmode::Read);
    return bag;
  } catch (const rosbag::BagUnindexedException&) {
    throw InputError(path + ": has no index" + cure);
  } catch (const rosbag::BagException& error) {
    throw InputError(path + ": is truncated or broken (" + error.what() + ")" + cure);
  } catch (const std::exception& error) {  // the plugin that decrypts is missing
    throw InputError(path + ": cannot be opened (" + error.what() +
                     "); encrypted bags must be decrypted first (rosbag decrypt)");
  }
}

}  // namespace

RosbagFiles::RosbagFiles(const std::vector<std::string>& paths) : paths_(paths) {
  for (const std::string& path : paths) {
    bags_.push_back(openBag(path));
    bz2_ = bz2_ || isBz2(path);
  }
  try {
    listTopics();
  } catch (const rosbag::BagException& error) {
    throw InputError(paths_.front() + ": cannot be read (" + error.what() + ")");
  }
}

void RosbagFiles::listTopics() {
  const auto all = view([](const auto&) { return true; });
  std::map<std::pair<std::string, std::string>, std::size_t> counts;
  for (const auto* connection : all->getConnections()) {
    const auto key = std::make_pair(connection->topic, connection->datatype);
    if (counts.count(key) > 0) continue;
    const auto one = view([&](const auto& candidate) {
      return candidate.topic == key.first && candidate.datatype == key.second;
    });
    counts[key] = one->size();
  }
  for (const auto& [key, count] : counts) topics_.push_back({key.first, key.second, count});
  if (all->size() == 0) {
    throw InputError(paths_.front() + (paths_.size() > 1 ? " and the others hold" : ": holds") +
                     " no messages");
  }
  begin_ = all->getBeginTime();
  end_ = all->getEndTime();
}

std::unique_ptr<rosbag::View> RosbagFiles::view(const Query& query, const ros::Time& begin,
                                                const ros::Time& end) const {
  auto view = std::make_unique<rosbag::View>();
  for (const auto& bag : bags_) {
    view->addQuery(
        *bag, [query](const rosbag::ConnectionInfo* connection) { return query(*connection); },
        begin, end);
  }
  return view;
}

}  // namespace beautymap
