#include "linalg/metis_guard.h"

#include <dlfcn.h>
#include <signal.h>

#include <array>

namespace hapsim {
namespace {

std::mutex& one_at_a_time() {
  static std::mutex mutex;
  return mutex;
}

// A symbol of METIS, which CHOLMOD loads; a thread's own where it is thread-local.
template <class T>
T of_metis(const char* name) {
  return reinterpret_cast<T>(dlsym(RTLD_DEFAULT, name));
}

// How deep METIS's functions nest, and what is to be put back: it has room for 128 itself.
thread_local int depth = 0;
thread_local std::array<struct sigaction, 128> before;

}  // namespace

MetisGuard::MetisGuard() : lock_(one_at_a_time()) {}

}  // namespace hapsim

// METIS (5.1) calls these two where a public function of it begins and ends; the dynamic linker
// finds the program's, or those of the library of hapsim, before METIS's own. They keep what it
// needs: that SIGABRT, which it raises in this thread when memory is short, ends its function with
// an error code.
extern "C" [[gnu::visibility("default")]] int gk_sigtrap() {
  int* jump = hapsim::of_metis<int*>("gk_cur_jbufs");
  if (jump == nullptr || hapsim::depth + 1 > static_cast<int>(hapsim::before.size())) return 0;
  struct sigaction action = {};
  action.sa_handler = hapsim::of_metis<void (*)(int)>("gk_sigthrow");
  action.sa_flags = SA_NODEFER;  // the handler is left by a jump
  sigaction(SIGABRT, &action, &hapsim::before[static_cast<std::size_t>(hapsim::depth++)]);
  ++*jump;
  return 1;
}

extern "C" [[gnu::visibility("default")]] int gk_siguntrap() {
  if (hapsim::depth == 0) return 0;
  sigaction(SIGABRT, &hapsim::before[static_cast<std::size_t>(--hapsim::depth)], nullptr);
  --*hapsim::of_metis<int*>("gk_cur_jbufs");
  return 1;
}
