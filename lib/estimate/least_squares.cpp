#include "estimate/least_squares.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "estimate/coordinates.h"

namespace hapsim {
namespace {

// J = Q R: the small triangle R and the head of Q' r are all that a step needs of n residuals.
struct Triangular {
  Eigen::MatrixXd R;
  Eigen::VectorXd Qr;
};

Triangular triangular(const Eigen::MatrixXd& J, const Eigen::VectorXd& r) {
  const Eigen::Index k = J.cols();
  Eigen::MatrixXd padded = J;
  Eigen::VectorXd padded_r = r;
  if (J.rows() < k) {  // fewer residuals than unknowns: rows of zeros change nothing
    padded = Eigen::MatrixXd::Zero(k, k);
    padded.topRows(J.rows()) = J;
    padded_r = Eigen::VectorXd::Zero(k);
    padded_r.head(r.size()) = r;
  }
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(padded);
  Triangular result;
  result.R = qr.matrixQR().topRows(k).triangularView<Eigen::Upper>();
  result.Qr = (qr.householderQ().transpose() * padded_r).head(k);
  return result;
}

}  // namespace

LeastSquaresResult minimise(const std::vector<Unknown>& start, const ResidualFunction& residuals,
                            const LeastSquaresOptions& options) {
  const std::size_t m = start.size();
  const Coordinates coordinates(start);
  LeastSquaresResult result;
  result.x.resize(m);
  result.at_bound.assign(m, false);
  result.undetermined.assign(m, false);
  for (std::size_t i = 0; i < m; ++i)
    result.x[i] = std::clamp(start[i].value, start[i].lower, start[i].upper);
  Eigen::VectorXd r, trial_r;
  Eigen::MatrixXd J;
  residuals(result.x, r, m > 0 ? &J : nullptr);
  result.sum_of_squares = r.squaredNorm();
  if (m == 0 || !std::isfinite(result.sum_of_squares)) {
    result.converged = m == 0;
    result.message = m == 0 ? "nothing is free" : "the start gives no finite forces";
    result.covariance.resize(m, m);
    return result;
  }
  const double count = std::max<double>(1, static_cast<double>(r.size()) - static_cast<double>(m));
  double damping = 1e-6;
  const auto to_inner = [&](Eigen::MatrixXd& jacobian) {
    for (std::size_t i = 0; i < m; ++i) jacobian.col(i) *= coordinates.slope(i, result.x[i]);
  };
  to_inner(J);
  while (result.iterations < options.max_iterations) {
    ++result.iterations;
    const Eigen::VectorXd gradient = J.transpose() * r;
    std::vector<int> open;
    for (std::size_t i = 0; i < m; ++i) {
      const double y = coordinates.inner(i, result.x[i]);
      const bool low = y <= coordinates.low(i) + 1e-12 && gradient[i] > 0;
      const bool high = y >= coordinates.high(i) - 1e-12 && gradient[i] < 0;
      result.at_bound[i] = low || high;
      // What changes nothing here (friction where nothing slips) has no direction to be moved in.
      const bool idle = J.col(i).norm() <= 1e-12 * r.norm();
      if (!result.at_bound[i] && !idle) open.push_back(static_cast<int>(i));
    }
    if (open.empty()) {
      result.converged = true;
      result.message = "every free parameter is at a bound or changes nothing";
      break;
    }
    const Eigen::Index k = static_cast<Eigen::Index>(open.size());
    const Triangular qr = triangular(J(Eigen::all, open), r);
    const Eigen::VectorXd norms = qr.R.colwise().norm().transpose();
    bool accepted = false;
    double largest_step = 0, decrease = 0;
    for (int attempt = 0; attempt < 12 && !accepted; ++attempt) {
      // Marquardt's damping as extra rows sqrt(damping) D under R; pivoting bears rank loss.
      Eigen::MatrixXd stacked = Eigen::MatrixXd::Zero(2 * k, k);
      stacked.topRows(k) = qr.R;
      for (Eigen::Index i = 0; i < k; ++i)
        stacked(k + i, i) =
            std::sqrt(damping * norms[i] * norms[i] + 1e-12 * norms.squaredNorm() / k);
      Eigen::VectorXd target = Eigen::VectorXd::Zero(2 * k);
      target.head(k) = -qr.Qr;
      const Eigen::VectorXd step = stacked.colPivHouseholderQr().solve(target);
      // The step within the bounds, and no further than a factor e^2 or twenty typical changes: the
      // model is linear only so far.
      Eigen::VectorXd move(k);
      for (Eigen::Index i = 0; i < k; ++i) {
        const int p = open[i];
        const double y = coordinates.inner(p, result.x[p]);
        const double cap = coordinates.is_log(p) ? 2.0 : 20.0;
        move[i] = std::clamp(y + std::clamp(step[i], -cap, cap), coordinates.low(p),
                             coordinates.high(p)) -
                  y;
      }
      const auto at = [&](double share) {
        Eigen::VectorXd x = result.x;
        for (Eigen::Index i = 0; i < k; ++i)
          x[open[i]] = coordinates.outer(
              open[i], coordinates.inner(open[i], result.x[open[i]]) + share * move[i]);
        return x;
      };
      Eigen::VectorXd x = at(1);
      residuals(x, trial_r, nullptr);
      double trial = trial_r.squaredNorm();
      largest_step = move.cwiseAbs().maxCoeff();
      // Large residuals bend the valley and a full step overshoots it: the parabola through the
      // value and slope here and the value there tells where the floor is.
      const double slope = 2 * gradient(open).dot(move);
      const double bend = trial - result.sum_of_squares - slope;
      const double share = bend > 0 ? -slope / (2 * bend) : 1;
      if (std::isfinite(trial) && share > 0.02 && share < 0.8) {
        const Eigen::VectorXd shorter = at(share);
        residuals(shorter, trial_r, nullptr);
        if (trial_r.squaredNorm() < trial) {
          x = shorter;
          trial = trial_r.squaredNorm();
          largest_step *= share;
        }
      }
      if (std::isfinite(trial) && trial <= result.sum_of_squares * (1 + 1e-14)) {
        decrease = result.sum_of_squares - trial;
        result.x = x;
        result.sum_of_squares = trial;
        accepted = true;
        damping = std::max(1e-12, damping * 0.1);
      } else {
        damping = std::max(1e-8, damping * 10);
      }
      if (largest_step < options.step_tolerance) break;
    }
    if (accepted) {
      residuals(result.x, r, &J);
      to_inner(J);
    }
    if (largest_step < options.step_tolerance ||
        decrease <= options.decrease_tolerance * result.sum_of_squares / count) {
      // A refused tiny step is the floor of rounding; a refused large one is a failure.
      result.converged = accepted || largest_step < 1e3 * options.step_tolerance;
      result.message = result.converged ? "converged" : "no step decreases the error";
      break;
    }
    if (options.watch && !options.watch(result.sum_of_squares)) {
      result.stopped = true;
      result.message = "interrupted";
      break;
    }
  }
  if (result.message.empty()) result.message = "too many iterations";

  std::vector<int> open;
  for (std::size_t i = 0; i < m; ++i)
    if (!result.at_bound[i]) open.push_back(static_cast<int>(i));
  result.covariance = Eigen::MatrixXd::Zero(m, m);
  if (open.empty()) return result;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(triangular(J(Eigen::all, open), r).R,
                                              Eigen::ComputeFullV);
  const Eigen::VectorXd& s = svd.singularValues();
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(s.size(), s.size());
  for (Eigen::Index d = 0; d < s.size(); ++d) {
    const auto v = svd.matrixV().col(d);
    if (s[d] > 1e-7 * s[0]) {
      inverse += v * v.transpose() / (s[d] * s[d]);
    } else {
      for (Eigen::Index i = 0; i < v.size(); ++i)
        if (std::abs(v[i]) > 0.3) result.undetermined[open[i]] = true;
    }
  }
  for (std::size_t i = 0; i < open.size(); ++i)
    for (std::size_t j = 0; j < open.size(); ++j)
      result.covariance(open[i], open[j]) = inverse(i, j) *
                                            coordinates.slope(open[i], result.x[open[i]]) *
                                            coordinates.slope(open[j], result.x[open[j]]);
  return result;
}

}  // namespace hapsim
