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
ExtendOptions extend_as(const Workspace& w, const Model& model) {
  ExtendOptions options = trial_extend_options(w);
  if (material_of(model).local) options.regions = kEverySite;
  return options;
}

// The model without its location-based effects, which must be rebuilt from training data alone.
Model without_map(const Model& model, std::vector<std::string>& rebuilt) {
  Model plain = model;
  for (const std::string& name : model.effects())
    if (require_effect(name).card().from_locations) {
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

FitOptions trial_fit_options(const Workspace& w, int rounds) {
  FitOptions options{w.noise.value, w.floor, w.dataset.positions.size() <= kMostSolvedPositions};
  options.rounds = rounds;
  options.settled = 1e-3;
  options.keep_apart = false;  // a term that coincides with another explains nothing
  return options;
}

ExtendOptions trial_extend_options(const Workspace& w) {
  ExtendOptions options;
  options.noise = w.noise.value;
  options.floor = w.floor;
  return options;
}

bool has_map(const Model& model) {
  const std::vector<std::string> effects = model.effects();
  return std::any_of(effects.begin(), effects.end(), [](const std::string& name) {
    return require_effect(name).card().from_locations;
  });
}

// Refits in a fold start from the fit on all data.
HeldOut held_out_of(const Model& fitted, Workspace& w, const Folds& folds, Map map) {
  std::vector<std::string> rebuilt;
  const Model plain = without_map(fitted, rebuilt);
  const MaterialSpec material = material_of(fitted);
  const auto builder = [&](const Selection& training) -> std::vector<Model> {
    if (map == Map::kKnown && covers(material, training, w.dataset)) return {fitted};
    Model model = plain;
    for (const std::string& name : rebuilt) {
      model = fit(model, w.dataset, training, *w.body, trial_fit_options(w, 0)).model;
      model = with_effect(model, name, w.dataset, training, *w.body, extend_as(w, fitted)).front();
    }
    return {model};
  };
  return held_out_error(builder, w.dataset, folds, *w.body, trial_fit_options(w));
}

}  // namespace hapsim
