#include "fit/extend.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "effects/catalogue.h"
#include "fit/extend_regions.h"
#include "fit/learned_field.h"
#include "fit/testable.h"
#include "model/body_parameters.h"
#include "model/model_edit.h"
#include "recording/ceiling.h"

namespace hapsim {
namespace {

// Within what the effect can be in such data.
void set_limits(std::vector<Parameter>& rows, const Effect& effect, const DataSummary& summary) {
  const auto limits = effect.limits(summary);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto& [lower, upper] = limits[k % limits.size()];
    rows[k].lower = lower;
    rows[k].upper = upper;
    rows[k].value = std::clamp(rows[k].value, lower, upper);
  }
}

}  // namespace

std::vector<const Effect*> known_but_lacking(const Model& model, const Dataset& dataset) {
  const DataSummary summary = summarise(dataset, 1);
  std::vector<const Effect*> effects;
  for (const Effect* effect : catalogue())
    if (!model.has(effect->card().name) && !effect->known(summary).empty())
      effects.push_back(effect);
  return effects;
}

Model elastic_model(const Experiment& experiment, const Selection& selection,
                    const std::vector<std::string>& added) {
  const Dataset& dataset = experiment.dataset;
  const Effect& elastic = body_effect();
  const DataSummary summary = summarise(dataset, 1);
  Model model;
  model.parameters = effect_rows(elastic, 1, elastic.starts(summary, 1).front());
  for (const Effect* effect : known_but_lacking(model, dataset)) {
    if (std::find(added.begin(), added.end(), effect->card().name) != added.end()) continue;
    for (Parameter p : effect_rows(*effect, 1, effect->known(summary))) {
      p.state = ParameterState::kFixed;
      p.upper = std::max(p.upper, p.value);
      model.parameters.push_back(p);
    }
  }
  for (const Effect* effect : catalogue()) {
    const std::string& name = effect->card().name;
    if (!effect->doubted(summary) || std::find(added.begin(), added.end(), name) != added.end())
      continue;
    std::vector<double> identity;
    for (const ParameterCard& p : effect->card().parameters) identity.push_back(p.identity);
    std::vector<Parameter> rows = effect_rows(*effect, 1, identity);
    set_limits(rows, *effect, summary);
    model.parameters.insert(model.parameters.end(), rows.begin(), rows.end());
  }
  const Eigen::VectorXd f = solved_forces(model, experiment, selection, false).f;
  const double power = f.squaredNorm();
  if (power <= 0)
    fail_input(dataset.recording.name, "no row presses the body",
               "check ux,uy,uz: all displacements are zero");
  const double gain = f.dot(measured_forces(dataset, selection)) / power;
  if (gain <= 0)
    fail_input(dataset.recording.name, "the forces point the wrong way",
               "forces are of the body on the tool: pressing down (uz < 0) gives fz > 0");
  Parameter& modulus = *modulus_of(model);
  modulus.value = std::clamp(gain * modulus.value, modulus.lower, modulus.upper);
  return model;
}

