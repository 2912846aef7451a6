// Seeded random numbers: the same seed gives the same numbers on every machine.
#pragma once

#include <cstdint>
#include <random>

namespace hapsim {

class Random {
 public:
  explicit Random(std::uint64_t seed = 1) : engine_(seed) {}
  double uniform();                        // in [0, 1)
  double normal();                         // mean 0, variance 1 (Box-Muller, so portable)
  std::uint64_t integer(std::uint64_t n);  // in [0, n)
  bool coin() { return (engine_() >> 63) != 0; }

 private:
  std::mt19937_64 engine_;
  double spare_ = 0;
  bool has_spare_ = false;
};

}  // namespace hapsim
