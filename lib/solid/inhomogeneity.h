// Regions of different stiffness on one unchanged mesh.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "mesh/tetmesh.h"
#include "solid/level_set.h"

namespace hapsim {

// 1 for each tetrahedron whose centroid lies inside. Forces jump when a boundary passes a centroid.
std::vector<int> inside_by_centroid(const TetMesh& mesh, const LevelSet& level);

// Share of a tetrahedron in which the linear function with these values at its corners is negative,
// and the share's derivatives by them. Exact (the cut is a plane), continuous.
struct CutShare {
  double share = 0;
  std::array<double, 4> by_value{};
};
CutShare cut_share(const std::array<double, 4>& value);

// Share of each tetrahedron's volume inside, from 0 to 1, and its derivatives by the boundary's
// parameters: an element cut by the boundary takes part of each side, so forces depend smoothly on
// the boundary. Each tetrahedron is cut into 8^subdivisions parts, in each of which the level set
// is linear (exact for flat boundaries, error of second order in the part's edge for curved ones).
struct InsideShares {
  std::vector<double> share;      // one a tetrahedron
  Eigen::MatrixXd by_parameters;  // tetrahedra x parameters
};
InsideShares inside_shares(const TetMesh& mesh, const LevelSet& level, int subdivisions = 1);
// The same of one tetrahedron; `by_parameters` (one column a parameter) is written.
double inside_share(const TetMesh& mesh, std::size_t tetrahedron, const LevelSet& level,
                    int subdivisions, Eigen::Ref<Eigen::RowVectorXd> by_parameters);

// Stiffness factors ratio^share, one a tetrahedron, for BodyModel::scale and
// NonlinearBody::set_scale: the geometric mean by volume (Lichtenecker, Phys. Z. 27, 1926), between
// the mixtures in parallel and in series, which tends to the sharp boundary as the mesh is refined.
// Of laws that any direction may have, laminate.h has the better one. Several regions multiply.
// `ratio` > 0.
std::vector<double> stiffness_factors(const std::vector<double>& share, double ratio);
// From by_scale of NonlinearBody::Linearisation (rows x tetrahedra): derivatives by the ratio
// (first column) and by the boundary's parameters (the others).
Eigen::MatrixXd by_inhomogeneity(const Eigen::MatrixXd& by_scale, const InsideShares& shares,
                                 double ratio);

}  // namespace hapsim
