// A smooth field over places: the logarithm of a stiffness, and a power of the depth.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "effects/effect.h"

namespace hapsim {

// G(x) = sum_i g_i k(|x - x_i|), and H(x) alike about its mean, with k = (1 - share) m(r/range) +
// share m(r/fine), and nugget more at the place itself (kSamePlace); m is Matern's correlation of
// order 5/2. The force is exp(G + H ln(d/depth)) times what it was, d the depth along the normal;
// the power ends at a tenth of that depth, where it would have no slope.
struct PlaceField {
  static constexpr double kFar = 1e6;  // [m], a length that is not set

  struct Kernel {
    double range = kFar, fine = kFar;  // [m]
    double share = 0, nugget = 0;
    double sd = 0;                   // of the field
    double at(double square) const;  // of a distance [m^2]
  };
  double depth = 1e-3;  // [m]
  Kernel factor, power;
  double mean_power = 0;
  std::vector<Vec3> place;   // [m]
  std::vector<double> g, h;  // weights, one a place

  PlaceField() = default;
  // In the order of values(): the effect's rows.
  explicit PlaceField(const Values& values);
  std::vector<double> values() const;
  // The columns of a place's weights among the effect's rows.
  static std::pair<int, int> columns(const Values& values, std::size_t place);

  // G and H. Allocates nothing.
  std::array<double, 2> at(const Vec3& p) const noexcept;
  // ln(d/depth), level at the surface, and its derivative by d [1/m].
  std::array<double, 2> log_depth(double d) const noexcept;
};

}  // namespace hapsim
