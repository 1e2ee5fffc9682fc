// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <string>

namespace beautymap {

/// A file that gets its name only when it is complete: until then it lies beside it under a random
/// name, which nobody can foresee and prepare a link for. What was at the name before stays there
/// until commit().
class NewFile {
 public:
  /// @throws InputError when no file can be made in the folder.
  explicit NewFile(std::string path);
  /// Removes the file unless it was committed.
  ~NewFile();
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  std::FILE* stream() const { return file_; }
  const std::string& path() const { return path_; }
  /// Where it lies until commit(), for libraries that open files by name.
  const std::string& temporaryPath() const { return temporary_path_; }
  /// @throws InputError when the disk is full.
  void write(const void* data, std::size_t size);
  /// Brings the file to the disk and gives it its name.
  /// @throws InputError when that fails; what had the name before is then unchanged.
  void commit();
  /// "cannot write PATH: REASON" of errno. @throws InputError
  [[noreturn]] void fail() const;

 private:
  std::string path_;
  std::string temporary_path_;
  std::FILE* file_ = nullptr;
};

/// Makes an empty folder beside `path` with a random name. @throws InputError
std::string newFolderBeside(const std::string& path);

/// Waits until a folder's entries are on the disk, as far as its file system can.
void syncFolder(const std::string& folder);

/// @throws InputError for what is no regular file: reading a pipe or a device may never end.
void requireRegularFile(const std::string& path);

}  // namespace beautymap
