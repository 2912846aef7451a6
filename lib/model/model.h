// A model: a list of effects with their parameters' values. With a body it gives forces.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "effects/effect.h"
#include "io/metadata.h"
#include "io/stream.h"

namespace hapsim {

enum class ParameterState { kFree, kFixed, kDerived };

// One row of model.csv.
struct Parameter {
  std::string effect;
  int region = 0;
  std::string name;
  double value = 0;
  std::string unit;
  double std_error = std::numeric_limits<double>::quiet_NaN();  // NaN: not estimated
  double lower = 0;
  double upper = 0;
  ParameterState state = ParameterState::kFree;
};

struct Model {
  Metadata metadata;
  std::vector<Parameter> parameters;
  std::string name;  // of the file it was read from, for messages; may be empty

  std::vector<std::string> effects() const;  // in order of first appearance
  bool has(const std::string& effect) const;
  // Null when absent.
  const Parameter* find(const std::string& effect, int region, const std::string& parameter) const;
  Parameter* find(const std::string& effect, int region, const std::string& parameter);
  // Numbers of the free parameters, in order: the columns of a fit.
  std::vector<int> free_parameters() const;
};

// What the card of an effect says of a parameter: "E2" of an effect with terms has the card of
// "E1". Null when the effect has no such parameter.
const ParameterCard* parameter_card(const Effect& effect, const std::string& name);

// The rows of an effect with `terms` terms (or presses), at given values (one a card parameter and
// term; identities where they end). Switches are fixed, what is solved for press by press is
// derived, the rest is free.
std::vector<Parameter> effect_rows(const Effect& effect, int terms,
                                   const std::vector<double>& values);

// model.csv: effect,region,parameter,value,unit,std_error,lower,upper,state.
// Error(kBadInput) with line: unknown effect or parameter (nearest named), value out of its bounds,
// wrong unit, missing `elastic`, parameters of an effect missing.
Model read_model(Input& input);
void write_model(std::ostream& out, const Model& model);

}  // namespace hapsim
