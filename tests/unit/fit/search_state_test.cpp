// Fits that are watched, ended early and gone on with.
#include "model/search_state.h"

#include <gtest/gtest.h>

#include <cmath>

#include "effects/catalogue.h"
#include "expect_error.h"
#include "fit/fit.h"
#include "support/synthetic.h"

namespace hapsim {
namespace {

class Search : public ::testing::Test {
 protected:
  static Experiment& w() {
    static Experiment experiment = test::experiment();
    return experiment;
  }
  static Fit search(const Model& start, const FitOptions& options) {
    return fit(start, w(), all_episodes(w().dataset), options);
  }
  static Model two_terms(Model model, const std::vector<double>& values) {
    for (const Parameter& p : effect_rows(require_effect("viscoelastic"), 2, values))
      model.parameters.push_back(p);
    return model;
  }
  static Model truth() { return two_terms(test::elastic(1.5e4, 0.4), {8e3, 0.1, 5e3, 2}); }
  static Model start() { return two_terms(test::elastic(1e4, 0.3), {1e3, 1, 1e3, 3}); }
};

TEST_F(Search, TheWatchSeesTheErrorFall) {
  test::measure(w(), truth(), 0.01, 1);
  FitOptions options{0.01, 0, true};
  std::vector<double> errors;
  options.watch = [&](const FitProgress& p) {
    errors.push_back(p.rmse);
    return true;
  };
  const Fit result = search(start(), options);
  ASSERT_TRUE(result.converged) << result.message;
  ASSERT_GT(errors.size(), 2u);
  for (std::size_t i = 1; i < errors.size(); ++i) EXPECT_LE(errors[i], errors[i - 1] * (1 + 1e-9));
  EXPECT_NEAR(errors.back(), result.error.pooled, 0.05 * result.error.pooled);
}

TEST_F(Search, AnEndedFitHasTheBestSoFarAndIsNotConverged) {
  test::measure(w(), truth(), 0.01, 2);
  FitOptions options{0.01, 0, true};
  int asked = 0;
  options.watch = [&](const FitProgress&) { return ++asked < 3; };
  const Fit result = search(start(), options);
  EXPECT_TRUE(result.stopped);
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.message, "interrupted");
  const Selection all = all_episodes(w().dataset);
  const Eigen::VectorXd at_start =
      measured_forces(w().dataset, all) - solved_forces(start(), w(), all, false).f;
  EXPECT_LT(result.error.pooled, 0.9 * force_error(w().dataset, at_start).pooled);
  const Fit best = fit_best({start(), truth()}, w(), all_episodes(w().dataset), options);
  EXPECT_TRUE(best.stopped) << "of several starts as well";
}

TEST_F(Search, AResumedSearchFindsWhatAnUninterruptedOneFinds) {
  test::measure(w(), truth(), 0.01, 3);
  FitOptions options{0.01, 0, true};
  options.starts = 6;
  options.seed = 5;
  const Fit whole = search(start(), options);
  ASSERT_TRUE(whole.converged) << whole.message;
  EXPECT_EQ(whole.starts_done, 6);

  FitOptions cut = options;
  cut.watch = [](const FitProgress& p) { return p.start < 3; };
  Fit part = search(start(), cut);
  ASSERT_TRUE(part.stopped);
  EXPECT_EQ(part.starts_done, 3);
  mark_unfinished(part.model, {part.starts_done, options.starts, options.seed});
  const auto state = unfinished_search(part.model, "m.csv");
  ASSERT_TRUE(state);
  FitOptions rest = options;
  rest.starts = state->starts;
  rest.seed = state->seed;
  rest.skip = state->done;
  std::vector<int> seen;
  rest.watch = [&](const FitProgress& p) {
    if (seen.empty() || seen.back() != p.start) seen.push_back(p.start);
    return true;
  };
  const Fit resumed = search(part.model, rest);
  ASSERT_TRUE(resumed.converged) << resumed.message;
  EXPECT_NEAR(resumed.error.pooled, whole.error.pooled, 1e-4 * whole.error.pooled);
  for (const int s : seen) EXPECT_TRUE(s == 0 || s >= 3) << "start " << s << " was done";
  EXPECT_EQ(seen.back() >= 3 || seen.size() == 1, true);
}

TEST(SearchState, IsReadBackFromTheModel) {
  Model model = test::elastic(1e4, 0.4);
  EXPECT_FALSE(is_unfinished(model));
  EXPECT_FALSE(unfinished_search(model, "m.csv"));
  mark_unfinished(model, {0, 1, 1});
  EXPECT_TRUE(is_unfinished(model));
  EXPECT_FALSE(unfinished_search(model, "m.csv")) << "a single start has nothing to go on with";
  mark_unfinished(model, {7, 20, 18446744073709551615u});
  const auto state = unfinished_search(model, "m.csv");
  ASSERT_TRUE(state);
  EXPECT_EQ(state->done, 7);
  EXPECT_EQ(state->starts, 20);
  EXPECT_EQ(state->seed, 18446744073709551615u);
  for (const char* bad :
       {"7 of 20", "7 of 20 starts, seed 1 and more", "30 of 20 starts, seed 1"}) {
    model.metadata.set("search", bad);
    EXPECT_NE(error_of([&] { unfinished_search(model, "m.csv"); }).find("m.csv: its metadata"),
              std::string::npos);
  }
  unmark(model);
  EXPECT_FALSE(is_unfinished(model));
}

}  // namespace
}  // namespace hapsim
