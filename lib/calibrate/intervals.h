// The half width of an interval, in standard errors.
#pragma once

namespace hapsim {

// t with P(|T| <= t) = confidence for Student's t with `freedom` degrees.
double student_quantile(double confidence, double freedom);

}  // namespace hapsim
