// Which BLAS runs under the factorisation, which of its kernels, and its threads. Where OpenBLAS
// does not know the processor, kernels as wide as the processor are chosen when this is loaded; the
// environment's OPENBLAS_CORETYPE goes before that.
#pragma once

#include <string>

namespace hapsim {

// "OpenBLAS 0.3.21 ... SkylakeX", "reference BLAS or another: several times slower than OpenBLAS",
// or "none is loaded".
std::string blas_name();

// hapsim runs contact positions side by side, so each factorisation takes one thread: OpenBLAS is
// set to one thread, and CHOLMOD's own OpenMP regions are switched off (they cost more than they
// give on matrices of this size). Cheap; safe to call often and from any thread.
void prepare_blas_for_many_threads();

// OpenBLAS takes `threads` while this lives, and one thread again after: for one large dense
// product or inverse at a time, while no other thread factorises. 1 changes nothing. Its threads
// wait by spinning: where others use the cores too, one is many times faster.
class BlasThreads {
 public:
  explicit BlasThreads(int threads);
  ~BlasThreads();
  BlasThreads(const BlasThreads&) = delete;
  BlasThreads& operator=(const BlasThreads&) = delete;

 private:
  bool changed_;
};

}  // namespace hapsim
