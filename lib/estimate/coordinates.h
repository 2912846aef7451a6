// The coordinates in which unknowns are stepped: private to lib/estimate.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "estimate/least_squares.h"

namespace hapsim {

// Internal coordinates y: x / scale, log x, or -log(limit - x).
class Coordinates {
 public:
  explicit Coordinates(const std::vector<Unknown>& unknowns) : u_(unknowns) {}
  double inner(std::size_t i, double x) const {
    if (has_limit(i)) return -std::log(u_[i].log_limit - x);
    return u_[i].logarithmic ? std::log(x) : x / u_[i].scale;
  }
  double outer(std::size_t i, double y) const {
    const double x = has_limit(i)        ? u_[i].log_limit - std::exp(-y)
                     : u_[i].logarithmic ? std::exp(y)
                                         : y * u_[i].scale;
    return std::clamp(x, u_[i].lower, u_[i].upper);
  }
  double slope(std::size_t i, double x) const {  // dx/dy
    if (has_limit(i)) return u_[i].log_limit - x;
    return u_[i].logarithmic ? x : u_[i].scale;
  }
  double bend(std::size_t i, double x) const {  // d2x/dy2
    if (has_limit(i)) return x - u_[i].log_limit;
    return u_[i].logarithmic ? x : 0;
  }
  bool is_log(std::size_t i) const { return u_[i].logarithmic || has_limit(i); }
  double low(std::size_t i) const { return u_[i].lower <= -1e299 ? -1e300 : inner(i, u_[i].lower); }
  double high(std::size_t i) const { return u_[i].upper >= 1e299 ? 1e300 : inner(i, u_[i].upper); }

 private:
  bool has_limit(std::size_t i) const { return !std::isnan(u_[i].log_limit); }
  const std::vector<Unknown>& u_;
};

}  // namespace hapsim
