#include "solid/relaxation_spectrum.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "base/error.h"

namespace hapsim {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
using Interval = std::pair<double, double>;  // of times [s]

// s theta / (1 + s theta).
double share(double s, double theta) {
  return std::isinf(s) ? 1 : s * theta / (1 + s * theta);
}

// From each relaxation time to its retardation time: E(-x) falls from its value at one pole to the
// next pole's minus infinity, and is zero once between them.
void add_intervals(const RegionRelaxation& region, std::vector<Interval>& intervals) {
  std::vector<MaxwellModulus> terms = region.terms;
  std::sort(terms.begin(), terms.end(), [](const auto& a, const auto& b) { return a.tau > b.tau; });
  double low = 0;
  for (const MaxwellModulus& term : terms) {
    const double pole = 1 / term.tau;
    double a = low, b = pole;
    for (int i = 0; i < 200 && a < 0.5 * (a + b) && 0.5 * (a + b) < b; ++i) {
      const double x = 0.5 * (a + b);
      double modulus = region.modulus;
      for (const MaxwellModulus& t : terms) modulus -= t.modulus * x * t.tau / (1 - x * t.tau);
      (modulus > 0 ? a : b) = x;
    }
    intervals.emplace_back(term.tau, 1 / (0.5 * (a + b)));
    low = pole;
  }
}

std::vector<Interval> merged(std::vector<Interval> intervals) {
  std::sort(intervals.begin(), intervals.end());
  std::vector<Interval> result;
  for (const Interval& i : intervals) {
    constexpr double kTouching = 1.02;  // times 2 % apart are one to any recording
    if (!result.empty() && i.first <= kTouching * result.back().second)
      result.back().second = std::max(result.back().second, i.second);
    else
      result.push_back(i);
  }
  return result;
}

}  // namespace

double RegionRelaxation::at(double s) const {
  double e = modulus;
  for (const MaxwellModulus& t : terms) e += t.modulus * share(s, t.tau);
  return e;
}

RelaxationSpectrum::RelaxationSpectrum(const std::vector<RegionRelaxation>& regions,
                                       std::size_t most) {
  std::vector<Interval> intervals;
  for (const RegionRelaxation& region : regions) add_intervals(region, intervals);
  assert(!intervals.empty());
  for (const auto& [low, high] : merged(intervals)) {
    const double decades = std::log10(high / low);
    const int n = static_cast<int>(std::ceil(4 + 8 * decades));
    for (int k = n - 1; k >= 0; --k) {
      const double x = std::cos(std::numbers::pi * (2 * k + 1) / (2 * n));
      times_.push_back(std::sqrt(low * high) * std::pow(high / low, 0.5 * x));
    }
  }
  if (times_.size() > most)
    fail_input("",
               "the regions' relaxation times spread over too many decades (" +
                   std::to_string(times_.size()) + " Maxwell elements, " + std::to_string(most) +
                   " at most)",
               "give the regions fewer relaxation times, or common ones");

  const std::size_t between = 2 * times_.size() + 4;
  const double slow = 0.05 / times_.back(), fast = 20 / times_.front();
  samples_.push_back(0);
  for (std::size_t k = 0; k < between; ++k)
    samples_.push_back(
        slow * std::pow(fast / slow, static_cast<double>(k) / static_cast<double>(between - 1)));
  samples_.push_back(kInfinity);
  const auto rows = static_cast<Eigen::Index>(samples_.size());
  const auto columns = static_cast<Eigen::Index>(times_.size());
  terms_.resize(rows, columns);
  for (Eigen::Index i = 0; i < rows; ++i) {
    moduli_.emplace_back();
    for (const RegionRelaxation& region : regions)
      moduli_.back().push_back(region.at(samples_[static_cast<std::size_t>(i)]));
    for (Eigen::Index j = 0; j < columns; ++j)
      terms_(i, j) =
          share(samples_[static_cast<std::size_t>(i)], times_[static_cast<std::size_t>(j)]);
  }
  // Least squares for K(s) - K(0), the stiffness at once all but exact.
  weight_ = Eigen::VectorXd::Ones(rows);
  weight_[rows - 1] = 100;
  weighted_.compute(weight_.asDiagonal() * terms_, Eigen::ComputeThinU | Eigen::ComputeThinV);
  weighted_.setThreshold(1e-13);
}

// The matrix is nearly singular, as all fits of exponentials are. Solved, not multiplied by an
// inverse: then the parts err together, and what they sum to does not.
Eigen::MatrixXd RelaxationSpectrum::parts(const Eigen::MatrixXd& values) const {
  return weighted_.solve(weight_.asDiagonal() * (values.rowwise() - values.row(0)));
}

double RelaxationSpectrum::misfit(const Eigen::VectorXd& values,
                                  const Eigen::VectorXd& parts) const {
  const Eigen::VectorXd fitted = (terms_ * parts).array() + values[0] - values.array();
  return fitted.cwiseAbs().maxCoeff() / std::abs(values[values.size() - 1]);
}

}  // namespace hapsim
