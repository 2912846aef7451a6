#include "diagnose/held_out.h"

#include <algorithm>
#include <set>

#include "effects/catalogue.h"
#include "experiment/nearest_region.h"

namespace hapsim {
namespace {

// Regions are solved for where that takes seconds; with more positions they are first order.
constexpr std::size_t kMostSolvedPositions = 60;

// As the model's own regions were made.
ExtendOptions extend_as(const TrialGround& g, const Model& model) {
  ExtendOptions options = trial_extend_options(g);
  if (material_of(model).local) options.regions = kEverySite;
  return options;
}

// The model without its location-based effects, which must be rebuilt from training data alone.
Model without_map(const Model& model, std::vector<std::string>& rebuilt) {
  Model plain = model;
  for (const std::string& name : model.effects())
    if (require_effect(name).card().is_map) {
      std::erase_if(plain.parameters, [&](const Parameter& p) { return p.effect == name; });
      rebuilt.push_back(name);
    }
  if (!rebuilt.empty())
    std::erase_if(plain.parameters, [](const Parameter& p) { return p.region > 0; });
  return plain;
}

// Whether each region has one of the chosen positions in it, so that its modulus can be fitted.
bool covers(const MaterialSpec& material, const Selection& training, const Dataset& dataset) {
  if (material.local) return false;
  std::set<int> lacking(material.key_region.begin(), material.key_region.end());
  for (const int e : training)
    lacking.erase(region_at(material, dataset.positions[dataset.episodes[e].position]));
  return lacking.empty();
}

}  // namespace

FitOptions trial_fit_options(const TrialGround& g, int rounds) {
  FitOptions options{g.allowance.noise, g.allowance.floor,
                     g.dataset.positions.size() <= kMostSolvedPositions};
  options.rounds = rounds;
  options.settled = 1e-3;
  options.keep_scales = true;
  options.keep_apart = false;  // a term that coincides with another explains nothing
  return options;
}

ExtendOptions trial_extend_options(const TrialGround& g) {
  ExtendOptions options;
  options.noise = g.allowance.noise;
  options.floor = g.allowance.floor;
  return options;
}

bool has_map(const Model& model) {
  const std::vector<std::string> effects = model.effects();
  return std::any_of(effects.begin(), effects.end(),
                     [](const std::string& name) { return require_effect(name).card().is_map; });
}

namespace {

// Refits in a fold start from the fit on all data. `g` stays.
ModelBuilder builder_of(const Fit& fitted, const TrialGround& g, Map map) {
  std::vector<std::string> rebuilt;
  const Model plain = without_map(fitted.model, rebuilt);
  const Linearisation about_plain =
      rebuilt.empty() ? fitted.about : g.experiment.places.solve(material_of(plain));
  const MaterialSpec material = material_of(fitted.model);
  return [=, &g](const Selection& training) -> Starts {
    if (map == Map::kKnown && covers(material, training, g.dataset))
      return {{fitted.model}, fitted.about};
    Starts starts{{plain}, about_plain};
    for (const std::string& name : rebuilt) {
      const Fit base =
          fit(starts.models.front(), g.experiment, training, trial_fit_options(g, 0), about_plain);
      starts.models = {
          with_effect(base, name, g.experiment, training, extend_as(g, fitted.model)).front()};
    }
    return starts;
  };
}

}  // namespace

HeldOut held_out_of(const Fit& fitted, const TrialGround& g, const Folds& folds, Map map) {
  return held_out_error(builder_of(fitted, g, map), g.experiment, folds, trial_fit_options(g));
}

Fit fitted_as_in_folds(const Fit& fitted, const TrialGround& g, Map map) {
  const Selection all = all_episodes(g.dataset);
  const Starts starts = builder_of(fitted, g, map)(all);
  return fit_best(starts.models, g.experiment, all, trial_fit_options(g, 0), starts.known);
}

}  // namespace hapsim
