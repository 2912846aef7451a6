#include "estimate/lag.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace hapsim {
namespace {

// Correlation of x[i] with y[i + shift] over the samples that both have.
double correlation(const std::vector<double>& x, const std::vector<double>& y, int shift) {
  const auto n = static_cast<long>(std::min(x.size(), y.size()));
  const long from = std::max(0L, -static_cast<long>(shift)), to = std::min(n, n - shift);
  double sx = 0, sy = 0, sxx = 0, syy = 0, sxy = 0;
  for (long i = from; i < to; ++i) {
    const double a = x[static_cast<std::size_t>(i)], b = y[static_cast<std::size_t>(i + shift)];
    sx += a;
    sy += b;
    sxx += a * a;
    syy += b * b;
    sxy += a * b;
  }
  const auto count = static_cast<double>(to - from);
  const double vx = sxx - sx * sx / count, vy = syy - sy * sy / count;
  return vx > 0 && vy > 0 ? (sxy - sx * sy / count) / std::sqrt(vx * vy) : 0;
}

}  // namespace

double lag_between(const std::vector<double>& x, const std::vector<double>& y, int most) {
  if (static_cast<int>(std::min(x.size(), y.size())) < 2 * most + 3)
    return std::numeric_limits<double>::quiet_NaN();
  std::vector<double> c;
  for (int shift = -most; shift <= most; ++shift) c.push_back(correlation(x, y, shift));
  const auto best = std::max_element(c.begin(), c.end());
  if (!(*best > 0)) return std::numeric_limits<double>::quiet_NaN();
  double lag = static_cast<double>(best - c.begin()) - most;
  if (best != c.begin() && best + 1 != c.end()) {
    const double bend = best[-1] - 2 * best[0] + best[1];
    if (bend < 0) lag += 0.5 * (best[-1] - best[1]) / bend;
  }
  return lag;
}

}  // namespace hapsim
