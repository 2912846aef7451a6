#include "estimate/multi_start.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "estimate/coordinates.h"

namespace hapsim {
namespace {

// Where there is no bound: so many scales, or factors for what is sought by its logarithm.
constexpr double kReach = 10;
constexpr double kFactor = 100;

// The range of an unknown in internal coordinates.
std::pair<double, double> range(const Coordinates& c, const Unknown& u, std::size_t i) {
  const double reach = c.is_log(i) ? std::log(kFactor) : kReach;
  const double at = c.inner(i, u.value);
  const double low = c.low(i), high = c.high(i);
  return {low <= -1e299 ? at - reach : low, high >= 1e299 ? at + reach : high};
}

}  // namespace

std::vector<std::vector<Unknown>> latin_hypercube_starts(const std::vector<Unknown>& unknowns,
                                                         int count, Random& random) {
  std::vector<std::vector<Unknown>> starts(std::max(1, count), unknowns);
  const Coordinates coordinates(unknowns);
  const std::size_t cells = starts.size() - 1;
  std::vector<std::size_t> order(cells);
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    std::iota(order.begin(), order.end(), 0);
    for (std::size_t k = cells; k > 1; --k) std::swap(order[k - 1], order[random.integer(k)]);
    const auto [low, high] = range(coordinates, unknowns[i], i);
    for (std::size_t k = 0; k < cells; ++k) {
      const double share =
          (static_cast<double>(order[k]) + random.uniform()) / static_cast<double>(cells);
      starts[k + 1][i].value = coordinates.outer(i, low + share * (high - low));
    }
  }
  return starts;
}

MultiStartResult minimise_from_many(const std::vector<std::vector<Unknown>>& starts,
                                    const ResidualFunction& residuals,
                                    const LeastSquaresOptions& options, double same,
                                    const StartWatch& before_start) {
  MultiStartResult result;
  std::vector<double> minima;
  Eigen::Index count = 1;
  const ResidualFunction counted = [&](const Eigen::VectorXd& x, Eigen::VectorXd& r,
                                       Eigen::MatrixXd* J) {
    residuals(x, r, J);
    count = std::max<Eigen::Index>(1, r.size());
  };
  bool first = true, stopped = false;
  for (const std::vector<Unknown>& start : starts) {
    if (first) result.best.sum_of_squares = std::numeric_limits<double>::infinity();
    if (before_start && !before_start(result.starts, result.best) && !first) stopped = true;
    if (stopped) break;
    LeastSquaresResult found = minimise(start, counted, options);
    stopped = found.stopped;
    if (!stopped) ++result.starts;
    if (found.converged) {
      ++result.converged;
      minima.push_back(found.sum_of_squares);
    }
    const bool better =
        first || (found.converged && !result.best.converged) ||
        (found.converged == result.best.converged && std::isfinite(found.sum_of_squares) &&
         !(found.sum_of_squares >= result.best.sum_of_squares));
    if (better) result.best = std::move(found);
    first = false;
  }
  if (stopped) {
    result.best.stopped = true;
    result.best.message = "interrupted";
  }
  std::sort(minima.begin(), minima.end());
  const double tolerance =
      minima.empty() ? 0 : minima.front() * std::max(1e-6, same / static_cast<double>(count));
  for (std::size_t m = 0; m < minima.size(); ++m) {
    result.agreeing += minima[m] <= minima.front() + tolerance;
    result.valleys += m == 0 || minima[m] > minima[m - 1] + tolerance;
  }
  return result;
}

}  // namespace hapsim
