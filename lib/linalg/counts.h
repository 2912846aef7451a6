// How often matrices were analysed and factorised: what is to be had without must show it.
#pragma once

#include <atomic>

namespace hapsim {

// Of this process, all threads together.
struct SolverCounts {
  std::atomic<long> analyses{0};        // symbolic ones of a sparsity
  std::atomic<long> factorisations{0};  // numerical ones, complete or incomplete
};
inline SolverCounts solver_counts;

}  // namespace hapsim
