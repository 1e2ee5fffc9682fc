// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <mutex>
#include <thread>

#include "beautymap/online/online_cleaner.h"

namespace beautymap {

/// For the thread that adds scans, and for what is quick: goes before those who read many tiles. A
/// mutex alone would give these the lock again and again.
class OnlineCleaner::FirstLock {
 public:
  explicit FirstLock(const OnlineCleaner& cleaner) : lock_(cleaner.mutex_, std::defer_lock) {
    ++cleaner.first_waiting_;
    lock_.lock();
    --cleaner.first_waiting_;
  }

 private:
  std::unique_lock<std::mutex> lock_;
};

class OnlineCleaner::ReaderLock {
 public:
  explicit ReaderLock(const OnlineCleaner& cleaner) : lock_(cleaner.mutex_, std::defer_lock) {
    while (cleaner.first_waiting_ > 0) std::this_thread::sleep_for(std::chrono::microseconds(200));
    lock_.lock();
  }
  /// What the last scan saw free is judged with the next scan, unless somebody asks before.
  void settle(const OnlineCleaner& cleaner) const {
    if (!cleaner.settled_) cleaner.map_.settle();
    cleaner.settled_ = true;
  }

 private:
  std::unique_lock<std::mutex> lock_;
};

}  // namespace beautymap
