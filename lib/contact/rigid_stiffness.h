// How bonded flat tools resist being moved and turned.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "solid/elasticity.h"
#include "tetmesh/contact_mesh.h"

namespace hapsim {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

// The nodes that move with a tool, and the point about which it turns.
struct RigidPatch {
  std::vector<int> nodes;
  Vec3 point;
};

// K (u_1, theta_1, u_2, ...): the forces [N] and moments about their points [N m] that move the
// tools by u [m] and turn them by small rotation vectors theta [rad], all at once on one mesh; the
// body's on the tools are their negatives. From the nodal tractions of the unit motions; symmetric,
// 6 x 6 a patch. One pair of Lame's constants an element [Pa]. Error(kNoConvergence) as
// ElasticBody.
Eigen::MatrixXd rigid_stiffness(const TetMesh& mesh, const std::vector<RigidPatch>& patches,
                                const std::vector<Lame>& lame_of_tet);

}  // namespace hapsim
