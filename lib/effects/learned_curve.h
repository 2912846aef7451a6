// A curve of no law: what a learned effect has instead of a formula.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace hapsim {

// The cubic spline through values at given knots that is a parabola in its first and last interval,
// straight before the knots and level beyond: linear in the values, whose weights at x it gives.
// Allocates nothing.
template <std::size_t N>
class LearnedCurve {
 public:
  using Weights = std::array<double, N>;

  // Ascending knots, four at least.
  constexpr explicit LearnedCurve(const Weights& knots) : x_(knots) {
    // The second derivatives M at the knots solve a tridiagonal system, linear in the values
    // (de Boor, A Practical Guide to Splines, IV): elimination for all unit values at once. In the
    // outer intervals M is constant.
    std::array<double, N> diagonal{};
    for (std::size_t i = 1; i + 1 < N; ++i) {
      const double a = x_[i] - x_[i - 1], b = x_[i + 1] - x_[i];
      diagonal[i] = 2 * (a + b) + (i == 1 ? a : 0) + (i + 2 == N ? b : 0);
      second_[i][i - 1] += 6 / a;
      second_[i][i] -= 6 / a + 6 / b;
      second_[i][i + 1] += 6 / b;
      if (i == 1) continue;
      const double q = a / diagonal[i - 1];
      diagonal[i] -= q * a;
      for (std::size_t k = 0; k < N; ++k) second_[i][k] -= q * second_[i - 1][k];
    }
    for (std::size_t i = N - 2; i > 0; --i)
      for (std::size_t k = 0; k < N; ++k)
        second_[i][k] =
            (second_[i][k] - (i + 2 == N ? 0 : (x_[i + 1] - x_[i]) * second_[i + 1][k])) /
            diagonal[i];
    second_.front() = second_[1];
    second_.back() = second_[N - 2];
  }

  // Value and slope at x are the sums of the values at the knots times these.
  void at(double x, Weights& value, Weights& slope) const noexcept {
    value.fill(0), slope.fill(0);
    if (x < x_.front()) {
      at(x_.front(), value, slope);
      for (std::size_t k = 0; k < N; ++k) value[k] += (x - x_.front()) * slope[k];
      return;
    }
    if (x >= x_.back()) {
      value.back() = 1;
      return;
    }
    std::size_t i = 0;
    while (x > x_[i + 1]) ++i;
    const double h = x_[i + 1] - x_[i], t = (x - x_[i]) / h, s = 1 - t;
    value[i] = s, value[i + 1] = t;
    slope[i] = -1 / h, slope[i + 1] = 1 / h;
    for (std::size_t k = 0; k < N; ++k) {
      value[k] +=
          h * h / 6 * ((s * s * s - s) * second_[i][k] + (t * t * t - t) * second_[i + 1][k]);
      slope[k] += h / 6 * ((1 - 3 * s * s) * second_[i][k] + (3 * t * t - 1) * second_[i + 1][k]);
    }
  }

  const Weights& knots() const { return x_; }

 private:
  Weights x_;
  std::array<Weights, N> second_{};  // of each knot, by the values
};

// By how much the curve through these values may err about x for want of knots: of fourth order, so
// that the curve through every second knot misses the one between by sixteen times that, at the
// ends by eight; in the last interval, where none is left out, twice as much is taken.
template <std::size_t N>
double for_want_of_knots(const LearnedCurve<N>& curve, const std::array<double, N>& y, double x) {
  constexpr std::size_t kFewer = N / 2 + 1;
  using Fewer = LearnedCurve<kFewer>;
  const auto place = [](std::size_t k) { return std::min(2 * k, N - 1); };
  typename Fewer::Weights knots{}, by{}, slopes{};
  for (std::size_t k = 0; k < kFewer; ++k) knots[k] = curve.knots()[place(k)];
  std::size_t about = 1;
  while (about + 3 < N && x > curve.knots()[about + 1]) about += 2;
  double most = 0;  // there and beside it, for what is missed may change its sign
  for (std::size_t between = about < 3 ? 1 : about - 2; between <= about + 2 && between + 1 < N;
       between += 2) {
    Fewer(knots).at(curve.knots()[between], by, slopes);
    double missed = y[between];
    for (std::size_t k = 0; k < kFewer; ++k) missed -= by[k] * y[place(k)];
    most = std::max(most, std::abs(missed));
  }
  return most / (x > curve.knots()[N - 2] ? 3.5 : 7);
}

}  // namespace hapsim
