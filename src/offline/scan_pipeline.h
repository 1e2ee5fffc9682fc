// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#if __has_include(<tbb/parallel_pipeline.h>)
#include <tbb/parallel_pipeline.h>
#else  // before oneTBB
#include <tbb/pipeline.h>
#endif

#include <cstddef>
#include <thread>
#include <vector>

namespace beautymap {

/// Calls read(scan) until it returns false, work(scan) and use(scan) for each scan. read and use
/// see the scans one by one in their order; work is done for several at once.
/// @tparam ReadScan  a scan and what becomes of it; its memory is used again for a later one
template <typename ReadScan, typename Read, typename Work, typename Use>
void runPipeline(Read read, Work work, Use use) {
#if __has_include(<tbb/parallel_pipeline.h>)
  using Mode = tbb::filter_mode;
#else
  using Mode = tbb::filter;
#endif
  // No more scans than these are on their way, and they end in their order.
  std::vector<ReadScan> scans(std::thread::hardware_concurrency() + 1);
  std::size_t next = 0;
  const auto input = [&](tbb::flow_control& control) -> ReadScan* {
    ReadScan& scan = scans[next++ % scans.size()];
    if (!read(scan)) control.stop();
    return &scan;
  };
  tbb::parallel_pipeline(
      scans.size(), tbb::make_filter<void, ReadScan*>(Mode::serial_in_order, input) &
                        tbb::make_filter<ReadScan*, ReadScan*>(Mode::parallel,
                                                               [&](ReadScan* scan) {
                                                                 work(*scan);
                                                                 return scan;
                                                               }) &
                        tbb::make_filter<ReadScan*, void>(Mode::serial_in_order,
                                                          [&](ReadScan* scan) { use(*scan); }));
}

}  // namespace beautymap
