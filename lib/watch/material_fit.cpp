#include "watch/material_fit.h"

#include <Eigen/LU>
#include <cmath>

namespace hapsim {
namespace {

constexpr double kNothing = 0.05;  // a body that has lost all but this is gone
constexpr int kTimes = 5;          // grid points of the relaxation times' factor to each side
constexpr double kTimeStep = 0.5;  // between them, of its logarithm
constexpr int kSections = 10;      // golden ones: 0.618^10 of the step is below 1 %

// Stiffness and relaxation by their forces, which are straight in both, at the factor of the times
// in `c`. The sum of squares; 1e300 where that is no material.
double fit_moduli(const PreparedBody& body, const SurfaceOffsets& offsets,
                  const std::vector<WatchedSample>& window, Correction& c) {
  Correction unit = c;
  unit.stiffness = unit.relaxation = 1;
  const std::vector<Vec3> whole = corrected_forces(body, offsets, window, unit);
  unit.relaxation = 0;
  const std::vector<Vec3> elastic = corrected_forces(body, offsets, window, unit);
  Eigen::Matrix2d A = Eigen::Matrix2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  double squares = 0;
  for (std::size_t i = 0; i < window.size(); ++i) {
    if (!window[i].counted) continue;
    const double weight = 1 / (window[i].size * window[i].size);
    Eigen::Matrix<double, 3, 2> f;
    f << elastic[i] - c.bias, whole[i] - elastic[i];
    const Vec3 measured = window[i].measured - c.bias;
    A += weight * f.transpose() * f;
    b += weight * f.transpose() * measured;
    squares += weight * measured.squaredNorm();
  }
  if (A.determinant() <= 1e-9 * A(0, 0) * A(1, 1)) return 1e300;
  const Eigen::Vector2d x = A.inverse() * b;
  if (x[0] <= kNothing || x[1] < 0) return 1e300;
  c.stiffness = x[0];
  c.relaxation = x[1] / x[0];
  return squares - b.dot(x);
}

}  // namespace

bool fit_stiffness(const PreparedBody& body, const SurfaceOffsets& offsets,
                   const std::vector<WatchedSample>& window, Correction& c) {
  const std::vector<Vec3> forces = corrected_forces(body, offsets, window, c);
  double fm = 0, ff = 0;
  for (std::size_t i = 0; i < window.size(); ++i) {
    if (!window[i].counted) continue;
    const Vec3 own = forces[i] - c.bias;
    const double weight = 1 / (window[i].size * window[i].size);
    fm += weight * own.dot(window[i].measured - c.bias);
    ff += weight * own.squaredNorm();
  }
  if (ff <= 0 || fm <= kNothing * ff) return false;
  c.stiffness *= fm / ff;
  return true;
}

bool fit_relaxation(const PreparedBody& body, const SurfaceOffsets& offsets,
                    const std::vector<WatchedSample>& window, Correction& c) {
  const Correction from = c;
  const auto at = [&](double log_time, Correction& found) {
    found = from;
    found.slowness *= std::exp(log_time);
    return fit_moduli(body, offsets, window, found);
  };
  double best = 0, least = 1e300;
  for (int i = -kTimes; i <= kTimes; ++i) {
    const double x = kTimeStep * i, squares = at(x, c);
    if (squares < least) least = squares, best = x;
  }
  if (least >= 1e300 || std::abs(best) > kTimeStep * (kTimes - 0.5)) return false;
  double low = best - kTimeStep, high = best + kTimeStep;
  Correction unused;
  for (int i = 0; i < kSections; ++i) {
    const double part = 0.381966 * (high - low);
    if (at(low + part, unused) < at(high - part, unused))
      high -= part;
    else
      low += part;
  }
  return at(0.5 * (low + high), c) < 1e300;
}

}  // namespace hapsim
