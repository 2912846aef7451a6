#include "calibrate/intervals.h"

#include "estimate/probability.h"

namespace hapsim {

double student_quantile(double confidence, double freedom) {
  double low = 0, high = 1;
  while (student_two_sided(high, freedom) > 1 - confidence && high < 1e6) high *= 2;
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (low + high);
    (student_two_sided(middle, freedom) > 1 - confidence ? low : high) = middle;
  }
  return high;
}

}  // namespace hapsim
