// Elements that a boundary between two stiffnesses cuts, as a laminate along it.
#pragma once

#include <Eigen/Core>

#include "base/vec3.h"
#include "material/material_law.h"
#include "mesh/tetmesh.h"
#include "solid/level_set.h"

namespace hapsim {

// A law of stress (D + kappa 1 1') strain, in layers of scales q_i that fill shares s_i of the
// volume. Strains along the layers and stresses across them are the same in all of them, so for a
// unit normal n it is exactly (Postma, Geophysics 20, 1955; Backus, J. Geophys. Res. 67, 1962)
//   H (D + kappa 1 1') + (A - H) P(n),  A = sum s_i q_i,  H = 1 / sum (s_i / q_i),
// with P(n) the law in plane stress along the layers: the mixture in parallel along them, in series
// across. As the law of an element that a boundary cuts: Kabel, Merkert and Schneider (Comput.
// Methods Appl. Mech. Eng. 294, 2015). P stays finite as nu tends to 1/2.
class PlaneLaw {
 public:
  PlaneLaw(const VoigtMatrix& D, double kappa);
  VoigtMatrix at(const Vec3& normal) const;
  // Its derivatives: along a change of the (unit) normal, and along one of the law.
  VoigtMatrix by_normal(const Vec3& normal, const Vec3& change) const;
  VoigtMatrix by_law(const Vec3& normal, const VoigtMatrix& D, double kappa) const;

 private:
  VoigtMatrix full_;
};

// (e^x - 1) / x and its derivative.
double expm1_over(double x);
double expm1_over_slope(double x);

// The direction in which a level set grows over a tetrahedron, from the values at its corners.
struct BoundaryNormal {
  Vec3 normal = Vec3::UnitZ();
  Eigen::Matrix3Xd by_parameters;  // one column a parameter of the boundary
};
BoundaryNormal boundary_normal(const TetMesh& mesh, std::size_t tetrahedron, const LevelSet& level);

}  // namespace hapsim
