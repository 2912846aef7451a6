// All effects that hapsim knows, in the order in which a force passes through them.
#pragma once

#include <string>
#include <vector>

#include "effects/effect.h"

namespace hapsim {

const std::vector<const Effect*>& catalogue();

// Null when the name is unknown.
const Effect* find_effect(const std::string& name);

// The effect that is the body itself (EffectCard::modulus).
const Effect& body_effect();
// The effect that maps the body's modulus (EffectCard::is_map).
const Effect& map_effect();
// The one that is a smooth field over the body (EffectCard::is_field).
const Effect& field_effect();
// The effect of Maxwell elements (EffectCard::maxwell).
const Effect& maxwell_effect();

// The effect that was probably meant, "did you mean 'friction'?", or else all of them.
std::string known_effects(const std::string& meant);

// Error(kUsage) with known_effects().
const Effect& require_effect(const std::string& name);

}  // namespace hapsim
