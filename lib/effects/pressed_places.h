// How deep each place was pressed before, as a step remembers it.
#pragma once

#include <algorithm>
#include <cstddef>

#include "effects/effect.h"

namespace hapsim {

// A view of so many numbers of a loop's memory, all 0 at the start. Beyond kMost places the oldest
// give way.
class PressedPlaces {
 public:
  static constexpr std::size_t kMost = 1024;
  static constexpr std::size_t kMemory = 2 + 4 * kMost;

  explicit PressedPlaces(double* memory)
      : known_(memory[0]), next_(memory[1]), places_(memory + 2) {}

  // The number of this place, in stead of the oldest one if it is new.
  double find(const Vec3& point) noexcept {
    for (std::size_t p = 0; p < static_cast<std::size_t>(known_); ++p)
      if ((Eigen::Map<const Vec3>(places_ + 4 * p) - point).norm() <= kSamePlace)
        return static_cast<double>(p);
    const double here = next_;
    Eigen::Map<Vec3>(places_ + 4 * static_cast<std::size_t>(here)) = point;
    deepest(here) = 0;
    known_ = std::max(known_, here + 1);
    next_ = here + 1 < static_cast<double>(kMost) ? here + 1 : 0;
    return here;
  }
  double& deepest(double place) noexcept {  // |u| there [m]
    return places_[4 * static_cast<std::size_t>(place) + 3];
  }

 private:
  double &known_, &next_;
  double* places_;
};

}  // namespace hapsim
