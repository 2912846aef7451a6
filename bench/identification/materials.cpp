// Homogeneous bodies: elastic, and with two Maxwell terms.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <optional>

#include "cases.h"
#include "fit/extend.h"
#include "fit/maxwell_terms.h"
#include "support/finer_contact.h"
#include "truth.h"

namespace hapsim::bench {
namespace {

constexpr double kModulus = 1.5e4, kPoisson = 0.42;
const Relaxation kRelaxation{{8e3, 0.3}, {6e3, 10}};
constexpr double kDepth = 2e-3;  // [m]
constexpr int kMost = 20;        // positions on a body

// Everything that the draws of one case share.
struct Setting {
  std::vector<TruePress> presses;
  std::vector<Vec3> forces;
  double noise = 0;
  std::optional<Experiment> undrawn;  // without forces
};

struct Plan {
  std::string object;
  int positions = kMost;
  std::vector<double> slants{0, 0.6, -0.6};  // sideways over downwards, one a press
  double ramp = 1, hold = 0, step = 0;
  Relaxation relaxation;
  double noise = 0.02;  // of the peak
};

std::shared_ptr<Setting> make_setting(const Plan& plan, const std::string& out) {
  const Object object = make_object(plan.object);
  std::vector<Vec3> positions = test::positions_on(object.exact, kMost, 5, kToolRadius);
  Material material;
  material.nu = kPoisson;
  const auto K = true_stiffness(out, plan.object, object, positions, material);
  positions.resize(static_cast<std::size_t>(plan.positions));
  auto s = std::make_shared<Setting>();
  // Normals as a person would see them: of the exact surface.
  const SurfaceTree tree(boundary_surface(object.exact));
  for (std::size_t p = 0; p < positions.size(); ++p) {
    const Vec3 n = face_normal(tree.surface(), tree.nearest(positions[p]).face).normalized(),
               side = n.unitOrthogonal();
    for (std::size_t k = 0; k < plan.slants.size(); ++k) {
      const Vec3 along = k % 2 == 0 ? side : n.cross(side);
      s->presses.push_back(
          {static_cast<int>(p), kDepth * (-n + plan.slants[k] * along), plan.ramp, plan.hold});
    }
  }
  Recording r = record(positions, s->presses, plan.step);
  s->forces = true_forces(r, s->presses, K, kModulus, plan.relaxation);
  s->noise = plan.noise * peak(s->forces);
  ExperimentOptions options;
  options.cache = out + "/cache";
  options.noise = s->noise;
  s->undrawn = make_experiment(object.meshed, std::move(r), options);
  return s;
}

Experiment drawn(const Setting& s, bool gains, int draw) {
  Random random(static_cast<std::uint64_t>(draw));
  return measured(*s.undrawn, s.presses, s.forces, gains ? s.undrawn->floor : 0, s.noise, random);
}

Result value_of(const std::string& trial, int draw, const Model& model, const std::string& effect,
                const std::string& name, double truth, double limit) {
  const Parameter& p = *model.find(effect, 0, name);
  return {trial, draw, name, truth, p.value, p.std_error, limit};
}

FitOptions fit_options(const Setting& s) {
  return {s.noise, s.undrawn->floor, true};
}

Fit elastic_fit(const Setting& s, const Experiment& w) {
  const Selection all = all_episodes(w.dataset);
  return fit(elastic_model(w, all), w, all, fit_options(s));
}

std::vector<Result> fit_elastic(const std::string& trial, const Setting& s, bool gains, int draw) {
  const Fit result = elastic_fit(s, drawn(s, gains, draw));
  return {value_of(trial, draw, result.model, "elastic", "E", kModulus, -0.03),
          value_of(trial, draw, result.model, "elastic", "nu", kPoisson, 0.03)};
}

std::vector<Result> fit_two_terms(const std::string& trial, const Setting& s, int draw) {
  const Experiment w = drawn(s, true, draw);
  const Selection all = all_episodes(w.dataset);
  ExtendOptions extend;
  extend.terms = 2;
  const Fit result = fit_best(with_effect(elastic_fit(s, w), "viscoelastic", w, all, extend), w,
                              all, fit_options(s));
  std::vector<Result> results{value_of(trial, draw, result.model, "elastic", "E", kModulus, -0.03),
                              value_of(trial, draw, result.model, "elastic", "nu", kPoisson, 0.03)};
  for (int k = 0; k < 2; ++k) {
    const auto& [modulus, tau] = kRelaxation[static_cast<std::size_t>(k)];
    results.push_back(value_of(trial, draw, result.model, "viscoelastic", fmt::format("E{}", k + 1),
                               modulus, -0.10));
    results.push_back(value_of(trial, draw, result.model, "viscoelastic",
                               fmt::format("tau{}", k + 1), tau, -0.15));
  }
  return results;
}

TermChoice chosen_terms(const Setting& s, const Experiment& w) {
  return choose_terms(elastic_fit(s, w), "viscoelastic", 3, w, all_episodes(w.dataset),
                      fit_options(s), {});
}

std::vector<Result> choose(const std::string& trial, const Setting& s, int draw) {
  const TermChoice choice = chosen_terms(s, drawn(s, true, draw));
  return {{trial, draw, "terms", 2, double(choice.terms), std::nan(""), 0.5}};
}

std::vector<Result> hold_shortly(const std::string& trial, const Setting& s, int draw) {
  const Experiment w = drawn(s, true, draw);
  const TermChoice choice = chosen_terms(s, w);
  const Model& model = choice.trials[static_cast<std::size_t>(choice.terms - 1)].fit.model;
  const std::vector<std::string> said = untold_times(model, w.dataset);
  return {{trial, draw, "terms", 2, double(choice.terms), std::nan(""), 0},
          {trial, draw, "said", 1, said.empty() ? 0.0 : 1.0, std::nan(""), 0.5}};
}

Plan relaxing(const std::string& object, double hold) {
  Plan plan;
  plan.object = object;
  plan.positions = 6;
  plan.slants = {0, 0.6};
  plan.ramp = 0.2;
  plan.hold = hold;
  plan.step = 0.05;
  plan.relaxation = kRelaxation;
  plan.noise = 0.01;
  return plan;
}

constexpr const char* kObjects[] = {"block", "ball", "organ"};
constexpr int kDraws = 200, kFewDraws = 20;

}  // namespace

std::vector<Case> elastic_cases() {
  std::vector<Case> cases;
  for (const bool gains : {true, false})
    for (const std::string object : kObjects) {
      const std::string name = "elastic " + object + (gains ? "" : " (noise alone)");
      cases.push_back({name, kDraws, [=](const std::string& out) -> Draw {
                         Plan plan;
                         plan.object = object;
                         const auto s = make_setting(plan, out);
                         return [=](int draw) { return fit_elastic(name, *s, gains, draw); };
                       }});
    }
  return cases;
}

std::vector<Case> viscoelastic_cases() {
  std::vector<Case> cases;
  using Trial = std::vector<Result> (*)(const std::string&, const Setting&, int);
  const auto add = [&](const std::string& name, const std::string& object, double hold, int draws,
                       Trial trial) {
    cases.push_back({name, draws, [=](const std::string& out) -> Draw {
                       const auto s = make_setting(relaxing(object, hold), out);
                       return [=](int draw) { return trial(name, *s, draw); };
                     }});
  };
  for (const std::string object : kObjects) {
    add("two terms " + object, object, 20, kDraws, fit_two_terms);
    add("three offered " + object, object, 20, kFewDraws, choose);
    add("held 2 s " + object, object, 2, kFewDraws, hold_shortly);
  }
  return cases;
}

}  // namespace hapsim::bench
