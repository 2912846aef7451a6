// What people ask of a fit, and what they may not.
#include "fit/fit_request.h"

#include <gtest/gtest.h>

#include "expect_error.h"
#include "support/synthetic.h"

namespace hapsim {
namespace {

TEST(FitRequest, RegionsAreANumberOrAWord) {
  EXPECT_EQ(parse_regions("3", "--regions"), 3);
  EXPECT_EQ(parse_regions("auto", "--regions"), kAutomaticRegions);
  EXPECT_EQ(parse_regions("sites", "--regions"), kEverySite);
  for (const char* text : {"0", "1.5", "-2", "10001", "many", ""})
    EXPECT_EQ(error_of([&] { parse_regions(text, "--regions"); }, ExitCode::kUsage)
                  .rfind("--regions ", 0),
              0u)
        << text;
}

TEST(FitRequest, TermsAreANumberOrChosen) {
  EXPECT_EQ(parse_terms({}, {}).count, 1);
  EXPECT_EQ(parse_terms("3", {}).count, 3);
  EXPECT_FALSE(parse_terms("3", {}).automatic);
  EXPECT_EQ(parse_terms("auto", {}).count, 5);
  EXPECT_EQ(parse_terms("auto:2", {}).count, 2);
  EXPECT_TRUE(parse_terms("auto:2", {}).automatic);
  for (const char* text : {"0", "6", "1.5", "auto:6", "auto:", "some"})
    error_of([&] { parse_terms(text, {}); }, ExitCode::kUsage);
}

TEST(FitRequest, EachWindowIsATerm) {
  const TermsRequest two = parse_terms({}, {"0.05:1", "2:30"});
  EXPECT_EQ(two.count, 2);
  EXPECT_EQ(two.windows, (TimeWindows{{0.05, 1}, {2, 30}}));
  EXPECT_EQ(parse_terms("2", {"0.05:1", "2:30"}).count, 2);
  for (const char* terms : {"1", "3", "auto"})  // contradict them
    error_of([&] { parse_terms(terms, {"0.05:1", "2:30"}); }, ExitCode::kUsage);
  for (const char* window : {"1", "1:1", "2:1", "0:1", "a:b", ":"})
    error_of([&] { parse_terms({}, {window}); }, ExitCode::kUsage);
}

TEST(FitRequest, AFixedPoissonsRatioIsTheWholeRange) {
  ExperimentOptions options;
  FitRequest request;
  request.fix = {"E=1000"};
  set_poisson_range(request, options);
  EXPECT_LT(options.nu_low, options.nu_high);
  request.fix = {"elastic.nu=0.42"};
  set_poisson_range(request, options);
  EXPECT_EQ(options.nu_low, 0.42);
  EXPECT_EQ(options.nu_high, 0.42);
}

TEST(FitRequest, EffectsAreAddedOneAfterTheOther) {
  Experiment w = test::experiment();
  test::measure(w, test::with(test::elastic(1.5e4, 0.4), "viscoelastic", {8e3, 0.4}), 0.01, 4);
  FitRequest request;
  request.fix = {"nu=0.4"};
  request.add = {"viscoelastic"};
  request.terms = parse_terms({}, {"0.1:1"});
  FitOptions options{0.01, 0, true};
  const Starts starts = build_starts(request, w, all_episodes(w.dataset), options, {});
  ASSERT_FALSE(starts.models.empty());
  for (const Model& start : starts.models) {
    EXPECT_EQ(start.find("elastic", 0, "nu")->state, ParameterState::kFixed);
    EXPECT_EQ(start.find("viscoelastic", 0, "tau1")->lower, 0.1);
    EXPECT_EQ(start.find("viscoelastic", 0, "tau1")->upper, 1);
  }
  const Fit fitted = fit_best(starts.models, w, all_episodes(w.dataset), options, starts.known);
  const ForceError unseen =
      held_out_error(request, fitted.model, w, make_folds(w.dataset, 3), options, {}).error;
  EXPECT_NEAR(unseen.pooled, 0.01, 0.001);  // the noise: nothing that positions do not share
}

TEST(FitRequest, FixedValuesOutOfBoundsAreRefusedBeforeTheFit) {
  require_within_bounds({"nu=0.45", "E", "elastic.nu=0.3", "viscoelastic.tau1=0.5", "unknown=7"});
  EXPECT_EQ(error_of([] { require_within_bounds({"nu=45"}); }, ExitCode::kUsage),
            "nu = 45 is out of bounds; give a value from 0 to 0.499");
  EXPECT_NE(error_of([] { require_within_bounds({"elastic.E=-3"}); }, ExitCode::kUsage), "");
}

TEST(FitRequest, WordsThatContradictEachOtherAreRefused) {
  AskedFit asked;
  asked.effects = {"elastic", "viscoelastic"};
  asked.fix = {"nu=0.4"};
  EXPECT_EQ(fit_request(asked).add, std::vector<std::string>{"viscoelastic"});
  asked.model = [] { return Model{}; };
  asked.effects_given = true;
  EXPECT_EQ(error_of([&] { fit_request(asked); }, ExitCode::kUsage),
            "--model and --effects exclude each other; use --model with --add");
  asked = {};
  asked.effects = {"auto"};
  EXPECT_TRUE(fit_request(asked).automatic);
  asked.diagnosed = [] { return std::vector<std::string>{}; };
  EXPECT_NE(error_of([&] { fit_request(asked); }, ExitCode::kUsage), "");
}

TEST(FitRequest, AModelIsChangedAsTheWordsSay) {
  AskedFit asked;
  asked.effects = {"elastic"};
  asked.model = [] { return test::elastic(12000, 0.3); };
  asked.add = {"viscoelastic"};
  asked.diagnosed = [] { return std::vector<std::string>{"friction"}; };
  asked.fix = {"nu=0.4"};
  const FitRequest request = fit_request(asked);
  EXPECT_EQ(request.add, (std::vector<std::string>{"viscoelastic", "friction"}));
  const Parameter* nu = request.start.find("elastic", 0, "nu");
  ASSERT_NE(nu, nullptr);
  EXPECT_EQ(nu->value, 0.4);
  EXPECT_EQ(nu->state, ParameterState::kFixed);
}

}  // namespace
}  // namespace hapsim
