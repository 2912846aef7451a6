#include "estimate/profile.h"

#include <cmath>

#include "estimate/coordinates.h"

namespace hapsim {
namespace {

class Profile {
 public:
  Profile(const std::vector<Unknown>& unknowns, const ResidualFunction& residuals,
          const LeastSquaresResult& at, std::size_t which, const LeastSquaresOptions& options)
      : unknowns_(unknowns), residuals_(residuals), at_(at), which_(which), options_(options) {}

  // Rise of the least sum of squares over the others with the unknown held at x.
  double rise(double x) {
    std::vector<Unknown> others;
    for (std::size_t i = 0; i < unknowns_.size(); ++i) {
      if (i == which_) continue;
      others.push_back(unknowns_[i]);
      others.back().value = last_.size() > 0 ? last_[static_cast<Eigen::Index>(i)]
                                             : at_.x[static_cast<Eigen::Index>(i)];
    }
    Eigen::VectorXd full = at_.x;
    const auto spread = [&](const Eigen::VectorXd& part) {
      for (std::size_t i = 0, k = 0; i < unknowns_.size(); ++i)
        full[static_cast<Eigen::Index>(i)] = i == which_ ? x : part[static_cast<Eigen::Index>(k++)];
    };
    const auto held = [&](const Eigen::VectorXd& part, Eigen::VectorXd& r, Eigen::MatrixXd* J) {
      spread(part);
      residuals_(full, r, J);
      if (J == nullptr) return;
      const Eigen::Index w = static_cast<Eigen::Index>(which_), rest = J->cols() - w - 1;
      J->middleCols(w, rest) = J->rightCols(rest).eval();
      J->conservativeResize(Eigen::NoChange, J->cols() - 1);
    };
    const LeastSquaresResult result = minimise(others, held, options_);
    failed = failed || !result.converged;
    spread(result.x);
    last_ = full;
    return result.sum_of_squares - at_.sum_of_squares;
  }
  void restart() { last_.resize(0); }
  bool failed = false;

 private:
  const std::vector<Unknown>& unknowns_;
  const ResidualFunction& residuals_;
  const LeastSquaresResult& at_;
  std::size_t which_;
  LeastSquaresOptions options_;
  Eigen::VectorXd last_;
};

}  // namespace

ProfileInterval profile_interval(const std::vector<Unknown>& unknowns,
                                 const ResidualFunction& residuals, const LeastSquaresResult& at,
                                 std::size_t which, double variance, double rise,
                                 const LeastSquaresOptions& options) {
  ProfileInterval result;
  const Coordinates coordinates(unknowns);
  const auto w = static_cast<Eigen::Index>(which);
  const double centre = coordinates.inner(which, at.x[w]);
  const double error =
      std::sqrt(std::max(0.0, at.covariance(w, w)) * variance) / coordinates.slope(which, at.x[w]);
  const double target = rise * variance;
  LeastSquaresOptions fine = options;
  fine.decrease_tolerance = std::min(options.decrease_tolerance, 1e-6);
  Profile profile(unknowns, residuals, at, which, fine);
  for (const int side : {-1, 1}) {
    profile.restart();
    const double bound = side < 0 ? coordinates.low(which) : coordinates.high(which);
    bool& open = side < 0 ? result.open_below : result.open_above;
    double& end = side < 0 ? result.lower : result.upper;
    const auto value = [&](double y) { return profile.rise(coordinates.outer(which, y)); };
    // Outwards until the rise is passed, in growing steps.
    double step = std::isfinite(error) && error > 0 ? std::sqrt(rise) * error : 0.1;
    double inner = centre, outer = centre, inner_rise = 0, outer_rise = 0;
    for (int k = 0; k < 30 && outer_rise < target; ++k, step *= 1.5) {
      inner = outer;
      inner_rise = outer_rise;
      outer = side < 0 ? std::max(bound, outer - step) : std::min(bound, outer + step);
      if (outer == inner) break;
      outer_rise = value(outer);
    }
    if (outer_rise < target) {
      open = true;
      end = side < 0 ? unknowns[which].lower : unknowns[which].upper;
      continue;
    }
    // The root of sqrt(rise), which is nearly straight: false position (Illinois).
    double fi = std::sqrt(std::max(0.0, inner_rise)) - std::sqrt(target);
    double fo = std::sqrt(outer_rise) - std::sqrt(target);
    double y = outer;
    for (int k = 0; k < 40 && std::abs(outer - inner) > 1e-6 * std::abs(outer - centre); ++k) {
      y = outer - fo * (outer - inner) / (fo - fi);
      const double f = std::sqrt(std::max(0.0, value(y))) - std::sqrt(target);
      if (std::abs(f) < 1e-5 * std::sqrt(target)) break;
      if ((f > 0) == (fo > 0)) {
        outer = y;
        fo = f;
        fi /= 2;
      } else {
        inner = y;
        fi = f;
        fo /= 2;
      }
    }
    end = coordinates.outer(which, y);
  }
  result.failed = profile.failed;
  return result;
}

}  // namespace hapsim
