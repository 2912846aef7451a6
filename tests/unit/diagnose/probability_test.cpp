// Probabilities of a set are shared by its likelihoods; what was not tested has none.
#include "diagnose/probability.h"

#include <gtest/gtest.h>

#include <cmath>

#include "diagnose/left_over.h"
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

TEST(Probability, SeveralAreLessSureThanOneAndThoseOfOneKindLeast) {
  EXPECT_EQ(kind_of_several({"motion-scale", "arm-compliance", "tool-radius"}).kind, "set-up");
  EXPECT_EQ(kind_of_several({"motion-scale", "arm-compliance", "arm-compliance"}).effects.size(),
            2U);
  EXPECT_EQ(kind_of_several({"viscoelastic", "softening", "sensor-rotation"}).kind, "");
  EXPECT_EQ(kind_of_several({"viscoelastic", "friction"}).kind, "");  // alike in phases, a little
  EXPECT_EQ(kind_of_several({"learned-kernel", "viscoelastic"}).kind, "");
  Diagnosis d;
  d.findings = {finding("motion-scale", Verdict::kMissing, 500),
                finding("temperature", Verdict::kMissing, 500)};
  set_probabilities(d);
  const double one_of_several = d.findings[1].probability;
  d.one_kind = {"set-up", {"motion-scale", "tool-radius"}};
  set_probabilities(d);
  EXPECT_LT(d.findings[0].probability, one_of_several);
  EXPECT_EQ(d.findings[1].probability, one_of_several);
  d.one_kind.effects.push_back("arm-compliance");
  set_probabilities(d);
  EXPECT_LT(d.findings[0].probability, 0.2);
}

// It may take what the cause leaves that the other name comes near.
TEST(Probability, BesideAValueOfEachPressOthersAreUnlikely) {
  Diagnosis d;
  d.findings = {finding("tare", Verdict::kMissing, 500), finding("tip", Verdict::kMissing, 500)};
  set_probabilities(d);
  EXPECT_GT(d.findings[0].probability, 0.7);
  EXPECT_LT(d.findings[1].probability, 0.3);
}

}  // namespace
}  // namespace hapsim
