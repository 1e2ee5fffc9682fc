// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/online/output_folder.h"

#include <gtest/gtest.h>

#include "io/io_test_helpers.h"

namespace beautymap {
namespace {

using test::TempFolder;
namespace fs = std::filesystem;

TEST(OutputFolder, PathsInsideAreTaken) {
  const TempFolder folder;
  const std::string root = fs::canonical(folder.path()).string();
  EXPECT_EQ(pathInFolder(root, "a.pcd", ".pcd"), root + "/a.pcd");
  EXPECT_EQ(pathInFolder(root, "a", ".pcd"), root + "/a.pcd");
  EXPECT_EQ(pathInFolder(root, "run 1/./b/../a.pcd", ".pcd"), root + "/run 1/a.pcd");
  EXPECT_EQ(pathInFolder(root, root + "/a.pcd", ".pcd"), root + "/a.pcd");
  EXPECT_EQ(pathInFolder(root + "/later/", "a.pcd", ".pcd"), root + "/later/a.pcd");
}

TEST(OutputFolder, PathsThatLeadOutAreRefused) {
  const TempFolder folder, other;
  const std::string root = folder / "out";
  fs::create_directories(root);
  fs::create_directory_symlink(other.path(), root + "/link");
  fs::create_symlink(other / "file.pcd", root + "/linked.pcd");
  for (const std::string& path :
       {std::string("../a.pcd"), std::string("x/../../a.pcd"), std::string("/etc/a.pcd"),
        folder / "out2/a.pcd", std::string("link/a.pcd"), std::string("linked.pcd")}) {
    EXPECT_THROW(pathInFolder(root, path, ".pcd"), InputError) << path;
  }
}

TEST(OutputFolder, PathsThatNameNoSuchFileAreRefused) {
  const TempFolder folder;
  fs::create_directories(folder / "a.pcd");
  for (const std::string& path :
       {std::string(), std::string("."), std::string(".."), std::string("a/"), std::string("a.txt"),
        std::string("a.pcd"), std::string("a.pcd\0.txt", 10)}) {
    EXPECT_THROW(pathInFolder(folder.path().string(), path, ".pcd"), InputError) << path;
  }
  EXPECT_THROW(pathInFolder("", "a.pcd", ".pcd"), InputError);
}

TEST(OutputFolder, FoldersOfFilesAreMade) {
  const TempFolder folder;
  makeParentFolder(folder / "a/b/c.pcd");
  EXPECT_TRUE(fs::is_directory(folder / "a/b"));
  EXPECT_THROW(makeParentFolder("/proc/nothing/c.pcd"), InputError);
}

}  // namespace
}  // namespace beautymap
