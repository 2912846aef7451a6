// The parameters of the body itself: its moduli by region and its Poisson's ratio.
#pragma once

#include "model/model.h"

namespace hapsim {

bool is_modulus(const Parameter& p);
bool is_poissons_ratio(const Parameter& p);
// A row of an effect that is a map over the body (EffectCard::is_map).
bool is_of_map(const Parameter& p);

// E of a region [Pa]; null when the model has none there.
const Parameter* modulus_of(const Model& model, int region = 0);
Parameter* modulus_of(Model& model, int region = 0);
// Null when the model has none.
const Parameter* poissons_ratio_of(const Model& model);
Parameter* poissons_ratio_of(Model& model);

// The rows of a body of one modulus [Pa] and one Poisson's ratio.
std::vector<Parameter> body_rows(double modulus, double poissons_ratio);

}  // namespace hapsim
