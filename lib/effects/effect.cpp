#include "effects/effect.h"

#include <algorithm>
#include <cassert>

namespace hapsim {

void Effect::describe(const Values&, MaterialSpec&) const {}

void Effect::apply(const PressView&, const Values&, Signal&) const {}

std::vector<std::vector<double>> Effect::starts(const DataSummary&, int terms) const {
  std::vector<double> start;
  for (int k = 0; k < terms; ++k)
    for (const ParameterCard& p : card().parameters) start.push_back(p.start);
  return {start};
}

const ParameterValue& find_value(const Values& values, const std::string& name) {
  const auto found = std::find_if(values.begin(), values.end(),
                                  [&](const ParameterValue& v) { return v.name == name; });
  assert(found != values.end());
  return *found;
}

}  // namespace hapsim
