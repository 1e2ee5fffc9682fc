// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace beautymap {

/// Where a file that somebody else asks for may be: in a folder, whatever the path says (`..`,
/// absolute paths, symbolic links that lead out).
/// @param extension  with its dot; added where the path has none
/// @throws InputError for a path that is empty, leads out of the folder, has another extension, or
/// is a folder.
std::string pathInFolder(const std::string& folder, const std::string& path,
                         const std::string& extension);

/// Makes the folder that a file is to be in. @throws InputError
void makeParentFolder(const std::string& path);

}  // namespace beautymap
