// A linear elastic body pressed by bonded flat tools on its own mesh.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "linalg/schur_inverse.h"
#include "solid/elastic_body.h"

namespace hapsim {

// The nodes of the boundary within `radius` of `point` and within half of it of the tangent plane
// there; never bonded ones. At least the nearest one: a mesh coarser than the tool has no patch of
// its size (then the force depends on the mesh). Error(kBadInput): the point lies farther than 3
// radii (at least 10 mm) from the surface.
struct MeshPatch {
  std::vector<int> nodes;
  Vec3 point, normal;  // on the surface; outward, unit
};
MeshPatch patch_under_tool(const TetMesh& mesh, const Vec3& point, double radius);

// The nodes of a patch move together, all else is free or bonded. With the direct solver several
// positions share one factorisation of the body held at its support, in which the nodes of all
// patches come last: with C the displacements of a patch's nodes by unit forces on them (the dense
// inverse of the Schur complement) and T the three translations, K = T' C^-1 T, and the forces
// C^-1 T give the fields, three right-hand sides a position.
class MeshPress {
 public:
  // The mesh must outlive it. `solver`: by size means for all these positions together.
  MeshPress(const TetMesh& mesh, std::vector<MeshPatch> patches,
            SolverKind solver = SolverKind::kBySize);

  struct Solution {
    Eigen::Matrix3d K;      // [N/m]; the force of the body on a tool moved by u is -K u
    Eigen::MatrixXd field;  // 3 nodes x 3: displacements for unit displacements of the tool [-]
  };
  // For one pair of Lame's constants an element [Pa]. Error(kNoConvergence): not positive definite,
  // or the iteration stopped.
  std::vector<Solution> solve(const std::vector<Lame>& lame_of_tet);

  const std::vector<MeshPatch>& patches() const { return patches_; }
  const SolverChoice& solver() const { return choice_; }
  int iterations() const;  // the most of any position's solutions so far; 0 when direct
  Dilatation dilatation() const { return dilatation_; }

 private:
  std::vector<Solution> solve_together(const std::vector<Lame>& lame_of_tet);

  const TetMesh& mesh_;
  std::vector<MeshPatch> patches_;
  Dilatation dilatation_;
  SolverChoice choice_;
  std::unique_ptr<NodeSystem> shared_;               // of all positions,
  std::unique_ptr<SchurInverse> condensed_;          // to the nodes of their patches, or
  std::vector<std::unique_ptr<ElasticBody>> apart_;  // one a position
};

}  // namespace hapsim
