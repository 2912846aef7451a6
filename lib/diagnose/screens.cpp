#include "diagnose/screens.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "diagnose/gates.h"

namespace hapsim {
namespace {

// Places spread over all: each the farthest from those before it.
std::vector<std::size_t> spread_places(const std::vector<Vec3>& positions, std::size_t count) {
  std::vector<std::size_t> chosen{0};
  std::vector<double> distance(positions.size(), std::numeric_limits<double>::infinity());
  while (chosen.size() < count) {
    for (std::size_t p = 0; p < positions.size(); ++p)
      distance[p] = std::min(distance[p], (positions[p] - positions[chosen.back()]).norm());
    chosen.push_back(static_cast<std::size_t>(std::max_element(distance.begin(), distance.end()) -
                                              distance.begin()));
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

// The places about one.
std::vector<std::size_t> nearest_places(const std::vector<Vec3>& positions, const Vec3& about,
                                        std::size_t count) {
  std::vector<std::size_t> order(positions.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return (positions[a] - about).squaredNorm() < (positions[b] - about).squaredNorm();
  });
  order.resize(count);
  std::sort(order.begin(), order.end());
  return order;
}

double sum_of_squares(const Fit& fitted) {
  return fitted.error.pooled * fitted.error.pooled * static_cast<double>(fitted.residuals);
}

}  // namespace

bool has_many_places(const Dataset& dataset) {
  return dataset.positions.size() > kManyPlaces;
}

// Some places of a ground, with the baseline fitted there.
struct Screens::Screen {
  Experiment experiment;
  TrialGround ground;
  Baseline base;
  Screen(const Baseline& all, const TrialGround& g, const std::vector<std::size_t>& places)
      : experiment(at_positions(g.experiment, places)),
        ground(experiment, g.allowance),
        base(make_baseline(all.fitted.model, ground, {})) {}
};

Screens::Screens(const Baseline& base, const TrialGround& ground, const Departures& departures)
    : base_(base), ground_(ground), where_(departures.where) {}

Screens::~Screens() = default;

std::optional<Screens::Tried> Screens::try_effect(const Effect& effect, double worth,
                                                  std::string& lack) {
  const bool local = effect.card().local;
  std::unique_ptr<Screen>& screen = local ? local_ : everywhere_;
  const auto& positions = ground_.dataset.positions;
  if (!screen)
    screen = std::make_unique<Screen>(
        base_, ground_,
        local ? nearest_places(positions, where_, kScreened) : spread_places(positions, kScreened));
  auto candidate = hapsim::try_effect(effect, screen->base, screen->ground, lack);
  if (!candidate) return std::nullopt;
  const Fit& before = screen->base.fitted;
  if (candidate->fitted.error.pooled < worth * before.error.pooled)
    refine(*candidate, screen->ground);
  const double left = candidate->fitted.error.pooled / before.error.pooled;
  Tried tried{left, left, candidate->fitted.model, kScreened};
  if (!local) return tried;
  const double share = sum_of_squares(before) / sum_of_squares(base_.fitted);
  tried.left = std::sqrt(std::max(0.0, 1 - (1 - left * left) * share));
  // What the places about one say of the rest of the model holds there alone.
  for (Parameter& p : tried.model.parameters)
    for (const Parameter& known : base_.fitted.model.parameters)
      if (p.effect == known.effect && p.name == known.name && p.region == known.region)
        p.value = known.value;
  return tried;
}

}  // namespace hapsim
