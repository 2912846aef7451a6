#include "model/body_parameters.h"

#include "effects/catalogue.h"

namespace hapsim {

bool is_modulus(const Parameter& p) {
  const EffectCard& card = body_effect().card();
  return p.effect == card.name && p.name == card.modulus;
}

bool is_poissons_ratio(const Parameter& p) {
  const EffectCard& card = body_effect().card();
  return p.effect == card.name && p.name == card.poissons_ratio;
}

bool is_of_map(const Parameter& p) {
  return require_effect(p.effect).card().is_map;
}

const Parameter* modulus_of(const Model& model, int region) {
  const EffectCard& card = body_effect().card();
  return model.find(card.name, region, card.modulus);
}

Parameter* modulus_of(Model& model, int region) {
  const EffectCard& card = body_effect().card();
  return model.find(card.name, region, card.modulus);
}

const Parameter* poissons_ratio_of(const Model& model) {
  const EffectCard& card = body_effect().card();
  return model.find(card.name, 0, card.poissons_ratio);
}

Parameter* poissons_ratio_of(Model& model) {
  const EffectCard& card = body_effect().card();
  return model.find(card.name, 0, card.poissons_ratio);
}

std::vector<Parameter> body_rows(double modulus, double poissons_ratio) {
  return effect_rows(body_effect(), 1, {modulus, poissons_ratio});
}

}  // namespace hapsim
