// A library to preload: operator new gives blocks in an order of addresses that the seed
// HAPSIM_SCATTER decides, filled with what it decides too. What a program computes must not change.
#include <pthread.h>

#include <array>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <new>
#include <random>

namespace {

constexpr std::size_t kBlocks = 32;          // of a size, of which one is drawn
constexpr std::size_t kLargest = 1u << 20u;  // larger ones come as malloc gives them
constexpr std::size_t kSmallest = 16;

struct Pool {
  std::array<void*, kBlocks> block;
  std::size_t count = 0;
};

std::mutex mutex;
std::array<Pool, 21> pools;  // of the powers of two

std::mt19937& random_numbers() {
  static std::mt19937 numbers([] {
    const char* seed = std::getenv("HAPSIM_SCATTER");
    return seed == nullptr ? 1u : static_cast<unsigned>(std::atoi(seed));
  }());
  return numbers;
}

// A child must not be born with the lock held by a thread that it does not have.
const int forks =
    pthread_atfork([] { mutex.lock(); }, [] { mutex.unlock(); }, [] { mutex.unlock(); });

void* scattered(std::size_t size) {
  if (size > kLargest) return std::malloc(size);
  const std::size_t whole = std::bit_ceil(size < kSmallest ? kSmallest : size);
  const std::lock_guard<std::mutex> lock(mutex);
  Pool& pool = pools[std::bit_width(whole) - 1];
  if (pool.count < kBlocks / 2) {
    for (; pool.count < kBlocks; ++pool.count) {
      if ((pool.block[pool.count] = std::malloc(whole)) == nullptr) break;
    }
  }
  if (pool.count == 0) return nullptr;
  const std::size_t drawn = random_numbers()() % pool.count;
  void* block = pool.block[drawn];
  pool.block[drawn] = pool.block[--pool.count];
  return std::memset(block, static_cast<int>(random_numbers()() % 256), whole);
}

}  // namespace

void* operator new(std::size_t size) {
  if (void* block = scattered(size)) return block;
  throw std::bad_alloc();
}
void* operator new[](std::size_t size) {
  return operator new(size);
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return scattered(size);
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
  return scattered(size);
}
void operator delete(void* block) noexcept {
  std::free(block);
}
void operator delete[](void* block) noexcept {
  std::free(block);
}
void operator delete(void* block, std::size_t) noexcept {
  std::free(block);
}
void operator delete[](void* block, std::size_t) noexcept {
  std::free(block);
}
