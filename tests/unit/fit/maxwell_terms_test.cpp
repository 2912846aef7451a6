// The number of Maxwell terms that data ask for, their order and windows, what data cannot tell.
#include "fit/maxwell_terms.h"

#include <gtest/gtest.h>

#include <cmath>

#include "expect_error.h"
#include "support/synthetic.h"

namespace hapsim {
namespace {

Model two_terms(double tau1, double tau2) {
  Model model = test::elastic(1.5e4, 0.4);
  for (const Parameter& p : effect_rows(*find_effect("viscoelastic"), 2, {5e3, tau1, 8e3, tau2}))
    model.parameters.push_back(p);
  return model;
}

TEST(Terms, AreNumberedByAscendingTime) {
  Model model = two_terms(2, 0.1);
  EXPECT_TRUE(sort_terms(model));
  EXPECT_EQ(model.find("viscoelastic", 0, "tau1")->value, 0.1);
  EXPECT_EQ(model.find("viscoelastic", 0, "E1")->value, 8e3);
  EXPECT_EQ(model.find("viscoelastic", 0, "tau2")->value, 2);
  EXPECT_FALSE(sort_terms(model));
}

TEST(Terms, WindowsBecomeBounds) {
  Model model = two_terms(0.1, 0.2);
  set_windows(model, "viscoelastic", {{0.05, 0.5}, {1, 4}});
  EXPECT_EQ(model.find("viscoelastic", 0, "tau1")->value, 0.1);
  EXPECT_EQ(model.find("viscoelastic", 0, "tau2")->value, 2);
  EXPECT_EQ(model.find("viscoelastic", 0, "tau2")->lower, 1);
  EXPECT_NE(error_of(
                [&] {
                  set_windows(model, "viscoelastic", {{0.05, 2}, {1, 4}});
                },
                ExitCode::kUsage)
                .find("overlap"),
            std::string::npos);
}

TEST(Terms, AsManyAreChosenAsTheDataHold) {
  Experiment w = test::experiment();
  const Model truth = test::with(test::elastic(1.5e4, 0.4), "viscoelastic", {8e3, 0.4});
  test::measure(w, truth, 0.01, 4);
  const TermChoice choice = choose_terms(as_it_is(test::elastic(1.5e4, 0.4), w), "viscoelastic", 3,
                                         w, all_episodes(w.dataset), {0.01, 0, true}, {});
  EXPECT_EQ(choice.terms, 1);
  EXPECT_EQ(choice.trials.size(), 2u);
  const Model& two = choice.trials[1].fit.model;
  EXPECT_GE(two.find("viscoelastic", 0, "tau2")->value,
            (1 - 1e-4) * kApart * two.find("viscoelastic", 0, "tau1")->value);
}

TEST(Terms, ATimeLongerThanThePressesIsNotIdentifiable) {
  const Experiment w = test::experiment();  // presses of 2 s
  Model model = two_terms(0.3, 10);
  for (Parameter& p : model.parameters) p.std_error = 0.01 * p.value;
  const auto said = untold_times(model, w.dataset);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_NE(said[0].find("tau2 = 10 s is not identifiable"), std::string::npos);
}

}  // namespace
}  // namespace hapsim
