#include "linalg/blas.h"

#include <dlfcn.h>

#include <mutex>

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

}  // namespace

std::string blas_name() {
  using Text = char* (*)();
  if (auto config = find_symbol<Text>("openblas_get_config")) {
    std::string name = config();
    if (auto core = find_symbol<Text>("openblas_get_corename")) name += std::string(", ") + core();
    return name;
  }
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
