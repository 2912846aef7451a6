// One press alone: what its course in time names, by data from closed forms.
#include "diagnose/few_presses.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "diagnose/diagnose.h"
#include "diagnose/effect_sets.h"
#include "diagnose/held_out.h"
#include "diagnose/improve.h"
#include "effects/catalogue.h"
#include "fit/forecasts.h"
#include "support/synthetic.h"

namespace hapsim {
namespace {

struct Material {
  double power = 1;                              // of the depth
  double rest = 1;                               // share of the force that stays
  std::vector<std::pair<double, double>> terms;  // share, time [s]
  double damping = 0;                            // [N s/m]
  double noise = 0.01;                           // [N]
  double memory = 0;                             // of the noise, from sample to sample
};

// Down to 6 mm in 2 s, held to 20 s; 5 N at the deepest without relaxation. Maxwell elements in
// closed form for a force that rises linearly between the samples.
Recording press(const Material& m, std::uint64_t seed) {
  constexpr double kStep = 0.05, kDepth = 0.006, kRise = 2, kForce = 5;
  Recording r;
  r.name = "closed form";
  r.metadata.set("tool_radius", "0.004");
  Random random(seed);
  std::vector<double> element(m.terms.size(), 0);
  double before = 0, wander = 0;
  for (int i = 0; i <= 400; ++i) {
    const double t = kStep * i, depth = kDepth * std::min(1.0, t / kRise);
    const double now = kForce * std::pow(depth / kDepth, m.power);
    double force = m.rest * now + (t < kRise ? m.damping * kDepth / kRise : 0);
    for (std::size_t k = 0; k < element.size(); ++k) {
      const auto [share, tau] = m.terms[k];
      const double fades = std::exp(-kStep / tau);
      element[k] = fades * element[k] + share * (now - before) * tau / kStep * (1 - fades);
      force += element[k];
    }
    before = now;
    wander = m.memory * wander + std::sqrt(1 - m.memory * m.memory) * random.normal();
    r.line.push_back(i + 2);
    r.press.push_back(1);
    r.t.push_back(t);
    r.position.emplace_back(0.04, 0.04, 0.04);
    r.u.emplace_back(0, 0, -depth);
    r.f.emplace_back(0, 0, force + m.noise * wander);
  }
  return r;
}

Experiment experiment(const Material& m, std::uint64_t seed) {
  ExperimentOptions options;
  options.rim_edge = 0.3;
  options.noise = m.noise;
  options.floor = 0.01;
  return make_experiment(test::block_mesh({0.08, 0.08, 0.04}, 6, 6, 4, 1), press(m, seed), options);
}

Model start_of(const Experiment& w) {
  Model start = elastic_model(w, all_episodes(w.dataset));
  start.find("elastic", 0, "nu")->state = ParameterState::kFixed;
  return start;
}

Diagnosis diagnosed(const Material& m, std::uint64_t seed = 1) {
  const Experiment w = experiment(m, seed);
  return diagnose(start_of(w), w, w.allowance(), {});
}

std::vector<std::string> with_verdict(const Diagnosis& d, Verdict verdict) {
  std::vector<std::string> names;
  for (const Finding& f : d.findings)
    if (f.verdict == verdict) names.push_back(f.effect);
  return names;
}

bool holds(const std::vector<std::string>& names, const std::string& name) {
  return std::count(names.begin(), names.end(), name) > 0;
}

// Neither effect alone explains much: the search must not take what comes nearest by itself.
TEST(FewPresses, RelaxationAndStiffeningAreFoundTogether) {
  const Diagnosis d = diagnosed({1.5, 0.5, {{0.25, 0.5}, {0.25, 8}}});
  std::printf("%s\n", d.explanation.c_str());
  EXPECT_EQ(d.findings.front().effect, "viscoelastic");
  EXPECT_EQ(d.findings.front().verdict, Verdict::kMissing);
  std::vector<std::string> named = with_verdict(d, Verdict::kMissing);
  for (const std::string& name : with_verdict(d, Verdict::kIndistinguishable))
    named.push_back(name);
  EXPECT_TRUE(holds(named, "tip") || holds(named, "hyperelastic"));
  EXPECT_FALSE(holds(named, "sensor-drift"));
  EXPECT_LT(d.rmse_end.told(), 0.05 * d.rmse.told());
}

// At the ends of a ramp a dashpot's force comes and goes within a sample, that of the quickest
// relaxation that samples can show within a few: a small one is not told from the other by one
// press, a large one is.
TEST(FewPresses, ASmallDamperIsNotToldFromQuickRelaxation) {
  const Diagnosis small = diagnosed({1, 1, {}, 20});
  std::printf("%s\n", small.explanation.c_str());
  EXPECT_EQ(small.verdict, ModelVerdict::kAmbiguous);
  const auto rivals = with_verdict(small, Verdict::kIndistinguishable);
  EXPECT_TRUE(holds(rivals, "damper"));
  EXPECT_TRUE(holds(rivals, "viscoelastic"));
  const Diagnosis large = diagnosed({1, 1, {}, 60});
  std::printf("%s\n", large.explanation.c_str());
  EXPECT_EQ(with_verdict(large, Verdict::kMissing), std::vector<std::string>{"damper"});
}

TEST(FewPresses, NothingIsFoundInNothing) {
  int alarms = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Diagnosis white = diagnosed({}, seed);
    const Diagnosis wanders = diagnosed({1, 1, {}, 0, 0.01, 0.9}, seed);
    for (const Diagnosis* d : {&white, &wanders})
      alarms += !with_verdict(*d, Verdict::kMissing).empty() ||
                !with_verdict(*d, Verdict::kIndistinguishable).empty();
  }
  std::printf("%d false alarms in 20 presses\n", alarms);
  EXPECT_LE(alarms, 1);
}

// What fits all rows may start from all rows: what foretells may not. The rest of the press is
// changed and changes no forecast.
TEST(Forecasts, KnowNothingOfWhatTheyForetell) {
  const Experiment w = experiment({1.5, 0.5, {{0.25, 0.5}, {0.25, 8}}}, 1);
  std::vector<UnseenPart> parts = rests_of_presses(w);
  ASSERT_EQ(parts.size(), 5u);  // one of the way in, four of the hold
  const std::size_t which = 3;
  Experiment other = w;
  for (const Eigen::Index row : parts[which].rows)
    other.dataset.recording.f[w.dataset.episodes[0].rows[static_cast<std::size_t>(row)]] *= 2;
  const TrialGround ground(w, w.allowance()), changed(other, other.allowance());
  const FitOptions options = trial_fit_options(ground);
  const Forecasts::Names names{"hyperelastic", "viscoelastic"};
  Forecasts one(make_baseline(start_of(w), ground, {}).fitted, w, {parts[which]}, options);
  Forecasts two(make_baseline(start_of(w), changed, {}).fitted, other,
                {rests_of_presses(other)[which]}, options);
  const Eigen::VectorXd a = one.left(names).front(), b = two.left(names).front();
  for (std::size_t i = 0; i < parts[which].rows.size(); ++i) {
    const int row = w.dataset.episodes[0].rows[static_cast<std::size_t>(parts[which].rows[i])];
    const auto at = 3 * static_cast<Eigen::Index>(i);
    const Vec3 told = w.dataset.recording.f[row] - a.segment<3>(at);
    const Vec3 told_after = other.dataset.recording.f[row] - b.segment<3>(at);
    EXPECT_LT((told - told_after).norm(), 1e-6 * told.norm());
  }
}

// A residual with a structure that no effect has: a force that swings. A drift and other companions
// take much of it away in the fit and foretell nothing.
TEST(FewPresses, AStructuredResidualTemptsNoCompanion) {
  int companions = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Experiment w = experiment({1, 0.6, {{0.4, 1}}}, seed);
    Dataset& dataset = w.dataset;
    for (std::size_t i = 0; i < dataset.rows(); ++i)
      dataset.recording.f[i].z() +=
          0.06 * std::sin(2 * M_PI *
                          (dataset.recording.t[i] / (9 + static_cast<double>(seed)) +
                           0.25 * static_cast<double>(seed)));
    const Diagnosis d = diagnose(start_of(w), w, w.allowance(), {});
    std::vector<std::string> named = with_verdict(d, Verdict::kMissing);
    EXPECT_TRUE(holds(named, "viscoelastic"));
    companions += std::any_of(named.begin(), named.end(),
                              [](const std::string& name) { return name != "viscoelastic"; });
    std::printf("%s\n", d.explanation.c_str());
  }
  std::printf("%d of 4 with a companion\n", companions);
  EXPECT_EQ(companions, 0);
}

