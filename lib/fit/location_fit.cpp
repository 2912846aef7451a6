#include "fit/location_fit.h"

#include <cmath>
#include <string>

#include "effects/catalogue.h"
#include "model/body_parameters.h"
#include "model/model_edit.h"

namespace hapsim {
namespace {

constexpr double kKnownNu = 0.1;  // largest standard error of a nu that is worth telling

struct Sample {
  bool found = false;
  double E = 0, E_std = 0, nu = 0, nu_std = 0;
};

Sample fit_position(const Model& start, const Experiment& experiment, const Selection& selection,
                    const FitOptions& options) {
  const Fit result = fit(start, experiment, selection, options);
  const Parameter& e = *modulus_of(result.model);
  const Parameter& nu = *poissons_ratio_of(result.model);
  Sample sample{result.converged && std::isfinite(e.std_error) && e.std_error > 0, e.value,
                e.std_error, nu.value, 0};
  if (nu.state == ParameterState::kFree) sample.nu_std = nu.std_error;
  return sample;
}

}  // namespace

LocationTable fit_locations(const Model& model, const Experiment& experiment,
                            const FitOptions& options) {
  const Dataset& dataset = experiment.dataset;
  FitOptions of_place = options;
  of_place.constraints.clear();  // they are of the whole
  Model start = model;
  const std::string& map = map_effect().card().name;
  if (start.has(map)) remove_effect(start, map);
  const bool nu_is_free = poissons_ratio_of(start)->state == ParameterState::kFree;
  for (Parameter& p : start.parameters)
    if (p.state == ParameterState::kFree) p.state = ParameterState::kFixed;
  modulus_of(start)->state = ParameterState::kFree;

  std::vector<Selection> at(dataset.positions.size());
  for (std::size_t e = 0; e < dataset.episodes.size(); ++e)
    at[static_cast<std::size_t>(dataset.episodes[e].position)].push_back(static_cast<int>(e));
  const auto fit_all = [&](bool with_nu) {
    poissons_ratio_of(start)->state = with_nu ? ParameterState::kFree : ParameterState::kFixed;
    std::vector<Sample> samples;
    for (const Selection& selection : at) {
      samples.push_back(fit_position(start, experiment, selection, of_place));
      const Sample& s = samples.back();
      if (with_nu && !(s.found && s.nu_std > 0 && s.nu_std < kKnownNu))
        return std::vector<Sample>{};
    }
    return samples;
  };
  std::vector<Sample> samples;
  if (nu_is_free) samples = fit_all(true);
  if (samples.empty()) samples = fit_all(false);

  LocationTable table;
  int failed = 0;
  for (std::size_t p = 0; p < at.size(); ++p) {
    if (!samples[p].found) {
      ++failed;
      continue;
    }
    std::size_t rows = 0;
    for (const int e : at[p]) rows += dataset.episodes[static_cast<std::size_t>(e)].rows.size();
    table.point.push_back(dataset.positions[p]);
    table.E.push_back(samples[p].E);
    table.E_std.push_back(samples[p].E_std);
    table.nu.push_back(samples[p].nu);
    table.nu_std.push_back(samples[p].nu_std);
    table.n.push_back(static_cast<int>(3 * rows));
  }
  if (failed > 0) table.metadata.set("failed", std::to_string(failed));
  return table;
}

}  // namespace hapsim
