#include "fit/held_out_band.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace hapsim {
namespace {

constexpr double kChance = 0.95;

// Sum of squares of the measured forces by position [N^2], and of how many components.
struct PlaceForces {
  double squares = 0, components = 0;
};
std::vector<PlaceForces> forces_by_place(const Dataset& dataset) {
  std::vector<PlaceForces> result(dataset.positions.size());
  for (const Episode& e : dataset.episodes)
    for (const int row : e.rows) {
      PlaceForces& place = result[static_cast<std::size_t>(e.position)];
      place.squares += dataset.recording.f[static_cast<std::size_t>(row)].squaredNorm();
      place.components += dataset.axes();
    }
  return result;
}

}  // namespace

UnseenBand held_out_band(const HeldOut& held_out, const Folds& folds, const Dataset& dataset,
                         const Allowance& allowance) {
  UnseenBand band;
  if (folds.by != "positions" || held_out.by_place.empty()) return band;
  const std::vector<PlaceForces> forces = forces_by_place(dataset);
  const double noise = allowance.noise;
  std::vector<double> shares;
  for (std::size_t p = 0; p < forces.size(); ++p) {
    const double measured = forces[p].squares - forces[p].components * noise * noise;
    if (measured <= 0) continue;  // no force to speak of
    const double error = held_out.by_place[p] - forces[p].components * noise * noise;
    shares.push_back(std::sqrt(std::max(0.0, error) / measured));
  }
  if (shares.size() < 2) return band;
  std::sort(shares.begin(), shares.end());
  const auto n = static_cast<double>(shares.size());
  const double rank = std::min(n, std::ceil((n + 1) * kChance));
  band.share = std::max(allowance.floor, shares[static_cast<std::size_t>(rank) - 1]);
  band.chance = std::min(kChance, rank / (n + 1));
  return band;
}

}  // namespace hapsim
