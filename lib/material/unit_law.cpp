#include "material/unit_law.h"

#include <cmath>

#include "material/hooke_law.h"

namespace hapsim {
namespace {

// D and kappa of a law and their derivatives by its constants.
UnitLaw matrices(const MaterialLaw& law) {
  UnitLaw unit;
  const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
  unit.D = law.respond(one, true).D;
  unit.kappa = law.volume(1).second;
  unit.D_by.assign(law.constants().size(), VoigtMatrix::Zero());
  for (int c = 0; c < 6; ++c) {
    // C = 1 + 2 eps of the unit strain c; the shears are engineering ones.
    Eigen::Matrix3d C = one;
    const auto [i, j] = kVoigtPairs[c];
    C(i, j) += i == j ? 2 : 1;
    if (i != j) C(j, i) += 1;
    const std::vector<Voigt> stress = law.stress_by_constants(C);
    for (std::size_t k = 0; k < stress.size(); ++k) unit.D_by[k].col(c) = stress[k];
  }
  unit.kappa_by = law.pressure_by_constants(2);  // at theta - 1 = 1
  return unit;
}

// Change of a stress (Voigt) when the material turns about w by a unit angle.
VoigtMatrix stress_spin(const Vec3& w) {
  Eigen::Matrix3d R;
  R << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
  const auto delta = [](int a, int b) { return a == b ? 1.0 : 0.0; };
  VoigtMatrix W;
  for (int r = 0; r < 6; ++r)
    for (int c = 0; c < 6; ++c) {
      const auto [i, j] = kVoigtPairs[r];
      const auto [k, l] = kVoigtPairs[c];
      W(r, c) = R(i, k) * delta(j, l) + delta(i, k) * R(j, l);
      if (k != l) W(r, c) += R(i, l) * delta(j, k) + delta(i, l) * R(j, k);
    }
  return W;
}

Vec3 axis_of(double tilt, double azimuth) {
  return {std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth), std::cos(tilt)};
}

TransverseConstants constants_of(double nu, const std::vector<double>& transverse) {
  const double root = std::sqrt(transverse[0]);
  return {1, transverse[0], nu, nu * root, transverse[1] * root / (2 * (1 + nu))};
}

}  // namespace

LawPointer transverse_body_law(double E, double nu, const std::vector<double>& transverse) {
  TransverseConstants c = constants_of(nu, transverse);
  c.plane_modulus *= E;
  c.axial_modulus *= E;
  c.axial_shear *= E;
  return transverse_law(c, axis_of(transverse[2], transverse[3]));
}

UnitLaw unit_law(double nu, const std::vector<double>& transverse) {
  if (transverse.empty()) {
    UnitLaw unit = matrices(*isotropic_law(1, nu));
    unit.D_by.erase(unit.D_by.begin());  // by E
    unit.kappa_by.erase(unit.kappa_by.begin());
    return unit;
  }
  const double ratio = transverse[0], shear = transverse[1], tilt = transverse[2],
               azimuth = transverse[3];
  const double root = std::sqrt(ratio);
  const TransverseConstants constants = constants_of(nu, transverse);
  const UnitLaw all =
      matrices(*transverse_law(constants, axis_of(tilt, azimuth)));  // by Ep, Ea, nup, nua, Ga
  UnitLaw unit{all.D, all.kappa, {}, {}};
  const auto add = [&](double ea, double nup, double nua, double ga) {
    unit.D_by.push_back(ea * all.D_by[1] + nup * all.D_by[2] + nua * all.D_by[3] +
                        ga * all.D_by[4]);
    unit.kappa_by.push_back(ea * all.kappa_by[1] + nup * all.kappa_by[2] + nua * all.kappa_by[3] +
                            ga * all.kappa_by[4]);
  };
  add(0, 1, root, -constants.axial_shear / (1 + nu));
  add(1, 0, nu / (2 * root), constants.axial_shear / (2 * ratio));
  add(0, 0, 0, constants.axial_shear / shear);
  for (const Vec3& w : {Vec3(-std::sin(azimuth), std::cos(azimuth), 0), Vec3(0, 0, 1)}) {
    const VoigtMatrix W = stress_spin(w);
    unit.D_by.push_back(W * unit.D + unit.D * W.transpose());
    unit.kappa_by.push_back(0);
  }
  return unit;
}

}  // namespace hapsim
