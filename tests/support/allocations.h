// Counts what the calling thread takes from the heap. Included by one source of a program, whose
// operator new it is.
#pragma once

#include <cstdlib>
#include <new>

namespace hapsim::test {
// Of each thread its own: what runs beside a loop may take what it wants.
inline thread_local long allocations = 0;
}  // namespace hapsim::test

[[gnu::noinline]] void* operator new(std::size_t size) {
  ++hapsim::test::allocations;
  if (void* p = std::malloc(size)) return p;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t& /*unused*/) noexcept {
  ++hapsim::test::allocations;
  return std::malloc(size);
}
[[gnu::noinline]] void operator delete(void* p) noexcept {
  std::free(p);
}
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept {
  std::free(p);
}
