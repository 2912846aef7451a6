#include "experiment/extrapolate.h"

#include <Eigen/Dense>

namespace hapsim {
namespace {

// P in the derivative of a Cholesky factor, L' = L P: the lower half of L^-1 K' L^-T.
Eigen::Matrix3d factor_slope(const Eigen::Matrix3d& inverse, const Eigen::Matrix3d& by) {
  Eigen::Matrix3d P = inverse * by * inverse.transpose();
  P.diagonal() /= 2;
  return P.triangularView<Eigen::Lower>().toDenseMatrix();
}

// How a stiffness follows Poisson's ratio as the homogeneous body does: K -> A K A', A = L(nu)
// L(reference)^-1 with L the Cholesky factor of the homogeneous stiffness; A is 1 at the reference.
struct PoissonMap {
  Eigen::Matrix3d A, A_by_nu;
  PoissonMap(const UnitStiffness& homogeneous, double reference, double nu) {
    Eigen::Matrix3d K, by_nu;
    homogeneous.evaluate(reference, K, by_nu);
    const Eigen::Matrix3d L_ref = K.llt().matrixL();
    homogeneous.evaluate(nu, K, by_nu);
    const Eigen::Matrix3d L = K.llt().matrixL(), inverse = L.inverse();
    A = L * L_ref.inverse();
    A_by_nu = L * factor_slope(inverse, by_nu) * L_ref.inverse();
  }
  Eigen::Matrix3d operator()(const Eigen::Matrix3d& K) const { return A * K * A.transpose(); }
  Eigen::Matrix3d by_nu(const Eigen::Matrix3d& K) const {
    const Eigen::Matrix3d half = A_by_nu * K * A.transpose();
    return half + half.transpose();
  }
};

}  // namespace

PositionStiffness extrapolated(const StiffnessSolution& s, const UnitStiffness& homogeneous,
                               const MaterialSpec& reference, const MaterialSpec& material) {
  const double scale = material.modulus[0] / reference.modulus[0];
  const PoissonMap map(homogeneous, reference.nu, material.nu);
  const PoissonMap there(homogeneous, reference.nu, reference.nu);
  const Eigen::Matrix3d left = s.dK_dnu - there.by_nu(s.K);  // what the map lacks
  const double step = material.nu - reference.nu;
  Eigen::Matrix3d features = Eigen::Matrix3d::Zero();
  for (std::size_t f = 0; f < material.features.size(); ++f)
    for (std::size_t v = 0; v < s.dK_dfeature[f].size(); ++v)
      features += (material.features[f].feature.value[v] - reference.features[f].feature.value[v]) *
                  s.dK_dfeature[f][v];
  Eigen::Matrix3d K = scale * features;
  PositionStiffness result;
  for (std::size_t g = 0; g < material.modulus.size(); ++g) {
    K += material.modulus[g] * s.dK_dmodulus[g];
    Eigen::Matrix3d by_modulus = map(s.dK_dmodulus[g]);
    if (g == 0) by_modulus += (map(features) + step * left) / reference.modulus[0];
    result.add(material.modulus_column[g], by_modulus);
  }
  result.K = map(K) + scale * step * left;
  result.add(material.nu_column, map.by_nu(K) + scale * left);
  for (std::size_t f = 0; f < material.features.size(); ++f)
    for (std::size_t v = 0; v < s.dK_dfeature[f].size(); ++v)
      result.add(material.features[f].column[v], scale * map(s.dK_dfeature[f][v]));
  return result;
}

PositionStiffness with_estimate(const PositionStiffness& without,
                                const FeatureEstimate::Change& change,
                                const std::vector<int>& column) {
  const Eigen::Matrix3d L = without.K.llt().matrixL(), inverse = L.inverse();
  PositionStiffness result;
  result.K = L * change.G * L.transpose();
  for (const auto& [c, dK] : without.by_column) {
    const Eigen::Matrix3d half = L * factor_slope(inverse, dK) * change.G * L.transpose();
    result.add(c, half + half.transpose());
  }
  for (std::size_t v = 0; v < column.size(); ++v)
    result.add(column[v], L * change.by_value[v] * L.transpose());
  return result;
}

}  // namespace hapsim
