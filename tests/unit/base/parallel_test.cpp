// Every task runs once; a failure reaches the caller.
#include "base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
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
    if (threads == 1) {
      EXPECT_EQ(runs, 4);
    }
  }
}

// Calls within tasks take no more threads than the outermost was given, and those that are free.
TEST(Parallel, CallsWithinTasksShareTheThreads) {
  for (const int threads : {1, 3}) {
    std::atomic<int> now{0}, most{0}, runs{0};
    in_parallel(4, threads, [&](std::size_t) {
      in_parallel(8, 16, [&](std::size_t) {
        const int running = ++now;
        for (int seen = most; seen < running && !most.compare_exchange_weak(seen, running);) {
        }
        ++runs;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        --now;
      });
    });
    EXPECT_EQ(runs, 32);
    EXPECT_LE(most, threads);
    if (threads > 1) {
      EXPECT_GT(most, 1);
    }
  }
}

TEST(Parallel, ALoneTaskLeavesItsThreadsToWhatItCalls) {
  std::atomic<int> inside{0};
  in_parallel(1, 2, [&](std::size_t) {
    in_parallel(2, 2, [&](std::size_t) {
      ++inside;
      // Each waits for the other: they run side by side, or the test ends by its limit.
      while (inside < 2) std::this_thread::yield();
    });
  });
  EXPECT_EQ(inside, 2);
}

}  // namespace
}  // namespace hapsim
