// The same work on many things, by several threads.
#pragma once

#include <cstddef>
#include <functional>

namespace hapsim {

// Runs task(0) to task(count - 1), each once, in any order, on `threads` threads (0: as many as the
// machine has), this one among them. When tasks throw, the first exception is thrown again once all
// threads are done; tasks that had not begun are left out.
void in_parallel(std::size_t count, int threads, const std::function<void(std::size_t)>& task);

}  // namespace hapsim
