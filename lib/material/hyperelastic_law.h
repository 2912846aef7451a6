// Isotropic hyperelastic laws w = f(I1bar), U = K/2 (J - 1)^2, for finite strain.
#pragma once

#include "material/material_law.h"

namespace hapsim {

// I1bar = J^(-2/3) tr C (Flory, Trans. Faraday Soc. 57, 1961); the volume's energy is that of
// CalculiX (*HYPERELASTIC, with D1 = 2/K, D2 = D3 = infinite). Moduli [Pa]; Error(kBadInput) when
// the initial shear modulus 2 f'(0) or K is not positive.

// f = mu/2 (I1bar - 3): Rivlin, Phil. Trans. R. Soc. A 240, 1948. C10 = mu/2. Constants mu, K.
LawPointer neo_hookean_law(double mu, double bulk);

// f = sum of C_i0 (I1bar - 3)^i, i = 1..3: Yeoh, Rubber Chem. Technol. 66, 1993. Constants C10,
// C20, C30, K. C20 and C30 may be negative; then the body can lose its stability, which the solver
// reports.
LawPointer yeoh_law(double c10, double c20, double c30, double bulk);

// f = mu/(2 b) (exp(b (I1bar - 3)) - 1): Demiray, J. Biomech. 5, 1972 (after Fung). b >= 0 [1];
// b = 0 is neo-Hookean. Constants mu, b, K.
LawPointer exponential_law(double mu, double b, double bulk);

// Shear and bulk modulus of Young's modulus and Poisson's ratio (below 0.5) of the small-strain
// limit, and the derivatives of both by nu: mu = E/(2 (1 + nu)), K = E/(3 (1 - 2 nu)).
struct Moduli {
  double mu = 0, bulk = 0;
};
Moduli moduli(double youngs_modulus, double poisson_ratio);
Moduli moduli_by_poisson(double youngs_modulus, double poisson_ratio);

}  // namespace hapsim
