#include "contact/rigid_stiffness.h"

#include "solid/elastic_body.h"

namespace hapsim {
namespace {

// By how much a point at `arm` from the one that it turns about moves with a tool.
Eigen::Matrix<double, 3, 6> rigid_motion(const Vec3& arm) {
  Eigen::Matrix<double, 3, 6> motion;
  motion.leftCols<3>().setIdentity();
  for (int k = 0; k < 3; ++k) motion.col(3 + k) = Vec3::Unit(k).cross(arm);
  return motion;
}

}  // namespace

Eigen::MatrixXd rigid_stiffness(const TetMesh& mesh, const std::vector<RigidPatch>& patches,
                                const std::vector<Lame>& lame_of_tet) {
  std::vector<int> handle(mesh.nodes.size(), kFreeNode);
  for (std::size_t n = 0; n < handle.size(); ++n)
    if (mesh.fixed[n]) handle[n] = kHeldNode;
  Eigen::Index count = 0;
  for (const RigidPatch& p : patches) count += static_cast<Eigen::Index>(p.nodes.size());
  // A handle of its own each: the nodes under a tool that turns do not move by the same.
  Eigen::MatrixXd motion =
      Eigen::MatrixXd::Zero(3 * count, 6 * static_cast<Eigen::Index>(patches.size()));
  int next = 0;
  for (std::size_t p = 0; p < patches.size(); ++p)
    for (const int n : patches[p].nodes) {
      motion.block<3, 6>(3 * next, 6 * static_cast<Eigen::Index>(p)) =
          rigid_motion(mesh.nodes[n] - patches[p].point);
      handle[n] = next++;
    }
  ElasticBody body(mesh, handle, mesh.order == 2 ? Dilatation::kElement : Dilatation::kPointwise);
  body.factorise(lame_of_tet);
  const Eigen::MatrixXd K = motion.transpose() * body.solve(motion).reaction;
  return 0.5 * (K + K.transpose());
}

}  // namespace hapsim
