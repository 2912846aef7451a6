#include "base/blas.h"

#include <dlfcn.h>

#include <cstdlib>
#include <mutex>
#include <string_view>

namespace hapsim {
namespace {

// The BLAS is an alternative chosen by the system (libblas.so.3), so OpenBLAS's own functions are
// looked up at run time instead of linked. The symbols live in a library that libblas.so.3 pulls
// in.
template <typename Function>
Function find_symbol(const char* name) {
  void* symbol = dlsym(RTLD_DEFAULT, name);
  if (symbol == nullptr) {
    if (void* library = dlopen("libblas.so.3", RTLD_LAZY | RTLD_NOLOAD))
      symbol = dlsym(library, name);
  }
  return reinterpret_cast<Function>(symbol);
}

using Text = char* (*)();

// OpenBLAS's name of the fastest kernels that this processor can run; null when it may choose.
const char* widest_kernels() {
#ifdef __x86_64__
  const auto has_avx512 = [] {
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl") &&
           __builtin_cpu_supports("avx512cd");
  };
  if (has_avx512()) return "SkylakeX";
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return "Haswell";
#endif
  return nullptr;
}

// OpenBLAS goes by a table of processors. On one newer than the table it takes kernels of 2004
// (Prescott: a fifth of the speed, Emerald Rapids with 0.3.21) or leaves AVX-512 unused (Haswell).
// Only what is known to be slower is replaced, and nothing where the user has set
// OPENBLAS_CORETYPE.
bool choose_kernels() {
  static constexpr const char* kVariable = "OPENBLAS_CORETYPE";
  const auto core = find_symbol<Text>("openblas_get_corename");
  const auto forget = find_symbol<void (*)()>("gotoblas_dynamic_quit");
  const auto choose = find_symbol<void (*)()>("gotoblas_dynamic_init");
  const char* best = widest_kernels();
  if (!core || !forget || !choose || best == nullptr || std::getenv(kVariable) != nullptr)
    return false;
  const std::string_view now = core();
  const bool old = now == "Prescott" || now == "Core2" || now == "Nehalem" || now == "Sandybridge";
  if (now == best || !(old || now == "Haswell")) return false;
  setenv(kVariable, best, 1);
  forget();
  choose();
  unsetenv(kVariable);
  return true;
}

// When the program or the library is loaded: no thread may be inside OpenBLAS then.
[[maybe_unused]] const bool kKernelsChosen = choose_kernels();

}  // namespace

std::string blas_name() {
  if (auto config = find_symbol<Text>("openblas_get_config")) {
    std::string name = config();
    if (auto core = find_symbol<Text>("openblas_get_corename")) name += std::string(", ") + core();
    return name;
  }
  if (find_symbol<void (*)()>("dgemm_") == nullptr) return "none is loaded";
  return "reference BLAS or another: several times slower than OpenBLAS";
}

void prepare_blas_for_many_threads() {
  static std::once_flag once;
  std::call_once(once, [] {
    if (auto set = find_symbol<void (*)(int)>("openblas_set_num_threads")) set(1);
  });
  // OpenMP keeps this setting a thread, so it is set in every thread that comes here.
  static const auto levels = find_symbol<void (*)(int)>("omp_set_max_active_levels");
  if (levels != nullptr) levels(0);
}

BlasThreads::BlasThreads(int threads) : changed_(threads > 1) {
  prepare_blas_for_many_threads();
  if (!changed_) return;
  if (auto set = find_symbol<void (*)(int)>("openblas_set_num_threads")) set(threads);
}

BlasThreads::~BlasThreads() {
  if (!changed_) return;
  if (auto set = find_symbol<void (*)(int)>("openblas_set_num_threads")) set(1);
}

}  // namespace hapsim
