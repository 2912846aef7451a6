#include "model/model_edit.h"

#include <fmt/format.h>

#include "base/error.h"
#include "effects/catalogue.h"
#include "io/csv.h"

namespace hapsim {

void remove_effect(Model& model, const std::string& effect) {
  const Effect* known = find_effect(effect);
  if (known == &body_effect())
    fail_usage("the effect " + effect + " cannot be removed", "remove another");
  if (!model.has(effect))
    fail_usage("the model has no effect '" + effect + "'", "it has " + effects_label(model));
  std::erase_if(model.parameters, [&](const Parameter& p) { return p.effect == effect; });
  if (known->card().is_map)
    std::erase_if(model.parameters, [](const Parameter& p) { return p.region > 0; });
}

void set_state(Model& model, const std::string& what, ParameterState state) {
  const std::size_t equals = what.find('=');
  std::string name = what.substr(0, equals), effect;
  if (const std::size_t dot = name.find('.'); dot != std::string::npos) {
    effect = name.substr(0, dot);
    name = name.substr(dot + 1);
  }
  bool found = false;
  for (Parameter& p : model.parameters) {
    const bool matches = effect.empty() ? (p.name == name || p.effect == name)
                                        : (p.effect == effect && p.name == name);
    if (!matches) continue;
    found = true;
    p.state = state;
    if (equals == std::string::npos) continue;
    double value = 0;
    if (!parse_number(what.substr(equals + 1), value))
      fail_usage("'" + what + "' has no number after the '='", "write nu=0.45");
    if (value < p.lower || value > p.upper)
      fail_usage(fmt::format("{} = {} lies outside its bounds [{}, {}]", name, format_number(value),
                             format_number(p.lower), format_number(p.upper)),
                 "choose a value within");
    p.value = value;
    p.std_error = std::numeric_limits<double>::quiet_NaN();
  }
  if (!found)
    fail_usage("the model has no parameter '" + name + "'", "it has " + effects_label(model));
}

std::string effects_label(const Model& model) {
  std::string label;
  for (const std::string& effect : model.effects()) label += (label.empty() ? "" : "+") + effect;
  return label;
}

}  // namespace hapsim
