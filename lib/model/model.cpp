#include "model/model.h"

#include <algorithm>
#include <cctype>

#include "effects/catalogue.h"

namespace hapsim {

std::vector<std::string> Model::effects() const {
  std::vector<std::string> names;
  for (const Parameter& p : parameters)
    if (std::find(names.begin(), names.end(), p.effect) == names.end()) names.push_back(p.effect);
  return names;
}

bool Model::has(const std::string& effect) const {
  return std::any_of(parameters.begin(), parameters.end(),
                     [&](const Parameter& p) { return p.effect == effect; });
}

const Parameter* Model::find(const std::string& effect, int region,
                             const std::string& parameter) const {
  for (const Parameter& p : parameters)
    if (p.effect == effect && p.region == region && p.name == parameter) return &p;
  return nullptr;
}

Parameter* Model::find(const std::string& effect, int region, const std::string& parameter) {
  return const_cast<Parameter*>(static_cast<const Model*>(this)->find(effect, region, parameter));
}

std::vector<int> Model::free_parameters() const {
  std::vector<int> free;
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (parameters[i].state == ParameterState::kFree) free.push_back(static_cast<int>(i));
  return free;
}

namespace {

// Whether an effect has a row of it by term, press or place: these are told apart by numbers.
bool is_numbered(const EffectCard& card, const ParameterCard& p) {
  return card.terms || card.per_press || (card.is_field && p.name.back() == '1');
}

// "tau12" -> "tau" and 12; 0 when there is no number.
std::pair<std::string, int> split_term(const std::string& name) {
  std::size_t end = name.size();
  while (end > 0 && std::isdigit(static_cast<unsigned char>(name[end - 1]))) --end;
  if (end == name.size() || name.size() - end > 6) return {name, 0};
  return {name.substr(0, end), std::stoi(name.substr(end))};
}

}  // namespace

const ParameterCard* parameter_card(const Effect& effect, const std::string& name) {
  for (const ParameterCard& p : effect.card().parameters) {
    if (p.name == name) return &p;
    if (!is_numbered(effect.card(), p)) continue;
    const auto [stem, term] = split_term(name);
    if (term > 0 && split_term(p.name).first == stem) return &p;
  }
  for (const ParameterCard& p : effect.card().of_region)
    if (p.name == name) return &p;
  return nullptr;
}

std::vector<Parameter> effect_rows(const Effect& effect, int terms,
                                   const std::vector<double>& values) {
  std::vector<Parameter> rows;
  for (int k = 0; k < terms; ++k)
    for (const ParameterCard& card : effect.card().parameters) {
      Parameter p;
      p.effect = effect.card().name;
      const bool numbered = is_numbered(effect.card(), card);
      if (k > 0 && !numbered) continue;
      p.name = numbered ? split_term(card.name).first + std::to_string(k + 1) : card.name;
      p.value = rows.size() < values.size() ? values[rows.size()] : card.identity;
      p.unit = card.unit;
      p.lower = card.lower;
      p.upper = card.upper;
      p.state = effect.card().per_press || (effect.card().is_field && numbered)
                    ? ParameterState::kDerived
                : card.fixed ? ParameterState::kFixed
                             : ParameterState::kFree;
      rows.push_back(p);
    }
  return rows;
}

}  // namespace hapsim
