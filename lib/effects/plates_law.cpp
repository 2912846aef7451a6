#include "effects/plates_law.h"

#include <algorithm>
#include <cmath>

namespace hapsim {
namespace {

constexpr double kMostStrain = 0.95;
constexpr double kMostExponent = 60;
constexpr double kStep = 1e-5;  // of differences, whose error is its square

// The bar at stretches l along and t across: half the derivatives of the energy, E = 1.
struct Bar {
  double along = 0, across = 0, across_by_t = 0;
};
Bar bar(double l, double t, double b, double nu) {
  const double mu = 0.5 / (1 + nu), bulk = 1 / (3 * (1 - 2 * nu));
  const double J = l * t * t, c = std::pow(J, -2.0 / 3);
  const double trace = l * l + 2 * t * t, I = c * trace - 3;
  const double slope = mu / 2 * std::exp(std::min(b * I, kMostExponent));  // dW/dI
  const double I_l = c * (2 * l - 2.0 / 3 * trace / l);
  const double I_t = c * (4 * t - 4.0 / 3 * trace / t);
  const double I_tt = c * (4 - 16.0 / 3 + 4.0 / 3 * trace / (t * t)) - 4.0 / 3 / t * I_t;
  const double J_t = 2 * l * t;
  return {slope * I_l + bulk * (J - 1) * t * t, slope * I_t + bulk * (J - 1) * J_t,
          slope * (b * I_t * I_t + I_tt) + bulk * (J_t * J_t + (J - 1) * 2 * l)};
}

double pressed(double e, double b, double nu) {
  const double l = 1 - std::min(e, kMostStrain);
  double t = std::pow(l, -nu);
  for (int k = 0; k < 60; ++k) {
    const Bar at = bar(l, t, b, nu);
    const double step = std::clamp(-at.across / at.across_by_t, -0.1 * t, 0.1 * t);
    t += step;
    if (std::abs(step) < 1e-14 * t) break;
  }
  return -bar(l, t, b, nu).along;
}

double small(double e, double b) {
  return e * std::exp(std::min(3 * b * e * e, kMostExponent));
}

}  // namespace

double PlatesLaw::stress(double e) const {
  return finite ? pressed(e, b, nu) : small(e, b);
}
double PlatesLaw::by_strain(double e) const {
  return (stress(e + kStep) - stress(e - kStep)) / (2 * kStep);
}
double PlatesLaw::by_b(double e) const {
  // One-sided at its bound.
  const double less = std::max(b - kStep, 0.0), more = b + kStep;
  return (PlatesLaw{more, nu, finite}.stress(e) - PlatesLaw{less, nu, finite}.stress(e)) /
         (more - less);
}
double PlatesLaw::by_nu(double e) const {
  return (PlatesLaw{b, nu + kStep, finite}.stress(e) - PlatesLaw{b, nu - kStep, finite}.stress(e)) /
         (2 * kStep);
}

}  // namespace hapsim
