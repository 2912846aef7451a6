// A model's body pressed on its own mesh: no contact meshes, the fields of the whole body.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "experiment/dataset.h"
#include "experiment/extrapolate.h"
#include "model/relaxation_steps.h"
#include "solid/mesh_press.h"

namespace hapsim {

class OwnMesh {
 public:
  // One factorisation or iteration for all positions; some thirty where regions relax each in its
  // own way. Error(kBadInput): the model has an effect that
  // needs meshes of its own (features, a body that moved). Error(kBadInput): a position off the
  // surface. `mesh` must outlive it.
  OwnMesh(const TetMesh& mesh, const Model& model, const std::vector<Vec3>& positions,
          double tool_radius, SolverKind solver);

  const PositionStiffness& at(std::size_t position) const { return stiffness_[position]; }
  bool is_regional() const { return !stiffness_.empty() && !stiffness_[0].relaxing.empty(); }
  std::vector<ToolStand> stands() const;
  // Of the body's tetrahedra, by position; empty: all 0 (Dataset::label).
  std::vector<int> labels() const;
  const SolverChoice& solver() const { return press_.solver(); }
  int iterations() const { return press_.iterations(); }
  std::size_t patch_size(std::size_t position) const;  // nodes that move with the tool

  // The nodal displacements [m], and by element the mean stress (xx, yy, zz, xy, yz, xz) [Pa] and
  // the mean density of the energy stored in its springs [J/m^3], at sample `at` of a press from a
  // relaxed body, as a VTU file. With displacements u of the tool and h_i their memory,
  // sigma = C eps(u + sum_i (E_i/E) h_i), energy = (u.D u + sum_i (E_i/E) h_i.D h_i) / 2 with D the
  // densities of the unit fields. Error(kBadInput): the model has an effect without such a form,
  // or its regions relax each in its own way.
  void write_field(std::ostream& out, const Episode& episode, std::size_t at) const;

 private:
  Eigen::Matrix3d unit_stress(std::size_t tet, const Eigen::Matrix<double, 3, 10>& u) const;

  const TetMesh& mesh_;
  const Model& model_;
  MaterialSpec material_;
  double tool_radius_;
  std::vector<Lame> lame_;
  MeshPress press_;
  std::vector<MeshPress::Solution> solutions_;
  std::vector<double> gain_;  // by position: what its own modulus is of the mesh's
  std::vector<PositionStiffness> stiffness_;
};

}  // namespace hapsim
