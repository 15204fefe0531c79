/// \file
/// How many threads a piece of work may use.
#pragma once

#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace cagewright {

/// What a tbb::task_arena is given for work on at most so many threads; 0: on all cores. Threads
/// beyond the cores would be of no use, and TBB warns of them on the error stream.
inline int arena_slots(int threads) {
  return threads > 0 ? std::min(threads, tbb::info::default_concurrency())
                     : tbb::task_arena::automatic;
}

} // namespace cagewright
