// Ogden's law in principal stretches, for finite strain.
#pragma once

#include <vector>

#include "material/material_law.h"

namespace hapsim {

struct OgdenTerm {
  double mu = 0;     // [Pa]
  double alpha = 2;  // [1]
};

// w = sum_p 2 mu_p/alpha_p^2 (l1^alpha_p + l2^alpha_p + l3^alpha_p - 3) in the isochoric stretches
// l = J^(-1/3) lambda, U = K/2 (J - 1)^2 (Ogden, Proc. R. Soc. Lond. A 326, 1972, and 328 for the
// compressible form; this scaling is CalculiX's *HYPERELASTIC, OGDEN with D1 = 2/K). The shear
// modulus at small strain is the sum of mu_p; one term of alpha = 2 is neo-Hookean. Constants mu1,
// alpha1, mu2, alpha2, ..., K. The tangent is that of the principal axes (Simo and Taylor, Comput.
// Methods Appl. Mech. Eng. 85, 1991). Error(kBadInput): no term, an exponent of zero, a shear or
// bulk modulus that is not positive. Terms with mu alpha < 0 may let the body lose its stability,
// which the solver reports.
LawPointer ogden_law(const std::vector<OgdenTerm>& terms, double bulk);

}  // namespace hapsim
