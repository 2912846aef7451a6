// How often a hand's force was not what was asked for.
#pragma once

#include <array>
#include <string>

#include "safety/safe_force.h"

namespace hapsim {

struct SafetyCounts {
  long samples = 0;
  std::array<long, 9> flagged{};  // by bit of Safety

  void add(const SafeSample& sample) noexcept;
  // "force cut in 3, rate in 12, held in 40 of 1500 samples"; "" where every force was as asked.
  std::string summary() const;
};

}  // namespace hapsim
