// One press alone: what its course in time names, by data from closed forms.
#include "diagnose/few_presses.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "diagnose/diagnose.h"
#include "diagnose/effect_sets.h"
#include "effects/catalogue.h"
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
