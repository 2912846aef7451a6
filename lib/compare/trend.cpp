#include "compare/trend.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace hapsim {
namespace {

void add_group(const std::vector<std::size_t>& rows, const std::vector<double>& x,
               const std::vector<double>& y, const std::vector<int>& press, Trend& trend) {
  const auto n = static_cast<double>(rows.size());
  double centre = 0, mean = 0;
  for (const std::size_t i : rows) centre += x[i] / n, mean += y[i] / n;
  std::map<int, double> sums;
  double square = 0;
  for (const std::size_t i : rows) {
    sums[press[i]] += y[i] - mean;
    square += (y[i] - mean) * (y[i] - mean);
  }
  const auto C = static_cast<double>(sums.size());
  double between = 0;
  for (const auto& [id, sum] : sums) between += sum * sum;
  trend.centre.push_back(centre);
  trend.mean.push_back(mean);
  trend.error.push_back(std::sqrt(C > 1 ? C / (C - 1) * between : square) / n);
}

}  // namespace

Trend binned_trend(const std::vector<double>& x, const std::vector<double>& y,
                   const std::vector<int>& press, int groups) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (std::isfinite(x[i]) && std::isfinite(y[i])) order.push_back(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return x[a] < x[b]; });
  Trend trend;
  const std::size_t wished =
      std::max<std::size_t>(1, order.size() / static_cast<std::size_t>(groups));
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = std::min(order.size(), begin + wished);
    while (end < order.size() && x[order[end]] == x[order[end - 1]])
      ++end;  // equal x stay together
    if (order.size() - end < wished / 2) end = order.size();
    add_group({order.begin() + static_cast<std::ptrdiff_t>(begin),
               order.begin() + static_cast<std::ptrdiff_t>(end)},
              x, y, press, trend);
    begin = end;
  }
  return trend;
}

std::vector<std::size_t> thinned(const std::vector<double>& y, std::size_t count) {
  std::vector<std::size_t> rows;
  if (y.size() <= count || count < 4) {
    rows.resize(y.size());
    std::iota(rows.begin(), rows.end(), std::size_t{0});
    return rows;
  }
  const std::size_t stretches = (count - 2) / 2;
  rows.push_back(0);
  for (std::size_t s = 0; s < stretches; ++s) {
    const auto begin = y.begin() + static_cast<std::ptrdiff_t>(y.size() * s / stretches);
    const auto end = y.begin() + static_cast<std::ptrdiff_t>(y.size() * (s + 1) / stretches);
    const auto [low, high] = std::minmax_element(begin, end);
    rows.push_back(static_cast<std::size_t>(low - y.begin()));
    rows.push_back(static_cast<std::size_t>(high - y.begin()));
  }
  rows.push_back(y.size() - 1);
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  return rows;
}

}  // namespace hapsim
