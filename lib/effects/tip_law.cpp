#include "effects/tip_law.h"

#include <algorithm>
#include <cmath>

namespace hapsim::tip {

Growth growth(double z, double kappa, double a) {
  Growth g;
  if (z <= 0) return g;
  const double full = kappa * a * a;
  if (z >= full) {
    g.beta = 1;
    g.integral = z - full / 3;
    g.integral_by_kappa = -a * a / 3;
    return g;
  }
  g.beta = std::sqrt(z / full);
  g.by_z = g.beta / (2 * z);
  g.by_kappa = -g.beta / (2 * kappa);
  g.integral = 2 * z * g.beta / 3;
  g.integral_by_kappa = -g.integral / (2 * kappa);
  return g;
}

MeanGrowth mean_growth(double low, double high, double kappa, double a) {
  const double step = high - low;
  MeanGrowth mean;
  if (step <= 1e-7 * high) {  // the difference would cancel; the middle errs by the step squared
    const Growth middle = growth((low + high) / 2, kappa, a);
    mean.value = middle.beta;
    mean.by_low = mean.by_high = middle.by_z / 2;
    mean.by_kappa = middle.by_kappa;
    return mean;
  }
  const Growth l = growth(low, kappa, a), h = growth(high, kappa, a);
  mean.value = (h.integral - l.integral) / step;
  mean.by_high = (h.beta - mean.value) / step;
  mean.by_low = (mean.value - l.beta) / step;
  mean.by_kappa = (h.integral_by_kappa - l.integral_by_kappa) / step;
  return mean;
}

FirstTouch first_touch(const Vec3& n, const Vec3& before, const Vec3& u) {
  FirstTouch touch;
  touch.above = std::max(0.0, before.dot(n));
  touch.all = touch.above - u.dot(n);
  touch.share = touch.above / touch.all;
  const Vec3 place = before + touch.share * (u - before);
  touch.side = place - n * (n.transpose() * place);
  return touch;
}

}  // namespace hapsim::tip
