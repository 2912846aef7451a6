#include "effects/catalogue.h"

#include <algorithm>

#include "base/error.h"
#include "base/nearest.h"
#include "effects/effects.h"

namespace hapsim {

const std::vector<const Effect*>& catalogue() {
#define HAPSIM_ADDRESS_OF_EFFECT(name) &name##_effect(),
  static const std::vector<const Effect*> effects{HAPSIM_EFFECTS(HAPSIM_ADDRESS_OF_EFFECT)};
#undef HAPSIM_ADDRESS_OF_EFFECT
  return effects;
}

const Effect* find_effect(const std::string& name) {
  for (const Effect* effect : catalogue())
    if (effect->card().name == name) return effect;
  return nullptr;
}

namespace {

// The first effect whose card has it; the test of the catalogue asserts that there is one.
template <class Property>
const Effect& effect_with(const Property& property) {
  return **std::find_if(catalogue().begin(), catalogue().end(),
                        [&](const Effect* e) { return property(e->card()); });
}

}  // namespace

const Effect& body_effect() {
  static const Effect& effect =
      effect_with([](const EffectCard& card) { return !card.modulus.empty(); });
  return effect;
}

const Effect& map_effect() {
  static const Effect& effect = effect_with([](const EffectCard& card) { return card.is_map; });
  return effect;
}

const Effect& field_effect() {
  static const Effect& effect = effect_with([](const EffectCard& card) { return card.is_field; });
  return effect;
}

const Effect& maxwell_effect() {
  static const Effect& effect = effect_with([](const EffectCard& card) { return card.maxwell; });
  return effect;
}

std::string known_effects(const std::string& meant) {
  std::vector<std::string> names;
  std::string all;
  for (const Effect* effect : catalogue()) {
    names.push_back(effect->card().name);
    all += (all.empty() ? "" : ", ") + names.back();
  }
  const std::string near = nearest(meant, names);
  return near.empty() ? "the catalogue has: " + all : "did you mean '" + near + "'?";
}

const Effect& require_effect(const std::string& name) {
  if (const Effect* effect = find_effect(name)) return *effect;
  fail_usage("unknown effect '" + name + "'", known_effects(name));
}

}  // namespace hapsim