TEST(FewPresses, TheRestOfThePressIsTheUnseenError) {
  const Experiment w = experiment({1, 0.6, {{0.4, 1}}}, 1);
  const Diagnosis d = diagnose(start_of(w), w, w.allowance(), {});
  EXPECT_EQ(d.held_out_by, "rest of each press");
  EXPECT_GT(d.held_out.told(), 0.2);
  EXPECT_LT(d.held_out_end.told(), 0.02);
  EXPECT_LT(d.findings.front().held_out_after.told(), 0.02);
  ImproveOptions options;
  options.fit.noise = w.noise.value;
  options.fit.floor = w.floor;
  const Improvement improved = improve(start_of(w), w, w, options);
  EXPECT_EQ(improved.unseen, "rest of each press");
  ASSERT_EQ(improved.steps.size(), 2u);
  EXPECT_EQ(improved.steps.back().added, "viscoelastic");
  EXPECT_LT(improved.steps.back().held_out.told(), 0.1 * improved.steps.front().held_out.told());
}

// Of several, whole presses are left out as well, and both have to be foretold.
TEST(FewPresses, OfThreePressesWholeOnesAreLeftOutToo) {
  const Material m{1, 0.6, {{0.4, 1}}};
  Recording three = press(m, 1);
  for (int k = 2; k <= 3; ++k) {
    const Recording more = press(m, static_cast<std::uint64_t>(k));
    for (std::size_t i = 0; i < more.t.size(); ++i) {
      three.line.push_back(static_cast<long>(three.line.size()) + 2);
      three.press.push_back(k);
      three.t.push_back(more.t[i] + 100 * k);
      three.position.push_back(more.position[i]);
      three.u.push_back(more.u[i]);
      three.f.push_back(more.f[i]);
    }
  }
  ExperimentOptions options;
  options.rim_edge = 0.3;
  options.noise = m.noise;
  options.floor = 0.01;
  const Experiment w =
      make_experiment(test::block_mesh({0.08, 0.08, 0.04}, 6, 6, 4, 1), three, options);
  EXPECT_EQ(presses_left_out(w, 6).size(), 3u);
  const Diagnosis d = diagnose(start_of(w), w, w.allowance(), {});
  EXPECT_EQ(d.held_out_by, "rest of each press and presses");
  EXPECT_EQ(with_verdict(d, Verdict::kMissing), std::vector<std::string>{"viscoelastic"});
  EXPECT_LT(d.held_out_end.told(), 0.02);
}

