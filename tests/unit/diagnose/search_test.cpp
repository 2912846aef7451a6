// Which of several accounts of the same errors a search ends with.
#include "diagnose/search.h"

#include <gtest/gtest.h>

#include <set>

#include "diagnose/diagnose.h"
#include "support/synthetic.h"

namespace hapsim {
namespace {

std::set<std::string> named(const Experiment& w) {
  const Diagnosis d = diagnose(test::elastic(1.5e4, 0.42), w, w.allowance(), {});
  std::set<std::string> names;
  for (const Finding& f : d.findings)
    if (f.verdict == Verdict::kMissing) names.insert(f.effect);
  return names;
}

// An offset of the sensor and a stiffness that is less from a depth on: offsets of each press would
// follow the latter too, but foretell nothing.
TEST(Search, OneOffsetBesideALawOfTheDepthIsNoValueAPress) {
  Experiment w = test::experiment();
  test::measure_finer(w, test::elastic(1.5e4, 0.42), 0.01, 3);
  for (const Episode& e : w.dataset.episodes)
    for (std::size_t i = 0; i < e.rows.size(); ++i) {
      const double depth = std::max(e.view.u[i].norm(), 1e-9), knee = 1e-3;
      Vec3& f = w.dataset.recording.f[e.rows[i]];
      f *= depth > knee ? (knee + 0.5 * (depth - knee)) / depth : 1;
      f += Vec3(0.04, -0.03, 0.08);
    }
  const std::set<std::string> names = named(w);
  EXPECT_TRUE(names.contains("sensor-bias"));
  EXPECT_FALSE(names.contains("tare"));
}

// Offsets that differ from press to press are that.
TEST(Search, OffsetsByChanceAreAValueAPress) {
  Experiment w = test::experiment();
  test::measure_finer(w, test::elastic(1.5e4, 0.42), 0.01, 3);
  Random random(7);
  for (const Episode& e : w.dataset.episodes) {
    const Vec3 offset = 0.06 * Vec3(random.normal(), random.normal(), random.normal());
    for (const int row : e.rows) w.dataset.recording.f[row] += offset;
  }
  EXPECT_EQ(named(w), std::set<std::string>{"tare"});
}

// A support that slides sideways; without a name in doubt nothing is done.
TEST(Search, ACurveTakesThePlaceOfANameThatIsNotStoodBy) {
  Experiment w = test::experiment();
  test::measure_finer(w, test::elastic(1.5e4, 0.42), 0.01, 3);
  for (Vec3& f : w.dataset.recording.f) {
    const double side = std::hypot(f.x(), f.y());
    if (side > 0.1) f.head<2>() *= (0.1 + 0.2 * (side - 0.1)) / side;
  }
  const TrialGround ground(w, w.allowance());
  const Folds folds = make_folds(w.dataset, 6);
  const Baseline elastic = make_baseline(test::elastic(1.5e4, 0.42), ground, folds);
  for (const bool doubted : {false, true}) {
    Baseline base = elastic;
    Diagnosis d;
    Finding curve;
    curve.effect = "sensor-curve";
    curve.verdict = Verdict::kPossible;
    curve.doubted = doubted;
    d.findings.push_back(curve);
    curves_for_doubted(base, ground, folds, {}, d);
    EXPECT_EQ(base.fitted.model.has("learned-axes"), doubted);
    EXPECT_EQ(d.findings.front().effect, doubted ? "learned-axes" : "sensor-curve");
    EXPECT_EQ(d.findings.back().verdict, Verdict::kPossible);
    EXPECT_FALSE(d.findings.back().doubted);
  }
}

}  // namespace
}  // namespace hapsim
