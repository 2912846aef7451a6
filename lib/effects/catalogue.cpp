#include "effects/catalogue.h"

#include <algorithm>

#include "base/error.h"
#include "effects/effects.h"

namespace hapsim {

const std::vector<const Effect*>& catalogue() {
  static const std::vector<const Effect*> effects{
      &backlash_effect(),     &elastic_effect(),      &regions_effect(),
      &layer_effect(),        &inclusion_effect(),    &anisotropic_effect(),
      &hyperelastic_effect(), &temperature_effect(),  &softening_effect(),
      &viscoelastic_effect(), &damper_effect(),       &base_effect(),
      &shift_effect(),        &tip_effect(),          &slack_effect(),
      &friction_effect(),     &adhesion_effect(),     &sensor_rotation_effect(),
      &sensor_gain_effect(),  &sensor_curve_effect(), &sensor_lag_effect(),
      &sensor_bias_effect(),  &sensor_drift_effect(), &deadband_effect(),
      &tare_effect(),
  };
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

const Effect& maxwell_effect() {
  static const Effect& effect = effect_with([](const EffectCard& card) { return card.maxwell; });
  return effect;
}

const Effect& require_effect(const std::string& name) {
  if (const Effect* effect = find_effect(name)) return *effect;
  std::string all;
  for (const Effect* effect : catalogue()) all += (all.empty() ? "" : ", ") + effect->card().name;
  fail_usage("unknown effect '" + name + "'", "the catalogue has: " + all);
}

}  // namespace hapsim
