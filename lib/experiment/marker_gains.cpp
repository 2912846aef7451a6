#include "experiment/marker_gains.h"

#include <algorithm>
#include <cmath>

#include "experiment/registration.h"

namespace hapsim {
namespace {

// The finer mesh errs by some part of what the coarser one adds (mesh_uncertainty()).
constexpr double kPartOfChange = 0.7;

}  // namespace

MarkerGains::MarkerGains(const Places& places, const MaterialSpec& material,
                         const std::vector<Vec3>& points, bool regions) {
  for (std::size_t p = 0; p < places.size(); ++p) place_.push_back(places.place(p));
  for (std::size_t s = 0; s < places.setups(); ++s) {
    const SetupPlaces& pressed = *places.setup(s);
    std::vector<Vec3> there = points;
    if (has_moved(material)) {
      const Vec3 middle = middle_of(pressed.positions());
      for (Vec3& p : there) p = moved_back(p, middle, material.shift, material.rotation);
    }
    OfSetup setup;
    setup.solved = pressed.before_move(material)->markers(in_place(material), regions, there);
    const std::vector<double>& nu = setup.solved->nu;
    const bool apart = regions && pressed.has_regions(material);
    for (std::size_t p = 0; !apart && p < pressed.positions().size(); ++p) {
      setup.G.emplace_back(points.size());
      for (std::size_t k = 0; k < nu.size(); ++k) {
        const MarkerSolution& at = setup.solved->solutions[k][p];
        for (std::size_t m = 0; m < points.size(); ++m)
          setup.G.back()[m].add(nu[k], at.G[m], at.dG_dnu[m]);
      }
    }
    setups_.push_back(std::move(setup));
  }
}

std::vector<MarkerGain> MarkerGains::at(std::size_t position, const MaterialSpec& material) const {
  const Linearisation::Place& place = place_[position];
  const OfSetup& setup = setups_[place.setup];
  const auto& solutions = setup.solved->solutions;
  std::vector<MarkerGain> gains(solutions.front()[place.position].G.size());
  const bool moved = has_moved(material);
  const Eigen::Matrix3d R = rotation_matrix(material.rotation);
  for (std::size_t m = 0; m < gains.size(); ++m) {
    MarkerGain& gain = gains[m];
    const auto add = [&](int column, const Eigen::Matrix3d& by) {
      if (column >= 0) gain.by_column.emplace_back(column, by);
    };
    for (const auto& of_nu : solutions) {
      const MarkerSolution& s = of_nu[place.position];
      gain.doubt =
          std::max(gain.doubt, kPartOfChange * (s.coarse_G[m] - s.G[m]).cwiseAbs().maxCoeff());
    }
    Eigen::Matrix3d by_nu;
    if (!setup.G.empty()) {
      setup.G[place.position][m].evaluate(material.nu, gain.G, by_nu);
    } else {
      const MarkerSolution& s = solutions.front()[place.position];
      by_nu = s.dG_dnu[m];
      gain.G = s.G[m] + (material.nu - setup.solved->nu.front()) * by_nu;
      for (std::size_t g = 0; g < material.modulus.size(); ++g) {
        const double about = setup.solved->material.modulus[g];
        const Eigen::Matrix3d by_log = about * s.dG_dmodulus[g][m];
        gain.G += std::log(material.modulus[g] / about) * by_log;
        add(material.modulus_column[g], by_log / material.modulus[g]);
      }
    }
    add(material.nu_column, by_nu);
    if (!moved) continue;
    gain.G = (R * gain.G * R.transpose()).eval();
    for (auto& [column, by] : gain.by_column) by = (R * by * R.transpose()).eval();
  }
  return gains;
}

}  // namespace hapsim
