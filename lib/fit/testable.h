// Whether data can test an effect, and whether what it describes is shared by all of them.
#pragma once

#include <string>
#include <vector>

#include "fit/fit.h"

namespace hapsim {

// Empty when what the effect's parameters belong to (one body, one tool) is but one in these data,
// else what to do, in words.
std::string not_shared(const EffectCard& effect, const Dataset& dataset);

// Error(kUsage) naming the first of these effects whose parameters cannot be shared so.
void require_shared(const std::vector<std::string>& effects, const Dataset& dataset);

// Whether a press moves along the surface beside its depth.
bool moves_sideways(const PressView& press);
// Whether it is recorded on its way out; not where it begins above the surface, or wavers there.
bool comes_back(const PressView& press);

// Empty when these data can test the effect, else what they lack, in words.
std::string lacking_for(const EffectCard& effect, const Dataset& dataset);

}  // namespace hapsim
