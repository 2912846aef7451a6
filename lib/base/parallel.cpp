#include "base/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace hapsim {
namespace {

// All that one outermost call has running. Calls within its tasks take threads that are free, and
// otherwise do their work by themselves: more threads than asked for would only be in each other's
// way, and hold as many tasks' memory.
struct Team {
  std::atomic<int> busy{1};
  int most = 1;

  // Up to `asked` more threads.
  int take(int asked) {
    int now = busy, taken = 0;
    do {
      taken = std::clamp(most - now, 0, asked);
    } while (!busy.compare_exchange_weak(now, now + taken));
    return taken;
  }
};

thread_local Team* team_of_thread = nullptr;

}  // namespace

void in_parallel(std::size_t count, int threads, const std::function<void(std::size_t)>& task) {
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::mutex failure_mutex;
  const auto work = [&] {
    for (std::size_t k = next++; k < count; k = next++) {
      try {
        task(k);
      } catch (...) {
        const std::lock_guard lock(failure_mutex);
        if (!failure) failure = std::current_exception();
        next = count;
      }
    }
  };
  const std::size_t wanted = threads > 0 ? static_cast<std::size_t>(threads)
                                         : std::max(1u, std::thread::hardware_concurrency());
  Team own;
  own.most = static_cast<int>(wanted);
  Team* const outer = team_of_thread;
  Team* const team = outer != nullptr ? outer : &own;
  const int more =
      team->take(static_cast<int>(std::min(wanted, std::max<std::size_t>(1, count))) - 1);
  // Tasks that run alone leave the threads to what they call.
  team_of_thread = team;
  std::vector<std::thread> pool;
  for (int i = 0; i < more; ++i)
    pool.emplace_back([&] {
      team_of_thread = team;
      work();
      --team->busy;
    });
  work();
  for (std::thread& thread : pool) thread.join();
  team_of_thread = outer;
  if (failure) std::rethrow_exception(failure);
}

}  // namespace hapsim
