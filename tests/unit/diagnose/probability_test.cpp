// Probabilities of a set are shared by its likelihoods; what was not tested has none.
#include "diagnose/probability.h"

#include <gtest/gtest.h>

#include <cmath>

#include "diagnose/of_one_kind.h"

namespace hapsim {
namespace {

Finding finding(const std::string& effect, Verdict verdict, double gain) {
  Finding f;
  f.effect = effect;
  f.verdict = verdict;
  f.criterion_gain = gain;
  return f;
}

TEST(Probability, OfASetIsSharedByTheLikelihoods) {
  Diagnosis d;
  d.findings = {finding("layer", Verdict::kIndistinguishable, 500),
                finding("inclusion", Verdict::kIndistinguishable, 490),
                finding("tip", Verdict::kAbsent, -5), finding("slack", Verdict::kNotTestable, 0)};
  set_probabilities(d);
  const double first = d.findings[0].probability, second = d.findings[1].probability;
  EXPECT_GT(first, second);
  EXPECT_GT(second, 0.25);
  EXPECT_GT(first + second, 0.8);
  EXPECT_LT(first + second, 1);
  EXPECT_LT(d.findings[2].probability, 0.01);
  EXPECT_TRUE(std::isnan(d.findings[3].probability));
}

TEST(Probability, FallsWhereAnotherPassedBesideItAndWhereMoreIsLeft) {
  Diagnosis d;
  d.findings = {finding("layer", Verdict::kMissing, 500)};
  set_probabilities(d);
  const double alone = d.findings[0].probability;
  const Finding near = finding("inclusion", Verdict::kAbsent, 480);
  d.findings[0].share_among = share_among(d.findings[0], {&near});
  set_probabilities(d);
  const double beside = d.findings[0].probability;
  EXPECT_LT(beside, alone);
  d.left.structured = true;
  set_probabilities(d);
  EXPECT_LT(d.findings[0].probability, beside);
}

TEST(Probability, ManyOfOneKindAreNoneOfThemSure) {
  EXPECT_EQ(kind_of_many({"motion-scale", "arm-compliance", "tool-radius"}), "set-up");
  EXPECT_EQ(kind_of_many({"motion-scale", "arm-compliance", "arm-compliance"}), "");
  EXPECT_EQ(kind_of_many({"viscoelastic", "softening", "sensor-rotation"}), "");
  EXPECT_EQ(kind_of_many({"learned-kernel", "viscoelastic", "sensor-hysteresis"}), "");
  Diagnosis d;
  d.findings = {finding("motion-scale", Verdict::kMissing, 500),
                finding("temperature", Verdict::kMissing, 500)};
  d.one_kind = "set-up";
  set_probabilities(d);
  EXPECT_LT(d.findings[0].probability, 0.2);
  EXPECT_GT(d.findings[1].probability, 0.9);
}

}  // namespace
}  // namespace hapsim
