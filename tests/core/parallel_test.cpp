#include "core/parallel.h"

#include "core/random.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <vector>

namespace cagewright {
namespace {

double sum_on(int threads, const std::vector<double>& values) {
  tbb::task_arena arena(threads);
  return arena.execute([&] {
    return parallel_reduce_ordered(
        0, values.size(), 100, 0.0,
        [&](std::size_t first, std::size_t last) {
          double sum = 0;
          for (std::size_t i = first; i < last; ++i) {
            sum += values[i];
          }
          return sum;
        },
        [](double& total, double part) { total += part; });
  });
}

TEST(ParallelReduceOrdered, GivesTheSameBitsOnAnyNumberOfThreads) {
  Random random(7);
  std::vector<double> values(10'007);
  for (double& v : values) {
    v = random.uniform(-1, 1);
  }
  const double one = sum_on(1, values);
  EXPECT_EQ(one, sum_on(2, values));
  EXPECT_EQ(one, sum_on(4, values));
}

TEST(ParallelFor, VisitsEveryItemOnce) {
  std::vector<int> visits(1000, 0);
  parallel_for(10, 1000, 7, [&](std::size_t i) { ++visits[i]; });
  for (std::size_t i = 0; i < visits.size(); ++i) {
    EXPECT_EQ(visits[i], i >= 10 ? 1 : 0) << i;
  }
}

} // namespace
} // namespace cagewright
