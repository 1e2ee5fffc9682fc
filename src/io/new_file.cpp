// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/io/new_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>

#include "beautymap/io/scan_source.h"

namespace beautymap {
namespace {

/// Permissions as if the file had been made with its own name: mkstemp() and mkdtemp() give none to
/// others.
void givePermissions(const std::string& path, mode_t most) {
  const mode_t mask = ::umask(0);
  ::umask(mask);
  ::chmod(path.c_str(), most & ~mask);
}

/// "out/" and "out" are the same folder.
std::string randomNameBeside(const std::string& path) {
  const std::size_t end = path.find_last_not_of('/');
  return path.substr(0, end == std::string::npos ? path.size() : end + 1) + ".tmp-XXXXXX";
}

std::string folderOf(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

}  // namespace

NewFile::NewFile(std::string path)
    : path_(std::move(path)), temporary_path_(randomNameBeside(path_)) {
  // O_EXCL: an existing file or link is never opened.
  const int descriptor = ::mkostemp(&temporary_path_[0], O_CLOEXEC);
  if (descriptor < 0) fail();
  givePermissions(temporary_path_, 0666);
  file_ = ::fdopen(descriptor, "wb");
  if (file_ == nullptr) {
    ::close(descriptor);
    std::remove(temporary_path_.c_str());
    fail();
  }
}

NewFile::~NewFile() {
  if (file_ != nullptr) std::fclose(file_);
  if (!temporary_path_.empty()) std::remove(temporary_path_.c_str());
}

void NewFile::fail() const {
  throw InputError("cannot write " + path_ + ": " + std::strerror(errno));
}

void NewFile::write(const void* data, std::size_t size) {
  if (size > 0 && std::fwrite(data, 1, size, file_) != size) fail();
}

void NewFile::commit() {
  if (std::fflush(file_) != 0 || ::fsync(::fileno(file_)) != 0) fail();
  if (std::fclose(std::exchange(file_, nullptr)) != 0) fail();
  if (std::rename(temporary_path_.c_str(), path_.c_str()) != 0) fail();
  temporary_path_.clear();
  syncFolder(folderOf(path_));
}

std::string newFolderBeside(const std::string& path) {
  std::string folder = randomNameBeside(path);
  std::error_code ignored;
  std::filesystem::create_directories(folderOf(folder), ignored);
  if (::mkdtemp(&folder[0]) == nullptr) {
    throw InputError("cannot create a folder beside " + path + ": " + std::strerror(errno));
  }
  givePermissions(folder, 0777);
  return folder;
}

void syncFolder(const std::string& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

void requireRegularFile(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw InputError(path + ": there is no such file");
  if (std::filesystem::is_directory(status)) throw InputError(path + ": is a folder, not a file");
  if (!std::filesystem::is_regular_file(status)) {
    throw InputError(path + ": is a device or a pipe, not a file");
  }
}

}  // namespace beautymap
