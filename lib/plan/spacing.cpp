#include "plan/spacing.h"

#include <algorithm>
#include <limits>

#include "base/median.h"

namespace hapsim {

double spacing_of(const std::vector<Vec3>& places) {
  std::vector<double> nearest;
  for (const Vec3& a : places) {
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3& b : places)
      if (&a != &b) least = std::min(least, (a - b).norm());
    nearest.push_back(least);
  }
  return upper_median(std::move(nearest));
}

}  // namespace hapsim
