// A law that needs a curve over the same thing beside it is no name.
#include "diagnose/beside_curves.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace hapsim
