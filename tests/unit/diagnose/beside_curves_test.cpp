// A law that needs a curve over the same thing beside it is no name.
#include "diagnose/beside_curves.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "support/synthetic.h"

namespace hapsim {
namespace {

Finding missing(const std::string& effect) {
  Finding f;
  f.effect = effect;
  f.verdict = Verdict::kMissing;
  return f;
}

TEST(BesideCurves, OnlyTheLawOverTheSameThingIsDoubted) {
  Experiment w = test::experiment();
  Model model = test::with(test::elastic(1.5e4, 0.42), "viscoelastic", {5e3, 0.4});
  test::measure_finer(w, model, 0.01, 3);
  for (const char* name : {"sensor-drift", "learned-drift"}) {
    std::vector<double> values;
    for (const ParameterCard& p : require_effect(name).card().parameters) values.push_back(p.start);
    model = test::with(model, name, values);
  }
  const TrialGround ground(w, w.allowance());
  const Folds folds = make_folds(w.dataset, 6);
  Baseline base = make_baseline(model, ground, folds);
  Diagnosis d;
  for (const char* name : {"sensor-drift", "viscoelastic", "learned-drift"})
    d.findings.push_back(missing(name));
  d.rivals.push_back(model);  // where rivals are left nothing is doubted
  doubt_beside_curves(base, ground, folds, d);
  EXPECT_EQ(d.findings[0].verdict, Verdict::kMissing);
  d.rivals.clear();
  doubt_beside_curves(base, ground, folds, d);
  std::map<std::string, Verdict> verdicts;
  for (const Finding& f : d.findings) verdicts[f.effect] = f.verdict;
  EXPECT_EQ(verdicts["sensor-drift"], Verdict::kPossible);
  EXPECT_EQ(verdicts["viscoelastic"], Verdict::kMissing);
  EXPECT_EQ(verdicts["learned-drift"], Verdict::kMissing);
  EXPECT_EQ(d.findings.back().curve, "learned-drift");
  EXPECT_TRUE(base.fitted.model.has("viscoelastic"));
}

// What is made of `law`, found missing, where forces are changed by change(sample, depth over the
// deepest, force).
template <class Change>
Diagnosis with_curves(const std::string& law, const Model& model, const Change& change) {
  Experiment w = test::experiment();
  test::measure_finer(w, model, 0.01, 3);
  Recording& recording = w.dataset.recording;
  double deepest = 0;
  for (const Vec3& u : recording.u) deepest = std::max(deepest, u.norm());
  for (std::size_t i = 0; i < recording.f.size(); ++i)
    recording.f[i] = change(static_cast<int>(i), recording.u[i].norm() / deepest, recording.f[i]);
  const TrialGround ground(w, w.allowance());
  const Folds folds = make_folds(w.dataset, 6);
  std::vector<double> values;
  for (const ParameterCard& p : require_effect(law).card().parameters) values.push_back(p.start);
  const Model with = model.has(law) ? model : test::with(model, law, values);
  Baseline base = make_baseline(with, ground, folds);
  Diagnosis d;
  d.findings.push_back(missing(law));
  curves_for_laws(base, ground, folds, {}, d);
  for (const Finding& f : d.findings)
    EXPECT_EQ(base.fitted.model.has(f.effect), f.verdict == Verdict::kMissing) << f.effect;
  return d;
}

TEST(CurvesForLaws, TheCurveStandsWhereTheFormIsWrong) {
  const Diagnosis d =
      with_curves("hyperelastic", test::elastic(1.5e4, 0.42), [](int, double depth, const Vec3& f) {
        return Vec3((1 + 0.5 * std::sin(M_PI * depth)) * f);
      });
  ASSERT_EQ(d.findings.size(), 2);
  EXPECT_EQ(d.findings[0].effect, "learned-depth");
  EXPECT_EQ(d.findings[0].verdict, Verdict::kMissing);
  EXPECT_EQ(d.findings[1].verdict, Verdict::kPossible);
  EXPECT_EQ(d.findings[1].curve, "learned-depth");
  EXPECT_FALSE(d.findings[1].doubted);   // what it foretells the curve does
  const Finding& curve = d.findings[0];  // its own numbers, not the law's
  EXPECT_LT(curve.rmse_after.pooled, curve.rmse_now.pooled);
  EXPECT_LT(curve.held_out_after.pooled, curve.held_out_now.pooled);
  const double noise_squared = 1e-4, now = curve.rmse_now.pooled * curve.rmse_now.pooled;
  EXPECT_NEAR(curve.share,
              (now - curve.rmse_after.pooled * curve.rmse_after.pooled) / (now - noise_squared),
              1e-9);
}

// A curve that was put in the place of one effect may hold another.
TEST(CurvesForLaws, AnEffectThatTheModelHoldsNoMoreHasNoPlace) {
  Experiment w = test::experiment();
  const Model model = test::with(test::elastic(1.5e4, 0.42), "viscoelastic", {5e3, 0.4});
  test::measure_finer(w, model, 0.01, 3);
  for (std::size_t i = 0; i < w.dataset.recording.f.size(); ++i)
    w.dataset.recording.f[i] *= 1.1 + 0.1 * std::sin(1.9 * static_cast<double>(i));
  const TrialGround ground(w, w.allowance());
  const Folds folds = make_folds(w.dataset, 6);
  Baseline base = make_baseline(model, ground, folds);
  Diagnosis d;
  d.findings.push_back(missing("sensor-drift"));
  curves_for_laws(base, ground, folds, {}, d);
  ASSERT_EQ(d.findings.size(), 1);
  EXPECT_EQ(d.findings[0].verdict, Verdict::kMissing);
  EXPECT_TRUE(base.fitted.model.has("viscoelastic"));
}

TEST(CurvesForLaws, TheLawStandsWhereSomethingElseIsLeft) {
  const Diagnosis d = with_curves(
      "viscoelastic", test::with(test::elastic(1.5e4, 0.42), "viscoelastic", {5e3, 0.4}),
      [](int i, double, const Vec3& f) {
        return Vec3(f + 0.03 * std::sin(1.9 * i) * Vec3::Ones());
      });
  ASSERT_EQ(d.findings.size(), 1);
  EXPECT_EQ(d.findings[0].verdict, Verdict::kMissing);
}

}  // namespace
}  // namespace hapsim
