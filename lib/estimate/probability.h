// Tail probabilities of the distributions that tests refer to.
#pragma once

namespace hapsim {

// P(|T| > t) for Student's t with `freedom` degrees (any positive number; 1e9 is the normal law).
double student_two_sided(double t, double freedom);

// P(F > f) for Fisher's F with d1 and d2 degrees.
double fisher_upper(double f, double d1, double d2);

}  // namespace hapsim
