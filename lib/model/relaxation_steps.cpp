#include "model/relaxation_steps.h"

#include <algorithm>
#include <string>

#include "base/error.h"
#include "effects/catalogue.h"

namespace hapsim {
namespace {

Values values_of(const Model& model, const Effect& effect, int region) {
  Values values;
  for (const Parameter& p : model.parameters)
    if (p.effect == effect.card().name && (region < 0 || p.region == region))
      values.push_back({p.region, p.name, p.value, -1});
  return values;
}

// Its Maxwell elements in a region (-1: all rows together) for that modulus; false: it has no such
// form.
bool terms_of(const Model& model, const Effect& effect, int region, double modulus,
              std::vector<MaxwellTerm>& terms) {
  return effect.relaxation(values_of(model, effect, region), modulus, terms);
}

// The largest region that an effect with Maxwell elements has rows of.
int last_region(const Model& model) {
  int last = 0;
  for (const Effect* effect : catalogue()) {
    std::vector<MaxwellTerm> terms;
    if (!terms_of(model, *effect, -1, 1, terms) || terms.empty()) continue;
    for (const Parameter& p : model.parameters)
      if (p.effect == effect->card().name) last = std::max(last, p.region);
  }
  return last;
}

}  // namespace

std::vector<RegionRelaxation> regional_relaxation_of(const Model& model,
                                                     const MaterialSpec& material) {
  const int last = last_region(model);
  if (last == 0) return {};
  if (last >= static_cast<int>(material.modulus.size()))
    fail_input(model.name, "region " + std::to_string(last) + " relaxes but has no modulus E",
               "give the effect elastic a row E of that region");
  std::vector<RegionRelaxation> regions;
  for (const double modulus : material.modulus) regions.push_back({modulus, {}});
  for (const Effect* effect : catalogue())
    for (std::size_t r = 0; r < regions.size(); ++r) {
      std::vector<MaxwellTerm> terms;
      terms_of(model, *effect, static_cast<int>(r), 1, terms);
      for (const MaxwellTerm& t : terms)
        if (t.share > 0) regions[r].terms.push_back({t.share, t.tau});
    }
  const bool relaxed = std::all_of(regions.begin(), regions.end(),
                                   [](const RegionRelaxation& r) { return r.terms.empty(); });
  return relaxed ? std::vector<RegionRelaxation>{} : regions;
}

ModelRelaxation relaxation_of(const Model& model, const MaterialSpec& material) {
  ModelRelaxation relaxation;
  relaxation.regional = regional_relaxation_of(model, material);
  if (last_region(model) > 0) return relaxation;
  for (const Effect* effect : catalogue()) {
    std::vector<MaxwellTerm> terms;
    if (!values_of(model, *effect, -1).empty())
      terms_of(model, *effect, -1, material.modulus[0], terms);
    relaxation.common.insert(relaxation.common.end(), terms.begin(), terms.end());
  }
  return relaxation;
}

void refuse_other_than_relaxation(const Model& model, const std::string& asked) {
  for (const Effect* effect : catalogue()) {
    std::vector<MaxwellTerm> terms;
    if (!values_of(model, *effect, -1).empty() && !terms_of(model, *effect, -1, 1, terms))
      fail_input(model.name,
                 "the model has " + effect->card().name + ", which " + asked + " cannot do",
                 "leave it out, or fit a model without that effect");
  }
}

void refuse_regional_relaxation(const Model& model) {
  if (last_region(model) > 0)
    fail_input(model.name, "the model's regions relax each in its own way",
               "simulate it with hs-simulate, or give all of them the terms of region 0");
}

}  // namespace hapsim
