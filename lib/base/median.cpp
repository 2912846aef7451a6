#include "base/median.h"

#include <algorithm>
#include <utility>

namespace hapsim {

double nth_smallest(std::vector<double> values, std::size_t rank) {
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::min(rank, values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto rank = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
  return nth_smallest(std::move(values), rank);
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return (*std::max_element(values.begin(), middle) + *middle) / 2;
}

double upper_median(std::vector<double> values) {
  const std::size_t half = values.size() / 2;
  return nth_smallest(std::move(values), half);
}

}  // namespace hapsim
