// Models of every effect of the catalogue, and a motion in which each of them acts.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "effects/catalogue.h"
#include "experiment/experiment.h"
#include "model/body_parameters.h"
#include "support/block_mesh.h"

namespace hapsim::test {

inline const std::vector<Vec3>& pressed_places() {
  static const std::vector<Vec3> places{{0.03, 0.035, 0.04}, {0.05, 0.045, 0.04}};
  return places;
}

// Presses with holds, ways sideways and back at several depths, out over the surface while still
// held, and in the air; the first place twice more after the second. Steps of some milliseconds
// that are not alike; warming up. `straight`: one direction a press.
inline Recording rich_motion(bool straight, std::uint64_t seed = 5) {
  Recording r;
  r.name = "rich";
  r.metadata.set("tool_radius", "0.004");
  Random random(seed);
  double t = 3;
  const int place_of[] = {0, 1, 0, 0};
  for (int press = 0; press < 4; ++press) {
    const double deep = 0.0015 + 0.001 * press + 0.0005 * random.uniform();
    const Vec3 side(random.normal(), random.normal(), 0);
    for (int i = 0; i < 400; ++i) {
      t += 0.001 + 0.002 * random.uniform();
      const double s = i / 400.0;
      // In by 0.2, a hold, half-way out and in again deeper, out over the surface, in the air.
      double depth = s < 0.05   ? -0.0004
                     : s < 0.25 ? deep * (s - 0.05) / 0.2
                     : s < 0.4  ? deep
                     : s < 0.5  ? deep * (1 - 4 * (s - 0.4))
                     : s < 0.65 ? deep * (0.6 + 4 * (s - 0.5))
                     : s < 0.9  ? 1.2 * deep - (1.2 * deep + 0.0003) * (s - 0.65) / 0.25
                                : -0.0005;
      const bool in_air = s < 0.05 || s >= 0.9;
      const double along = straight ? 0.3 * depth : (in_air ? 0 : 8e-4 * std::sin(25 * s));
      r.line.push_back(static_cast<long>(r.line.size()) + 2);
      r.press.push_back(press);
      r.t.push_back(t);
      r.position.push_back(pressed_places()[static_cast<std::size_t>(place_of[press])]);
      r.u.emplace_back(-depth * Vec3::UnitZ() + along * side.normalized());
      r.f.push_back(Vec3::Zero());
      r.temp.push_back(21 + 0.5 * t);
      r.contact.push_back(in_air ? 0 : 1);
    }
    t += 0.5;
  }
  return r;
}

inline TetMesh pressed_block() {
  return block_mesh({0.08, 0.08, 0.04}, 6, 6, 4, 1);
}

inline Experiment rich_experiment(bool straight) {
  ExperimentOptions options;
  options.rim_edge = 0.3;
  options.noise = 0.01;
  options.floor = 0.01;
  return make_experiment(pressed_block(), rich_motion(straight), options);
}

// What such a motion shows of a body: one place is stiffer than the other.
inline DataSummary felt() {
  DataSummary data;
  data.has_time = true;
  data.sample_step = 0.002;
  data.press_duration = 0.8;
  data.session = 5;
  data.peak_stiffness = 300;
  data.places = {{pressed_places()[0], Vec3::UnitZ(), 1.5},
                 {pressed_places()[1], Vec3::UnitZ(), 1}};
  return data;
}

// A value within the card's bounds about one that is felt; of a switch either.
inline double drawn(const ParameterCard& p, double about, Random& random) {
  if (p.fixed && p.upper - p.lower == 1) return std::round(random.uniform());
  const double way = 2 * random.uniform() - 1;
  const double value = p.logarithmic ? about * std::exp(1.2 * way) : about + 0.9 * p.scale * way;
  return value > p.lower && value < p.upper ? value : about;
}

// An elastic body and the effect, of random values; `presses` of a motion.
inline Model model_with(const Effect& effect, Random& random, int presses) {
  const EffectCard& card = effect.card();
  Model model;
  model.parameters = body_rows(1e4 * (1 + random.uniform()), 0.3 + 0.15 * random.uniform());
  if (&effect == &body_effect()) return model;
  if (card.is_map) {  // two halves, each of which may be felt alone
    model.parameters.push_back(*modulus_of(model));
    model.parameters.back().region = 1;
    model.parameters.back().value *= 0.5;
    for (const int region : {0, 1})
      for (const ParameterCard& p : card.parameters) {
        Parameter row = effect_rows(effect, 1, {}).front();
        row.region = region;
        row.name = p.name.size() == 1 ? p.name + "1" : p.name;
        row.value = p.name == "x"   ? 0.02 + 0.04 * region
                    : p.name == "y" ? 0.04
                                    : std::round(random.uniform());
        if (p.name.size() == 1 || region == 0) model.parameters.push_back(row);
      }
    return model;
  }
  const int terms = card.per_press ? presses : card.terms ? 2 : 1;
  const std::vector<double> about = effect.starts(felt(), card.terms ? terms : 1).front();
  std::vector<double> values;
  for (int k = 0; k < terms; ++k)
    for (const ParameterCard& p : card.parameters)
      values.push_back(drawn(p, about[values.size() % about.size()], random));
  for (Parameter& p : effect_rows(effect, terms, values)) model.parameters.push_back(std::move(p));
  return model;
}

}  // namespace hapsim::test
