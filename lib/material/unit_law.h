// The linear law of a featured body for unit modulus, as matrices, with its derivatives.
#pragma once

#include <vector>

#include "material/body_features.h"
#include "material/material_law.h"

namespace hapsim {

// Stress = D strain + kappa tr(strain) 1; the second part is averaged over an element
// (dilatation.h). Derivatives by nu and by the four values of Feature::kTransverse where there is
// one.
struct UnitLaw {
  VoigtMatrix D = VoigtMatrix::Zero();
  double kappa = 0;
  std::vector<VoigtMatrix> D_by;
  std::vector<double> kappa_by;
};

// `transverse`: the values of that feature, empty for an isotropic body.
UnitLaw unit_law(double poisson_ratio, const std::vector<double>& transverse);

// The same transversely isotropic law for modulus E (small strain).
LawPointer transverse_body_law(double youngs_modulus, double poisson_ratio,
                               const std::vector<double>& transverse);

}  // namespace hapsim
