// Names that come near a cause of another kind.
#include "diagnose/stand_ins.h"

#include <gtest/gtest.h>

#include "diagnose/diagnose.h"
#include "diagnose/left_over.h"
#include "support/synthetic.h"

namespace hapsim {
namespace {

std::string kind_of(const LeftKind& misfit, const std::vector<std::string>& effects, double named,
                    const std::vector<LeftKind>& left = {}) {
  return find_stand_ins({misfit}, effects, named, left).kind;
}

TEST(StandIns, AreBeatenByALawThatWasNotFitted) {
  EXPECT_EQ(kind_of({"rate", 0.93, true}, {"tare", "tip"}, 0.92), "rate");
  EXPECT_EQ(kind_of({"rate", 0.93, true}, {"tare", "tip"}, 0.94), "");
}

TEST(StandIns, LeaveWhatNoLawForetells) {
  EXPECT_EQ(kind_of({"rate", 0.6, true}, {"tare"}, 0.8), "rate");
  EXPECT_EQ(kind_of({"rate", 0.6, true}, {"tare"}, 0.8, {{"depth", 0.4, true}}), "rate");
  EXPECT_EQ(kind_of({"rate", 0.6, true}, {"tare"}, 0.8, {{"depth", 0.6, true}}), "");
}

TEST(StandIns, AreOfAnotherKind) {
  EXPECT_EQ(kind_of({"depth", 1, true}, {"learned-depth"}, 0.7), "");
  // A curve's second, where its own law does not do plainly better.
  EXPECT_EQ(kind_of({"reading", 0.8, true}, {"learned-depth"}, 0.7), "");
  EXPECT_EQ(kind_of({"reading", 0.9, true}, {"learned-depth"}, 0.7), "reading");
  EXPECT_EQ(kind_of({"phase", 1, true}, {"adhesion"}, 0.7), "phase");  // a name's second
  EXPECT_EQ(kind_of({"depth", 1, true}, {"adhesion", "tare"}, 0.7), "");
}

TEST(StandIns, NeedALawOfMostOfTheMisfitThatChangesWithinAPress) {
  EXPECT_EQ(kind_of({"rate", 0.45, true}, {"tare"}, 0.3), "");
  EXPECT_EQ(kind_of({kPress, 1, true}, {"tip"}, 0.7), "");
  EXPECT_EQ(kind_of({"rate", 0.9, true}, {}, 0), "");
  EXPECT_EQ(find_stand_ins({}, {"tip"}, 0.7, {}).kind, "");
}

TEST(StandIns, AreToldWithWhatTheyTake) {
  EXPECT_EQ(stand_in_words({}), "");
  EXPECT_EQ(misfit_words({}), "");
  const std::string words =
      stand_in_words(find_stand_ins({{"rate", 0.93, true}}, {"tare", "tip"}, 0.7, {}));
  for (const char* each : {"tare, tip", "70 %", "the speed"})
    EXPECT_NE(words.find(each), std::string::npos) << words;
  EXPECT_NE(misfit_words({{"rate", 0.93, true}}).find("the speed"), std::string::npos);
}

// A fifth of the force is lost while the tool moves. A curve of history comes near; it is told as
// that, and is to be added for what it foretells, but the model is as it was.
TEST(StandIns, LeaveAModelUnexplained) {
  Experiment w = test::experiment();
  test::measure_finer(w, test::elastic(1.5e4, 0.42), 0.01, 3);
  for (const Episode& e : w.dataset.episodes)
    for (std::size_t i = 1; i < e.rows.size(); ++i)
      if (e.view.u[i].norm() > e.view.u[i - 1].norm() + 1e-6)
        w.dataset.recording.f[e.rows[i]] *= 0.8;
  const Diagnosis d = diagnose(test::elastic(1.5e4, 0.42), w, w.allowance(), {});
  EXPECT_EQ(d.verdict, ModelVerdict::kUnexplained) << d.explanation;
  EXPECT_EQ(d.left.kind, "rate") << d.explanation;
  EXPECT_EQ(d.stand_ins.kind, "rate");
  EXPECT_EQ(d.rmse_end.pooled, d.rmse.pooled);
  ASSERT_FALSE(d.stand_ins.effects.empty());
  for (const Finding& f : d.findings) {
    EXPECT_NE(f.verdict, Verdict::kMissing) << f.effect;
    if (f.effect == d.stand_ins.effects.front()) {
      EXPECT_TRUE(f.doubted);
      EXPECT_LT(f.probability, 0.2);
      EXPECT_NE(d.explanation.find(f.effect), std::string::npos) << d.explanation;
    }
  }
}

}  // namespace
}  // namespace hapsim
