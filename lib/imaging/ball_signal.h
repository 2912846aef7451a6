// What a ball does to the gains of all presses, to first order: its share of their energy.
#pragma once

#include <Eigen/Core>

#include "contact/field_stiffness.h"

namespace hapsim {

// What a ball of ratio q adds to the stiffness, over what its volume would at small contrast:
// (q - 1) / (1 + 0.4 (q - 1)), for inside a stiff ball the strain falls (Eshelby, Proc. R. Soc. A
// 241, 1957, nearly incompressible).
double ball_effect(double ratio);

// The share of a ball's volume in the energies, with `J` the derivatives of the log gains by log E
// at the nodes of the grid (gains x nodes). Nodes stand for their cells; cells that the boundary
// cuts count by how far they reach in; the whole has the ball's volume.
Eigen::VectorXd ball_signal(const Eigen::MatrixXd& J, const FieldGrid& grid, const Vec3& centre,
                            double radius);

}  // namespace hapsim
