// Linear laws: stress proportional to strain, isotropic or transversely isotropic.
#pragma once

#include "material/material_law.h"

namespace hapsim {

// Which strain a linear law takes.
enum class StrainMeasure {
  kSmall,          // eps = sym grad u: the linear body; U(theta) = kappa/2 (theta - 1)^2
  kGreenLagrange,  // E = (F'F - 1)/2: Saint Venant-Kirchhoff, for large rotations and small strain
                   // (it loses its stability in strong compression); U = 0
};

// Constants E [Pa], nu. Error(kBadInput) unless E > 0 and -1 < nu < 0.5.
LawPointer isotropic_law(double youngs_modulus, double poisson_ratio,
                         StrainMeasure strain = StrainMeasure::kSmall);

// A material that is the same in all directions across `axis` (muscle, wood, 3D prints);
// Lekhnitskii, Theory of Elasticity of an Anisotropic Body, 1963.
struct TransverseConstants {
  double plane_modulus = 0;  // Ep: tension across the axis [Pa]
  double axial_modulus = 0;  // Ea: tension along the axis [Pa]
  double plane_poisson = 0;  // nup: contraction across the axis by tension across it
  double axial_poisson = 0;  // nua: contraction across the axis by tension along it
  double axial_shear = 0;    // Ga: shear between axis and plane [Pa]; in the plane Ep/(2(1 + nup))
};
// Empty when the strain energy is positive: Ep, Ea, Ga > 0, |nup| < 1, and
// 1 - nup - 2 nua^2 Ep/Ea > 0 (Lempriere, AIAA J. 6, 1968); else the condition that fails.
std::string instability(const TransverseConstants& constants);

// Constants Ep, Ea, nup, nua, Ga in this order; `axis` in the body's frame, any length.
// Error(kBadInput): unstable constants, no axis.
LawPointer transverse_law(const TransverseConstants& constants, const Vec3& axis,
                          StrainMeasure strain = StrainMeasure::kSmall);

}  // namespace hapsim
