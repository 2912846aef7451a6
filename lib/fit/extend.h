// Building models: a first elastic one, and one more effect on top of a fitted model.
#pragma once

#include <string>
#include <vector>

#include "fit/fit.h"
#include "regions/locations.h"

namespace hapsim {

struct ExtendOptions {
  int terms = 1;                    // of effects with terms
  int regions = kAutomaticRegions;  // or a number, kEverySite or kByLabel
  double noise = 1;                 // [N]
  double floor = 0;
};

// Elastic with E from the overall gain of the forces and nu at its start, and with what is known of
// other effects before a fit (Effect::known()), but for those that will be `added`.
Model elastic_model(const Experiment& experiment, const Selection& selection,
                    const std::vector<std::string>& added = {});
// Effects that are known before a fit and that a model lacks.
std::vector<const Effect*> known_but_lacking(const Model& model, const Dataset& dataset);

// Starts of `fitted` with `effect` added (an effect already there gets one more term where it has
// terms). Uses only the chosen episodes. Error(kUsage) when it is there and cannot be repeated,
// Error(kBadInput) when the data cannot bear it (lacking_for()).
std::vector<Model> with_effect(const Fit& fitted, const std::string& effect,
                               const Experiment& experiment, const Selection& selection,
                               const ExtendOptions& options);

// The frequency that stands out of the forces that a fitted model leaves, over the time of the
// session: for a sensor's effect of all of them, for another where the tool is in contact, if they
// do not swing as much in the air.
SpectralLine line_left(const Fit& fitted, const Experiment& experiment, const Selection& selection,
                       Stage stage);
// Said where an effect needs one and there is none.
inline constexpr const char* kNoLine =
    "no frequency stands out of what the model leaves: hold the tool still on the body over ten "
    "periods";

}  // namespace hapsim