// A law of the depth that no effect has: no cause is named, and the curve that foretells is added.
TEST(FewPresses, WhatHasNoNameIsAddedAsACurveThatForetells) {
  constexpr double kMost = 0.006, kStiffness = 900;
  Recording r;
  r.name = "wavy";
  r.metadata.set("tool_radius", "0.004");
  Random random(3);
  for (int press = 0; press < 4; ++press)
    for (int i = 0; i <= 60; ++i) {
      const double depth = kMost * i / 60;
      const double share = 1 + 0.4 * std::sin(6.2831853 * depth / kMost);
      r.line.push_back(static_cast<long>(r.line.size()) + 2);
      r.press.push_back(press);
      r.t.push_back(100 * press + 0.05 * (1 + press) * i);
      r.position.emplace_back(0.04, 0.04, 0.04);
      r.u.emplace_back(0, 0, -depth);
      r.f.emplace_back(0.01 * random.normal(), 0.01 * random.normal(),
                       kStiffness * depth * share + 0.01 * random.normal());
    }
  ExperimentOptions options;
  options.rim_edge = 0.3;
  options.noise = 0.01;
  options.floor = 0.01;
  const Experiment w =
      make_experiment(test::block_mesh({0.08, 0.08, 0.04}, 6, 6, 4, 1), r, options);
  ImproveOptions improvement;
  improvement.fit.noise = w.noise.value;
  improvement.fit.floor = w.floor;
  const Improvement improved = improve(start_of(w), w, w, improvement);
  ASSERT_GE(improved.steps.size(), 2u) << improved.last.explanation;
  EXPECT_EQ(improved.steps[1].added, "learned-depth");
  EXPECT_LT(improved.steps[1].held_out.told(), 0.7 * improved.steps[0].held_out.told());
}

