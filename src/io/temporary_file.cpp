// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/io/temporary_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "beautymap/io/scan_source.h"

namespace beautymap {
namespace {

int openUnnamed(const std::string& folder) {
#ifdef O_TMPFILE
  const int unnamed = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (unnamed >= 0) return unnamed;
#endif
  std::string name = folder + "/.beautymap-spool-XXXXXX";
  const int named = ::mkstemp(&name[0]);
  if (named >= 0) ::unlink(name.c_str());
  return named;
}

/// Repeats a system call that may do a part only; false when it fails.
template <typename Call>
bool transfer(std::size_t size, Call call) {
  for (std::size_t done = 0; done < size;) {
    const ssize_t more = call(done, size - done);
    if (more < 0 && errno == EINTR) continue;
    if (more <= 0) return false;
    done += static_cast<std::size_t>(more);
  }
  return true;
}

}  // namespace

TemporaryFile::TemporaryFile(const std::string& folder)
    : folder_(folder), descriptor_(openUnnamed(folder)) {
  if (descriptor_ < 0) {
    throw InputError("cannot make a temporary file in '" + folder + "': " + std::strerror(errno));
  }
}

TemporaryFile::~TemporaryFile() { ::close(descriptor_); }

void TemporaryFile::write(std::int64_t& offset, const void* bytes, std::size_t size) const {
  const auto* from = static_cast<const char*>(bytes);
  const bool written = transfer(size, [&](std::size_t done, std::size_t rest) {
    return ::pwrite(descriptor_, from + done, rest, offset + static_cast<std::int64_t>(done));
  });
  if (!written) {
    throw InputError("cannot keep the scans in a temporary file in '" + folder_ +
                     "': " + std::strerror(errno));
  }
  offset += static_cast<std::int64_t>(size);
}

void TemporaryFile::read(std::int64_t& offset, void* bytes, std::size_t size) const {
  auto* to = static_cast<char*>(bytes);
  const bool found = transfer(size, [&](std::size_t done, std::size_t rest) {
    return ::pread(descriptor_, to + done, rest, offset + static_cast<std::int64_t>(done));
  });
  if (!found) throw InputError("cannot read back the temporary file in '" + folder_ + "'");
  offset += static_cast<std::int64_t>(size);
}

}  // namespace beautymap
