// How a half-space resists a bonded disc that is turned.
#pragma once

#include <Eigen/Core>

#include "contact/rigid_stiffness.h"

namespace hapsim {

// K (u, theta) of rigid_stiffness() for a disc of `radius` [m] bonded to a half-space with this
// outward normal (unit); of its translations the stiffness is `translation` [N/m].
Matrix6 disc_stiffness(const Eigen::Matrix3d& translation, double modulus, double nu, double radius,
                       const Vec3& normal) noexcept;

// Per G a^3 and, of `sway`, per G a^2. Torsion is 16 G a^3 / 3 (Reissner and Sagoci, J. Appl. Phys.
// 15, 1944), exact. Rocking is that of a disc without friction, 8 G a^3 / (3 (1 - nu)) (Johnson,
// Contact Mechanics, 3.3), exact for nu = 1/2, times what bonding adds: log(3 - 4 nu) (1 - nu) / (1
// - 2 nu) as on the way down, and 1 + 4 e^2, e = log(3 - 4 nu) / (2 pi), as for a strip; sway is e
// a times the stiffness along the surface. Both were laid beside elements of second order, not
// derived: rocking within 2.5 %, sway within 1 % of that stiffness times the radius
// (rocking_test.cpp).
struct DiscRotation {
  double rocking = 0;  // about an axis in the surface
  double torsion = 0;  // about the normal
  double sway = 0;     // moment about n x e of a disc moved along e
};
DiscRotation bonded_disc_rotation(double nu) noexcept;

}  // namespace hapsim
