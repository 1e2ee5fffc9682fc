// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

namespace beautymap {

/// Looks for damage that librosbag does not check and ends the process with: lengths and offsets of
/// the records of a bag (format 2.0) that point out of the file or out of their chunk. Reads the
/// records' headers only; the contents of compressed chunks have checksums.
/// @return what is wrong; nothing when the library can read the file
std::optional<std::string> findBagDamage(const std::string& path);

}  // namespace beautymap