std::vector<Model> with_effect(const Fit& base_fit, const std::string& name,
                               const Experiment& experiment, const Selection& selection,
                               const ExtendOptions& options) {
  const Dataset& dataset = experiment.dataset;
  const Model& fitted = base_fit.model;
  const Effect& effect = require_effect(name);
  const EffectCard& card = effect.card();
  if (const std::string lack = lacking_for(card, dataset); !lack.empty())
    fail_input(dataset.recording.name, "the data cannot show " + name, lack);
  if (fitted.has(name) && !(card.terms && !card.is_map))
    fail_usage("the model has " + name + " already", "remove it first (--remove " + name + ")");
  if (card.is_map) return {with_regions(base_fit, experiment, selection, options)};

  Model base = fitted;
  // What the new effect contains gives way to it.
  for (const std::string& other : card.contains)
    if (base.has(other)) remove_effect(base, other);
  int terms = card.terms       ? options.terms
              : card.per_press ? static_cast<int>(dataset.episodes.size())
                               : 1;
  if (fitted.has(name)) {
    int present = 0;
    for (const Parameter& p : fitted.parameters) present += p.effect == name;
    terms = present / static_cast<int>(card.parameters.size()) + 1;
    std::erase_if(base.parameters, [&](const Parameter& p) { return p.effect == name; });
  }
  DataSummary summary = summarise(dataset, modulus_of(fitted)->value);
  if (card.solved && card.needs_positions)
    for (const LocationSample& s : location_samples(fitted, experiment, base_fit.about, selection,
                                                    {options.noise, options.floor}))
      summary.places.push_back(
          {s.point, experiment.places.contact(static_cast<std::size_t>(s.position)).normal,
           s.gain});
  if (card.needs_line) {
    summary.line = line_left(base_fit, experiment, selection, card.stage);
    if (summary.line.frequency == 0)
      fail_input(dataset.recording.name, "the data cannot show " + name, kNoLine);
  }
  const Surface& surface = experiment.places.setup(0)->surface();
  summary.low = summary.high = surface.vertices.front();
  for (const Vec3& p : surface.vertices) {
    summary.low = summary.low.cwiseMin(p);
    summary.high = summary.high.cwiseMax(p);
  }
  if (card.stage == Stage::kSupport)
    if (const RigidMove move = experiment.places.move(); move.significant()) {
      summary.shift = move.shift;
      summary.rotation = move.rotation;
    }
  std::vector<Model> starts;
  for (const std::vector<double>& values : effect.starts(summary, terms)) {
    Model model = base;
    std::vector<Parameter> rows = effect_rows(effect, terms, values);
    set_limits(rows, effect, summary);
    model.parameters.insert(model.parameters.end(), rows.begin(), rows.end());
    starts.push_back(model);
  }
  return starts;
}

namespace {

// Whether the force swings so where nothing is touched: then it is no body that does.
bool swings_too(const SpectralLine& line, const std::vector<double>& t,
                const std::vector<Vec3>& values) {
  constexpr std::size_t kFewest = 12;
  constexpr double kPlainly = 9, kAsMuch = 0.25;  // deviations; of the power in contact
  if (t.size() < kFewest) return false;
  Eigen::MatrixXd A(static_cast<Eigen::Index>(t.size()), 3), y = A;
  for (std::size_t i = 0; i < t.size(); ++i) {
    const double phase = 2 * 3.14159265358979323846 * line.frequency * t[i];
    A.row(static_cast<Eigen::Index>(i)) << std::sin(phase), std::cos(phase), 1;
    y.row(static_cast<Eigen::Index>(i)) = values[i].transpose();
  }
  const Eigen::MatrixXd x = A.colPivHouseholderQr().solve(y);
  const double rest = (y - A * x).squaredNorm() / (3 * static_cast<double>(t.size() - 3));
  const double power = x.topRows(2).squaredNorm();
  return power > kPlainly * 6 * 2 * rest / static_cast<double>(t.size()) &&
         power > kAsMuch * (line.sine.squaredNorm() + line.cosine.squaredNorm());
}

}  // namespace

SpectralLine line_left(const Fit& fitted, const Experiment& experiment, const Selection& selection,
                       Stage stage) {
  const Eigen::VectorXd left = measured_forces(experiment.dataset, selection) -
                               model_forces(fitted, experiment, selection, false).f;
  std::vector<double> t, air_t;
  std::vector<Vec3> values, in_air;
  Eigen::Index at = 0;
  for (const int e : selection) {
    const PressView& press = experiment.dataset.episodes[static_cast<std::size_t>(e)].view;
    for (std::size_t i = 0; i < press.size(); ++i, at += 3) {
      if (press.session.empty()) continue;
      const bool apart = press.in_air[i] && stage != Stage::kSensor;
      (apart ? air_t : t).push_back(press.session[i]);
      (apart ? in_air : values).emplace_back(left.segment<3>(at));
    }
  }
  if (stage == Stage::kSensor) return find_line(t, values, selection.size(), kNyquist);
  const SpectralLine line = find_line(t, values, selection.size());
  return line.frequency > 0 && swings_too(line, air_t, in_air) ? SpectralLine{} : line;
}

}  // namespace hapsim
