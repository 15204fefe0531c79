/// \file
/// Stands for TBB's header of this name in builds with ThreadSanitizer (see CMakePresets.json). The
/// TBB of the system is not compiled for it: it would not see how TBB hands work from thread to
/// thread, and take every loop for a race. Here a second thread, which it does see, helps with
/// each.
#pragma once

#include <tbb/blocked_range.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>

namespace tbb {

template <class Body> void parallel_for(const blocked_range<std::size_t>& range, const Body& body) {
  const std::size_t grain = std::max<std::size_t>(range.grainsize(), 1);
  if (range.size() <= grain) {
    if (!range.empty()) {
      body(range);
    }
    return;
  }
  std::atomic<std::size_t> next = range.begin();
  const auto work = [&] {
    std::size_t first = 0; // relaxed: no order that the bodies could lean on
    while ((first = next.fetch_add(grain, std::memory_order_relaxed)) < range.end()) {
      body(blocked_range<std::size_t>(first, std::min(first + grain, range.end()), grain));
    }
  };
  std::thread other(work);
  work();
  other.join();
}

} // namespace tbb
