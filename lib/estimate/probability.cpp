#include "estimate/probability.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>

namespace hapsim {

double student_two_sided(double t, double freedom) {
  if (freedom > 1e6) return std::erfc(std::abs(t) / std::sqrt(2.0));
  return fisher_upper(t * t, 1, freedom);
}

double student_half95(double freedom) {
  return boost::math::quantile(boost::math::students_t(freedom), 0.975);
}

double fisher_upper(double f, double d1, double d2) {
  namespace policies = boost::math::policies;
  // NaN in, NaN out: what is not defined decides no test.
  using Quiet = policies::policy<policies::domain_error<policies::ignore_error>>;
  const double v = d1 * std::max(f, 0.0);
  // The same incomplete beta function from either end: the smaller argument keeps its digits.
  if (v < d2) return boost::math::ibetac(d1 / 2, d2 / 2, v / (d2 + v), Quiet());
  return boost::math::ibeta(d2 / 2, d1 / 2, d2 / (d2 + v), Quiet());
}

}  // namespace hapsim