// A machine that loads at a steady rate makes any force run straight in time: no drift of the
// sensor is told from that, whatever the body does that the model does not.
TEST(FewPresses, TheRateOfLoadingIsNoDrift) {
  constexpr double kDepth = 0.006, kForce = 5, kLast = 20;
  Recording r = press({}, 1);
  Random random(2);
  for (std::size_t i = 0; i < r.t.size(); ++i) {
    const double force = kForce * r.t[i] / kLast;
    r.u[i].z() = -kDepth * std::pow(force / kForce, 1 / 1.6);
    r.f[i].z() = force + 0.01 * random.normal();
  }
  ExperimentOptions options;
  options.rim_edge = 0.3;
  options.noise = 0.01;
  options.floor = 0.01;
  const TetMesh body = test::block_mesh({0.08, 0.08, 0.04}, 6, 6, 4, 1);
  const Experiment w = make_experiment(body, r, options);
  const Diagnosis d = diagnose(start_of(w), w, w.allowance(), {});
  EXPECT_TRUE(holds(with_verdict(d, Verdict::kNotTestable), "sensor-drift")) << d.explanation;
  // With air before it there is a sensor to be seen without the body.
  for (std::size_t i = 0; i < r.t.size() / 4; ++i) {
    r.u[i] = {0, 0, 0.001};
    r.f[i] = {0, 0, 0.01 * random.normal()};
  }
  const Experiment in_air = make_experiment(body, r, options);
  const Diagnosis tested = diagnose(start_of(in_air), in_air, in_air.allowance(), {});
  EXPECT_FALSE(holds(with_verdict(tested, Verdict::kNotTestable), "sensor-drift"));
}

// The finite elements of one set's layer are no basis for what another set's layer does.
TEST(EffectSets, AreComputedWithTheirOwnBody) {
  const Experiment w = experiment({1.2, 0.6, {{0.4, 1}}}, 1);
  const DiagnoseOptions options;
  const TrialGround ground(w, w.allowance());
  EffectSets sets(make_baseline(start_of(w), ground, {}), ground, options);
  const Effect& layer = require_effect("layer");
  const EffectSet* alone = sets.grown(*sets.find({}), layer);
  const EffectSet* beside = sets.grown(*sets.find({"viscoelastic"}), layer);
  ASSERT_TRUE(alone != nullptr && beside != nullptr);
  const Selection all = all_episodes(w.dataset);
  for (const EffectSet* set : {alone, beside, alone}) {
    const Eigen::VectorXd f = solved_forces(set->fitted.model, w, all, false).f;
    EXPECT_LT((measured_forces(w.dataset, all) - f - set->residual).norm(), 1e-9 * f.norm());
  }
}

TEST(FewPresses, SaysThatOnePressSaysNothingOfOtherPlaces) {
  const Diagnosis d = diagnosed({1, 0.6, {{0.4, 1}}});
  EXPECT_EQ(with_verdict(d, Verdict::kMissing), std::vector<std::string>{"viscoelastic"});
  EXPECT_NE(d.explanation.find("one press"), std::string::npos);
  EXPECT_TRUE(holds(with_verdict(d, Verdict::kNotTestable), "regions"));
}

}  // namespace
}  // namespace hapsim
