// Tail probabilities of the distributions that tests refer to.
#pragma once

namespace hapsim {

// P(|T| > t) for Student's t with `freedom` degrees (any positive number; 1e9 is the normal law).
double student_two_sided(double t, double freedom);

// Half of the interval that holds 95 % of Student's t: 2.2 of 11 degrees, 1.96 of many.
double student_half95(double freedom);

// P(F > f) for Fisher's F with d1 and d2 degrees.
double fisher_upper(double f, double d1, double d2);

}  // namespace hapsim
