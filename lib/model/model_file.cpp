// model.csv: the table that a person edits, diffs and joins.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "base/error.h"
#include "effects/catalogue.h"
#include "io/csv.h"
#include "model/body_parameters.h"
#include "model/model.h"

namespace hapsim {
namespace {

const std::vector<std::string> kColumns{"effect",    "region", "parameter", "value", "unit",
                                        "std_error", "lower",  "upper",     "state"};

ParameterState parse_state(const std::string& text, const std::string& where) {
  if (text == "free" || text.empty()) return ParameterState::kFree;
  if (text == "fixed") return ParameterState::kFixed;
  if (text == "derived") return ParameterState::kDerived;
  fail_input(where, "unknown state '" + text + "'", "write free, fixed or derived");
}

const char* state_name(ParameterState state) {
  switch (state) {
    case ParameterState::kFree:
      return "free";
    case ParameterState::kFixed:
      return "fixed";
    default:
      return "derived";
  }
}

void check_row(const Parameter& p, const std::string& where) {
  const Effect* effect = find_effect(p.effect);
  if (effect == nullptr)
    fail_input(where, "unknown effect '" + p.effect + "'", known_effects(p.effect));
  const ParameterCard* card = parameter_card(*effect, p.name);
  if (card == nullptr) {
    std::string all;
    for (const ParameterCard& c : effect->card().parameters) all += " " + c.name;
    for (const ParameterCard& c : effect->card().of_region) all += " " + c.name;
    fail_input(where, fmt::format("effect {} has no parameter '{}'", p.effect, p.name),
               "its parameters are" + all);
  }
  for (const ParameterCard& c : effect->card().of_region)
    if (&c == card && p.region == 0)
      fail_input(where, fmt::format("{} {} is of a region above 0", p.effect, p.name),
                 "give the row the region's number, or take it out");
  if (p.unit != card->unit)
    fail_input(where, fmt::format("{} {} is in '{}'", p.effect, p.name, p.unit),
               "give it in " + card->unit);
  if (p.lower > p.upper)
    fail_input(where, "the lower bound is above the upper bound", "exchange them");
  // Nothing can be solved of an incompressible body, or of one without stiffness.
  if (!std::isnan(card->log_limit) && (p.lower < card->lower || !(p.upper < card->log_limit)))
    fail_input(where,
               fmt::format("{} {}: its bounds [{}, {}] reach what it cannot be", p.effect, p.name,
                           format_number(p.lower), format_number(p.upper)),
               fmt::format("keep them within [{}, {}]", format_number(card->lower),
                           format_number(card->upper)));
  if (card->logarithmic && !(p.value > 0))
    fail_input(where, fmt::format("{} {} = {}", p.effect, p.name, format_number(p.value)),
               "it must be positive");
  if (p.value < p.lower || p.value > p.upper)
    fail_input(where,
               fmt::format("{} {} = {} lies outside its bounds [{}, {}]", p.effect, p.name,
                           format_number(p.value), format_number(p.lower), format_number(p.upper)),
               "change the value or the bounds");
}

// A field has all rows of each of its places.
void require_whole_places(const Model& model, const Effect& effect, const std::string& name) {
  std::map<std::string, std::set<const ParameterCard*>> seen;  // by the number in the name
  std::size_t of_place = 0;
  for (const ParameterCard& card : effect.card().parameters) of_place += card.name.back() == '1';
  for (const Parameter& p : model.parameters) {
    const std::size_t digits = p.name.find_last_not_of("0123456789") + 1;
    if (p.effect == effect.card().name && digits < p.name.size())
      seen[p.name.substr(digits)].insert(parameter_card(effect, p.name));
  }
  for (const auto& [number, rows] : seen)
    if (rows.size() != of_place)
      fail_input(
          name, fmt::format("effect {} lacks rows of its place {}", effect.card().name, number),
          fmt::format("each place has {} rows: add them, or remove all of this place", of_place));
}

// Rows may stand in any order, but effects with terms take theirs term by term, in their card's
// order.
void arrange_terms(Model& model) {
  for (const std::string& name : model.effects()) {
    const Effect& effect = require_effect(name);
    const EffectCard& card = effect.card();
    if (!card.terms && !card.per_press && !card.is_field) continue;
    const auto key = [&](const Parameter& p) {
      const std::size_t digits = p.name.find_last_not_of("0123456789") + 1;
      const int term = digits < p.name.size() ? std::stoi(p.name.substr(digits)) : 0;
      return std::tuple(p.region, term, parameter_card(effect, p.name));
    };
    std::vector<Parameter> rows;
    for (const Parameter& p : model.parameters)
      if (p.effect == name) rows.push_back(p);
    std::stable_sort(rows.begin(), rows.end(), [&](const Parameter& a, const Parameter& b) {
      return key(a) < key(b);  // cards of one effect stand in one array
    });
    auto next = rows.begin();
    for (Parameter& p : model.parameters)
      if (p.effect == name) p = *next++;
  }
}

}  // namespace

Model read_model(Input& input) {
  const CsvTable table = read_csv(input);
  for (const std::string column : {"effect", "parameter", "value"})
    if (table.find(column) < 0)
      fail_input(table.name, "a model has no column '" + column + "'",
                 "the columns are effect,region,parameter,value,unit,std_error,lower,upper,state");
  const auto cell = [&](const std::string& column, std::size_t row) -> std::string {
    const int c = table.find(column);
    return c < 0 ? "" : table.columns[c][row];
  };
  const std::vector<double> values = table.numbers("value");
  Model model;
  model.name = table.name;
  model.metadata = table.metadata;
  std::set<std::string> seen;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::string where = fmt::format("{}:{}", table.name, table.line[row]);
    Parameter p;
    p.effect = cell("effect", row);
    p.name = cell("parameter", row);
    p.value = values[row];
    const auto number = [&](const std::string& column, double otherwise) {
      const std::string text = cell(column, row);
      double value = 0;
      if (text.empty() || text == "nan") return otherwise;
      if (!parse_number(text, value))
        fail_input(where, fmt::format("{} '{}' is not a number", column, text), "mend the cell");
      return value;
    };
    const double region = number("region", 0);
    if (!(region >= 0 && region <= 100000 && region == std::floor(region)))
      fail_input(where, "the region is not a small whole number", "number regions from 0");
    p.region = static_cast<int>(region);
    const Effect* effect = find_effect(p.effect);
    const ParameterCard* card = effect == nullptr ? nullptr : parameter_card(*effect, p.name);
    p.unit = cell("unit", row);
    if (p.unit.empty() && card != nullptr) p.unit = card->unit;
    p.std_error = number("std_error", std::nan(""));
    p.lower = number("lower", card == nullptr ? 0 : card->lower);
    p.upper = number("upper", card == nullptr ? 0 : card->upper);
    p.state = parse_state(cell("state", row), where);
    check_row(p, where);
    if (!seen.insert(fmt::format("{}|{}|{}", p.effect, p.region, p.name)).second)
      fail_input(where, fmt::format("{} {} of region {} stands twice", p.effect, p.name, p.region),
                 "remove one of the rows");
    model.parameters.push_back(p);
  }
  const EffectCard& body = body_effect().card();
  if (modulus_of(model) == nullptr || poissons_ratio_of(model) == nullptr)
    fail_input(table.name,
               fmt::format("the model lacks {} or {} of the effect {} (region 0)", body.modulus,
                           body.poissons_ratio, body.name),
               "start from a file that hs-identify wrote");
  for (const std::string& name : model.effects()) {
    const Effect& effect = require_effect(name);
    if (effect.card().is_map) continue;
    for (const ParameterCard& card : effect.card().parameters) {
      if (model.find(name, 0, card.name) != nullptr) continue;
      if (!card.optional)
        fail_input(table.name, fmt::format("effect {} lacks its parameter {}", name, card.name),
                   "add the row, or remove the effect");
      model.parameters.push_back({name, 0, card.name, card.identity, card.unit, std::nan(""),
                                  card.lower, card.upper, ParameterState::kFixed});
    }
  }
  for (const std::string& name : model.effects())
    if (const Effect& effect = require_effect(name); effect.card().is_field)
      require_whole_places(model, effect, table.name);
  arrange_terms(model);
  return model;
}

void write_model(std::ostream& out, const Model& model) {
  CsvWriter writer(out, model.metadata, kColumns);
  for (const Parameter& p : model.parameters)
    writer.row({p.effect, std::to_string(p.region), p.name, format_number(p.value), p.unit,
                std::isnan(p.std_error) ? "" : format_number(p.std_error), format_number(p.lower),
                format_number(p.upper), state_name(p.state)});
}

}  // namespace hapsim
