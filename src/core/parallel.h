/// \file
/// Loops over independent items on all cores.
#pragma once

#include <cagewright/core/progress.h>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace cagewright {

/// Calls body(i) for every i in [begin, end), in any order and on any number of threads; `grain`
/// items at least go to a thread at once. The caller bounds the number of threads with a
/// tbb::task_arena. Each body must write only to what belongs to its i: then the result does not
/// depend on the threads.
template <class Body>
void parallel_for(std::size_t begin, std::size_t end, std::size_t grain, const Body& body) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(begin, end, grain), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      body(i);
    }
  });
}

/// The same, but once the computation is to stop, no other item is begun: what was to be written is
/// then not to be used.
template <class Body>
void parallel_for(std::size_t begin, std::size_t end, std::size_t grain, const Progress& progress,
                  const Body& body) {
  parallel_for(begin, end, grain, [&](std::size_t i) {
    if (!progress.cancelled()) {
      body(i);
    }
  });
}

/// Splits [begin, end) into fixed blocks of `block` items, calls body(first, last) -> T for each
/// block in parallel, and folds the results with combine(T&, const T&) in the order of the blocks:
/// floating-point sums come out the same on any number of threads.
template <class T, class Body, class Combine>
T parallel_reduce_ordered(std::size_t begin, std::size_t end, std::size_t block, T identity,
                          const Body& body, const Combine& combine) {
  const std::size_t count = end > begin ? (end - begin + block - 1) / block : 0;
  std::vector<T> partial(count, identity);
  parallel_for(0, count, 1, [&](std::size_t b) {
    const std::size_t first = begin + b * block;
    partial[b] = body(first, std::min(end, first + block));
  });
  for (const T& part : partial) {
    combine(identity, part);
  }
  return identity;
}

} // namespace cagewright
