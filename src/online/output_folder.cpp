// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/online/output_folder.h"

#include <algorithm>
#include <filesystem>

#include "beautymap/io/scan_source.h"

namespace beautymap {
namespace fs = std::filesystem;

std::string pathInFolder(const std::string& folder, const std::string& path,
                         const std::string& extension) {
  if (path.empty()) throw InputError("the path is empty");
  if (path.find('\0') != std::string::npos) throw InputError("the path holds a zero byte");
  if (folder.empty()) throw InputError("there is no output_folder");
  std::error_code error;
  fs::path file = fs::path(path);
  if (file.filename().empty() || file.filename() == "." || file.filename() == "..") {
    throw InputError("'" + path + "' names no file");
  }
  if (!file.has_extension()) file += extension;
  if (file.extension() != extension) {
    throw InputError("'" + path + "' must end in " + extension);
  }
  fs::path root = fs::weakly_canonical(fs::absolute(folder), error);
  if (root.filename().empty()) root = root.parent_path();  // a slash at its end
  if (error) throw InputError("output_folder '" + folder + "': " + error.message());
  const fs::path target = fs::weakly_canonical(root / file, error);
  if (error) throw InputError("'" + path + "': " + error.message());
  const auto apart = std::mismatch(root.begin(), root.end(), target.begin(), target.end());
  if (apart.first != root.end() || apart.second == target.end()) {
    throw InputError("'" + path + "' is not in the output_folder '" + root.string() + "'");
  }
  if (fs::is_symlink(root / file, error)) throw InputError("'" + path + "' is a symbolic link");
  if (fs::is_directory(target, error)) throw InputError("'" + path + "' is a folder");
  return target.string();
}

void makeParentFolder(const std::string& path) {
  std::error_code error;
  fs::create_directories(fs::path(path).parent_path(), error);
  if (error) {
    throw InputError("cannot make the folder of '" + path + "': " + error.message());
  }
}

}  // namespace beautymap
