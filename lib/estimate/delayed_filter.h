// A Kalman filter whose observations may arrive late and in any order.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <vector>

namespace hapsim {

// N states, scalar observations: x_k+1 = A x_k + w, z = h.x + v, the covariance of w diagonal. An
// observation is put in at its own time: the filter goes back to the step before it
// and runs what it has seen since again, so the result is that of observations in time. The
// covariance update is Joseph's form P = (I - k h') P (I - k h')' + k r k' (Bucy and Joseph,
// Filtering for Stochastic Processes, 1968), which keeps P symmetric and positive where (4.32) does
// not. All memory is taken at the start; a late observation costs the steps since, some 50 ns each.
template <int N>
class DelayedFilter {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;

  // Remembers `steps` steps; older observations are refused.
  explicit DelayedFilter(std::size_t steps) : ring_(steps) {}

  // From here on, with nothing before it.
  void restart(double t, const Vector& x, const Matrix& P) noexcept {
    first_ = next_ = 0;
    Step& s = push();
    s = {};
    s.t = t;
    s.x = x;
    s.P = P;
  }

  // The next step: what happens to the states until t.
  void predict(double t, const Matrix& transition, const Vector& variance) noexcept {
    const Step& last = at(next_ - 1);
    Step& s = push();
    s.t = t;
    s.transition = transition;
    s.variance = variance;
    s.observed = false;
    run(last, s);
  }

  struct Innovation {
    bool taken = false;
    double value = 0, variance = 0;  // z - h.x and its variance, S
    double nis() const { return value * value / variance; }
  };
  // An observation z = h.x + v of variance r at time t, not after the last step; it belongs to the
  // first step at or after t that has none yet. Not taken when it is older than what is remembered.
  Innovation observe(double t, const Vector& h, double z, double r) noexcept {
    if (t < at(first_).t) return {};
    std::size_t k = next_;
    while (k > first_ && at(k - 1).t >= t) --k;
    while (k < next_ && at(k).observed) ++k;
    if (k == next_) return {};
    Step& s = at(k);
    Innovation result{true, z - h.dot(s.x), h.dot(s.P * h) + r};
    s.observed = true;
    s.h = h;
    s.z = z;
    s.r = r;
    put_in(s);
    for (++k; k < next_; ++k) run(at(k - 1), at(k));
    return result;
  }

  const Vector& x() const { return at(next_ - 1).x; }
  const Matrix& P() const { return at(next_ - 1).P; }
  double time() const { return at(next_ - 1).t; }

 private:
  struct Step {
    double t = 0;
    Matrix transition = Matrix::Identity();
    Vector variance = Vector::Zero();
    bool observed = false;
    Vector h = Vector::Zero();
    double z = 0, r = 1;
    Vector x = Vector::Zero();  // after the observation
    Matrix P = Matrix::Zero();
  };

  Step& at(std::size_t k) { return ring_[k % ring_.size()]; }
  const Step& at(std::size_t k) const { return ring_[k % ring_.size()]; }
  Step& push() noexcept {
    if (next_ - first_ == ring_.size()) ++first_;
    return at(next_++);
  }
  static void put_in(Step& s) noexcept {
    const Vector Ph = s.P * s.h;
    const double S = s.h.dot(Ph) + s.r;
    const Vector k = Ph / S;
    s.x += k * (s.z - s.h.dot(s.x));
    const Matrix A = Matrix::Identity() - k * s.h.transpose();
    s.P = A * s.P * A.transpose() + s.r * k * k.transpose();
  }
  static void run(const Step& last, Step& s) noexcept {
    s.x = s.transition * last.x;
    s.P = s.transition * last.P * s.transition.transpose();
    s.P.diagonal() += s.variance;
    if (s.observed) put_in(s);
  }

  std::vector<Step> ring_;
  std::size_t first_ = 0, next_ = 0;  // steps remembered: first_ <= k < next_
};

}  // namespace hapsim
