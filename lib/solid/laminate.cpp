#include "solid/laminate.h"

#include <Eigen/Dense>
#include <cmath>

namespace hapsim {
namespace {

using Traction = Eigen::Matrix<double, 6, 3>;  // n_j sigma_ij = (N' sigma)_i

Traction tractions(const Vec3& n) {
  Traction N = Traction::Zero();
  for (int c = 0; c < 6; ++c) {
    const auto [i, j] = kVoigtPairs[c];
    N(c, i) += n[j];
    if (i != j) N(c, j) += n[i];
  }
  return N;
}

VoigtMatrix full_law(const VoigtMatrix& D, double kappa) {
  VoigtMatrix full = D;
  full.topLeftCorner<3, 3>().array() += kappa;
  return full;
}

}  // namespace

PlaneLaw::PlaneLaw(const VoigtMatrix& D, double kappa) : full_(full_law(D, kappa)) {}

VoigtMatrix PlaneLaw::at(const Vec3& normal) const {
  const Traction T = full_ * tractions(normal);
  const Eigen::Matrix3d Q = tractions(normal).transpose() * T;
  return full_ - T * Q.llt().solve(T.transpose());
}

VoigtMatrix PlaneLaw::by_normal(const Vec3& normal, const Vec3& change) const {
  const Traction N = tractions(normal), dN = tractions(change);
  const Traction T = full_ * N;
  const Eigen::Matrix3d dQ = dN.transpose() * T + T.transpose() * dN;
  const Eigen::Matrix<double, 3, 6> S = (N.transpose() * T).llt().solve(T.transpose());
  const VoigtMatrix half = full_ * dN * S;
  return S.transpose() * dQ * S - half - half.transpose();
}

VoigtMatrix PlaneLaw::by_law(const Vec3& normal, const VoigtMatrix& D, double kappa) const {
  const Traction N = tractions(normal), T = full_ * N;
  // Strains across the layers follow those along them so that their stress is none.
  const VoigtMatrix free =
      VoigtMatrix::Identity() - N * (N.transpose() * T).llt().solve(T.transpose());
  return free.transpose() * full_law(D, kappa) * free;
}

double expm1_over(double x) {
  return std::abs(x) < 1e-9 ? 1 + x / 2 : std::expm1(x) / x;
}

double expm1_over_slope(double x) {
  if (std::abs(x) < 1e-3) return 0.5 + x / 3 + x * x / 8;
  return (std::exp(x) - expm1_over(x)) / x;
}

BoundaryNormal boundary_normal(const TetMesh& mesh, std::size_t tetrahedron,
                               const LevelSet& level) {
  const auto& n = mesh.tets[tetrahedron];
  const Vec3& first = mesh.nodes[n[0]];
  Eigen::Matrix3d edges;
  for (int k = 0; k < 3; ++k) edges.col(k) = mesh.nodes[n[k + 1]] - first;
  const Eigen::Matrix3d slopes = edges.inverse().transpose();  // of the coordinates 1 to 3
  const LevelValue at_first = level(first);
  Vec3 gradient = Vec3::Zero();
  Eigen::Matrix3Xd by = Eigen::Matrix3Xd::Zero(3, at_first.by_parameters.size());
  for (int k = 0; k < 3; ++k) {
    const LevelValue at = level(mesh.nodes[n[k + 1]]);
    gradient += (at.value - at_first.value) * slopes.col(k);
    by += slopes.col(k) * (at.by_parameters - at_first.by_parameters).transpose();
  }
  const double size = gradient.norm();
  BoundaryNormal result;
  result.by_parameters.setZero(3, by.cols());
  if (!(size > 1e-9)) return result;  // as far from it everywhere: any direction is as good
  result.normal = gradient / size;
  result.by_parameters = (by - result.normal * (result.normal.transpose() * by)) / size;
  return result;
}

}  // namespace hapsim
