#include "effects/effect.h"

#include <algorithm>
#include <cassert>

#include "effects/effect_step.h"

namespace hapsim {

void Motion::make_du() {
  if (du.cols() == 0 && columns > 0)
    du = Eigen::MatrixXd::Zero(3 * static_cast<Eigen::Index>(u.size()), columns);
}

void Effect::describe(const Values&, MaterialSpec&) const {}

void Effect::move(const PressView&, const Values&, Motion&) const {}

void Effect::apply(const PressView&, const Values&, Signal&) const {}

std::vector<std::pair<double, double>> Effect::limits(const DataSummary&) const {
  std::vector<std::pair<double, double>> limits;
  for (const ParameterCard& p : card().parameters) limits.emplace_back(p.lower, p.upper);
  return limits;
}

std::string Effect::implausible(const Values&, const std::vector<Vec3>&) const {
  return "";
}

std::unique_ptr<EffectStep> Effect::step(const Values&, const StepContext&) const {
  return nullptr;
}

bool Effect::relaxation(const Values&, double, std::vector<MaxwellTerm>&) const {
  return false;
}

bool Effect::full(const Values& values, double modulus, FullSpec& spec) const {
  return card().solved || relaxation(values, modulus, spec.terms);
}

std::vector<std::vector<double>> Effect::starts(const DataSummary&, int terms) const {
  std::vector<double> start;
  for (int k = 0; k < terms; ++k)
    for (const ParameterCard& p : card().parameters) start.push_back(p.start);
  return {start};
}

bool Effect::doubted(const DataSummary&) const {
  return false;
}

std::vector<EffectCurve> Effect::curves(const Values&) const {
  return {};
}

std::vector<double> Effect::known(const DataSummary&) const {
  return {};
}

void add_feature(Feature kind, const Values& values, const EffectCard& card,
                 MaterialSpec& material) {
  FeatureSpec spec{{kind, {}}, {}};
  for (const ParameterCard& p : card.parameters) {
    const ParameterValue& v = find_value(values, p.name);
    spec.feature.value.push_back(v.value);
    spec.column.push_back(v.column);
  }
  assert(spec.feature.value.size() == feature_size(kind));
  material.features.push_back(std::move(spec));
}

const ParameterValue& find_value(const Values& values, const std::string& name) {
  const auto found = std::find_if(values.begin(), values.end(),
                                  [&](const ParameterValue& v) { return v.name == name; });
  assert(found != values.end());
  return *found;
}

}  // namespace hapsim
