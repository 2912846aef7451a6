// The Maxwell elements of a model, sample by sample.
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
// number, none where there are none. Error(kBadInput): an effect that has no form for a loop
// (Effect::live); `asked` says by what, "the real-time loop".
ModelRelaxation relaxation_of(const Model& model, const MaterialSpec& material,
                              const std::string& asked);

// The same, empty where all regions relax alike; other effects of the model are no matter.
std::vector<RegionRelaxation> regional_relaxation_of(const Model& model,
                                                     const MaterialSpec& material);
// Error(kBadInput) where the relaxation is regional, for what cannot do that.
void refuse_regional_relaxation(const Model& model);

}  // namespace hapsim
