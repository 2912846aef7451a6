// Changes to a model that are asked for on a command line.
#pragma once

#include <string>
#include <vector>

#include "model/model.h"

namespace hapsim {

// Removes an effect. Error(kUsage) when the model lacks it or it is `elastic`.
void remove_effect(Model& model, const std::string& effect);

// "nu", "nu=0.45", "elastic.nu=0.45", "viscoelastic" (all its parameters): sets the state, and the
// value where one is given. Error(kUsage) when nothing matches or the value breaks the bounds.
void set_state(Model& model, const std::string& what, ParameterState state);

// Names of the model's effects, "elastic+viscoelastic".
std::string effects_label(const Model& model);

}  // namespace hapsim
