// Every task runs once; a failure reaches the caller.
#include "base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace hapsim {
namespace {

TEST(Parallel, EveryTaskRunsOnce) {
  for (const int threads : {0, 1, 3, 50}) {
    std::vector<std::atomic<int>> runs(100);
    in_parallel(runs.size(), threads, [&](std::size_t k) { ++runs[k]; });
    for (const std::atomic<int>& n : runs) EXPECT_EQ(n, 1);
  }
  in_parallel(0, 2, [](std::size_t) { FAIL(); });
}

TEST(Parallel, AFailureReachesTheCaller) {
  for (const int threads : {1, 2}) {
    std::atomic<int> runs{0};
    EXPECT_THROW(in_parallel(1000, threads,
                             [&](std::size_t k) {
                               ++runs;
                               if (k == 3) throw std::runtime_error("task 3");
                             }),
                 std::runtime_error);
    // How many others run meanwhile is the scheduler's affair.
    if (threads == 1) EXPECT_EQ(runs, 4);
  }
}

}  // namespace
}  // namespace hapsim
