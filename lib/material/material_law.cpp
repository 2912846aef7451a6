#include "material/material_law.h"

#include <Eigen/Dense>
#include <cmath>

namespace hapsim {

Voigt to_voigt(const Eigen::Matrix3d& a) {
  Voigt v;
  for (int k = 0; k < 6; ++k) v[k] = a(kVoigtPairs[k][0], kVoigtPairs[k][1]);
  return v;
}

VoigtMatrix symmetric_product(const Eigen::Matrix3d& a) {
  VoigtMatrix m;
  for (int r = 0; r < 6; ++r)
    for (int c = r; c < 6; ++c) {
      const auto [i, j] = kVoigtPairs[r];
      const auto [k, l] = kVoigtPairs[c];
      m(r, c) = m(c, r) = 0.5 * (a(i, k) * a(j, l) + a(i, l) * a(j, k));
    }
  return m;
}

VoigtMatrix stress_rotation(const Eigen::Matrix3d& R) {
  VoigtMatrix T;
  for (int r = 0; r < 6; ++r)
    for (int c = 0; c < 6; ++c) {
      const auto [i, j] = kVoigtPairs[r];
      const auto [k, l] = kVoigtPairs[c];
      T(r, c) = R(i, k) * R(j, l) + (k != l ? R(i, l) * R(j, k) : 0);
    }
  return T;
}

Eigen::Matrix3d nominal_stress(const MaterialLaw& law, const Eigen::Matrix3d& F) {
  const bool small = law.small_strain();
  const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d C =
      small ? Eigen::Matrix3d(F + F.transpose() - one) : Eigen::Matrix3d(F.transpose() * F);
  const Voigt s = law.respond(C, false).S;
  Eigen::Matrix3d S;
  for (int k = 0; k < 6; ++k)
    S(kVoigtPairs[k][0], kVoigtPairs[k][1]) = S(kVoigtPairs[k][1], kVoigtPairs[k][0]) = s[k];
  if (small) return S + law.volume(F.trace() - 2).first * one;
  const double J = F.determinant();
  return F * S + law.volume(J).first * J * F.inverse().transpose();
}

}  // namespace hapsim
