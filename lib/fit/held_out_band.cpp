#include "fit/held_out_band.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "effects/catalogue.h"
#include "fit/press_offsets.h"

namespace hapsim {
namespace {

constexpr double kChance = 0.95;

// Sum of squares of the body's forces by position [N^2], and of how many components.
struct PlaceForces {
  double squares = 0, components = 0;
};
std::vector<PlaceForces> forces_by_place(const Dataset& dataset, const Eigen::VectorXd& body) {
  std::vector<PlaceForces> result(dataset.positions.size());
  Eigen::Index at = 0;
  for (const Episode& e : dataset.episodes) {
    const auto n = static_cast<Eigen::Index>(3 * e.rows.size());
    PlaceForces& place = result[static_cast<std::size_t>(e.position)];
    place.squares += body.segment(at, n).squaredNorm();
    place.components += static_cast<double>(n);
    at += n;
  }
  return result;
}

}  // namespace

UnseenBand held_out_band(const HeldOut& held_out, const Folds& folds, const Dataset& dataset,
                         const Allowance& allowance, const Eigen::VectorXd& body) {
  UnseenBand band;
  if (folds.by != "positions" || held_out.by_place.empty() || dataset.axes() < 3) return band;
  const std::vector<PlaceForces> forces = forces_by_place(dataset, body);
  const double noise = allowance.noise;
  std::vector<double> shares;
  for (std::size_t p = 0; p < forces.size(); ++p) {
    if (!(forces[p].squares > 0)) continue;
    const double error = held_out.by_place[p] - forces[p].components * noise * noise;
    shares.push_back(std::sqrt(std::max(0.0, error) / forces[p].squares));
  }
  if (shares.size() < 2) return band;
  std::sort(shares.begin(), shares.end());
  const auto n = static_cast<double>(shares.size());
  const double rank = std::min(n, std::ceil((n + 1) * kChance));
  band.share = std::max(allowance.floor, shares[static_cast<std::size_t>(rank) - 1]);
  band.chance = std::min(kChance, rank / (n + 1));
  return band;
}

UnseenBand held_out_band(const HeldOut& held_out, const Folds& folds, const Experiment& experiment,
                         const Allowance& allowance, const Fit& fitted) {
  if (offset_effect(fitted.model) != nullptr || folds.by.empty()) return {};
  Fit body = fitted;
  std::erase_if(body.model.parameters, [](const Parameter& p) {
    return require_effect(p.effect).card().stage == Stage::kSensor;
  });
  const Eigen::VectorXd forces =
      model_forces(body, experiment, all_episodes(experiment.dataset), false).f;
  return held_out_band(held_out, folds, experiment.dataset, allowance, forces);
}

}  // namespace hapsim
