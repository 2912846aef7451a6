#include "effects/catalogue.h"

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

const Effect& require_effect(const std::string& name) {
  if (const Effect* effect = find_effect(name)) return *effect;
  std::string all;
  for (const Effect* effect : catalogue()) all += (all.empty() ? "" : ", ") + effect->card().name;
  fail_usage("unknown effect '" + name + "'", "the catalogue has: " + all);
}

}  // namespace hapsim
