// The Maxwell elements of a model.
#pragma once

#include <vector>

#include "effects/effect.h"
#include "model/model.h"
#include "solid/relaxation_spectrum.h"

namespace hapsim {

// What the effects of a model that relax say of each region.
struct ModelRelaxation {
  std::vector<MaxwellTerm> common;         // the same relative relaxation in all regions
  std::vector<RegionRelaxation> regional;  // by region, where they differ; else empty
};

// Terms with a region above 0 make the relaxation regional: each region has those of its own
// number, none where there are none. Other effects of the model are no matter.
ModelRelaxation relaxation_of(const Model& model, const MaterialSpec& material);
// Error(kBadInput) where the model has an effect without such a form (Effect::relaxation), for what
// is of a linear body alone; `asked` says what, "the field of the body".
void refuse_other_than_relaxation(const Model& model, const std::string& asked);

// The elements of the regions, empty where all relax alike.
std::vector<RegionRelaxation> regional_relaxation_of(const Model& model,
                                                     const MaterialSpec& material);
// Error(kBadInput) where the relaxation is regional, for what cannot do that.
void refuse_regional_relaxation(const Model& model);

}  // namespace hapsim
