#include "experiment/torque_levers.h"

#include <Eigen/Dense>
#include <algorithm>

#include "experiment/registration.h"

namespace hapsim {
namespace {

// The finer mesh errs by some part of what the coarser one adds (mesh_uncertainty()).
constexpr double kShareOfChange = 0.7;

double doubt_of(const TorqueSolution& s) {
  const Eigen::Matrix3d fine = s.T * s.K.inverse(), coarse = s.coarse_T * s.coarse_K.inverse();
  return kShareOfChange * (coarse - fine).cwiseAbs().maxCoeff();
}

}  // namespace

TorqueLevers::TorqueLevers(const Places& places, const MaterialSpec& material, bool regions) {
  for (std::size_t p = 0; p < places.size(); ++p) place_.push_back(places.place(p));
  for (std::size_t s = 0; s < places.setups(); ++s) {
    OfSetup setup;
    setup.solved = places.setup(s)->before_move(material)->torques(in_place(material), regions);
    const std::vector<double>& nu = setup.solved->nu;
    const bool apart = regions && places.setup(s)->has_regions(material);
    for (std::size_t p = 0; !apart && p < places.setup(s)->positions().size(); ++p) {
      setup.K.emplace_back();
      setup.T.emplace_back();
      for (std::size_t k = 0; k < nu.size(); ++k) {
        const TorqueSolution& at = setup.solved->solutions[k][p];
        setup.K.back().add(nu[k], at.K, at.dK_dnu);
        setup.T.back().add(nu[k], at.T, at.dT_dnu);
      }
    }
    setups_.push_back(std::move(setup));
  }
}

TorqueLever TorqueLevers::at(std::size_t position, const MaterialSpec& material) const {
  const Linearisation::Place& place = place_[position];
  const OfSetup& setup = setups_[place.setup];
  TorqueLever lever;
  const auto add = [&](int column, const Eigen::Matrix3d& by) {
    if (column >= 0) lever.by_column.emplace_back(column, by);
  };
  for (const auto& of_nu : setup.solved->solutions)
    lever.doubt = std::max(lever.doubt, doubt_of(of_nu[place.position]));
  Eigen::Matrix3d K, T, dK, dT;
  if (!setup.K.empty()) {
    setup.K[place.position].evaluate(material.nu, K, dK);
    setup.T[place.position].evaluate(material.nu, T, dT);
  } else {
    const TorqueSolution& s = setup.solved->solutions.front()[place.position];
    const double step = material.nu - setup.solved->nu.front();
    dK = material.modulus[0] * s.dK_dnu;
    dT = material.modulus[0] * s.dT_dnu;
    K = step * dK;
    T = step * dT;
    for (std::size_t g = 0; g < material.modulus.size(); ++g) {
      K += material.modulus[g] * s.dK_dmodulus[g];
      T += material.modulus[g] * s.dT_dmodulus[g];
    }
    const Eigen::Matrix3d inverse = K.inverse();
    for (std::size_t g = 0; g < material.modulus.size(); ++g)
      add(material.modulus_column[g],
          (s.dT_dmodulus[g] - T * inverse * s.dK_dmodulus[g]) * inverse);
  }
  const Eigen::Matrix3d inverse = K.inverse();
  lever.L = T * inverse;
  add(material.nu_column, (dT - lever.L * dK) * inverse);
  if (!has_moved(material)) return lever;
  const Eigen::Matrix3d R = rotation_matrix(material.rotation);
  lever.L = (R * lever.L * R.transpose()).eval();
  for (auto& [column, by] : lever.by_column) by = (R * by * R.transpose()).eval();
  return lever;
}

}  // namespace hapsim
