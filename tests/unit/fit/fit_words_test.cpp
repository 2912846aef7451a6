// What is told of a fit, and what is written down of it.
#include "fit/fit_words.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "expect_error.h"
#include "fit/fit_record.h"
#include "fit/testable.h"
#include "support/synthetic.h"
#include "support/told.h"

namespace hapsim {
namespace {

using test::tells;

TEST(FitWords, HardlyKnownIsHalfTheValueOrRange) {
  Model model = test::elastic(1e4, 0.4);
  model.parameters[0].std_error = 4.9e3;
  model.parameters[1].std_error = 0.24;
  EXPECT_TRUE(hardly_known(model).empty());
  model.parameters[0].std_error = 5.1e3;
  model.parameters[1].std_error = 0.26;
  EXPECT_EQ(hardly_known(model), (std::vector<std::string>{"elastic E", "elastic nu"}));
  for (Parameter& p : model.parameters) p.state = ParameterState::kFixed;
  EXPECT_TRUE(hardly_known(model).empty());
}

TEST(FitWords, TellErrorsAgainstForceAndNoise) {
  const Experiment w = test::experiment();  // noise 0.01 N
  Fit fitted;
  fitted.model = test::elastic(1e4, 0.4);
  fitted.model.parameters[0].std_error = 100;
  fitted.error.pooled = 0.02;
  fitted.residuals = 1000;
  fitted.undetermined = {"a", "b", "c", "d", "e", "f"};
  const Summary summary = fit_summary(w, fitted, 0.03, "positions", 0.5);
  EXPECT_EQ(summary.mark, Summary::Mark::kOpen);
  EXPECT_TRUE(tells(summary, "elastic fits; more than noise is left error 0.02 N = 2 x noise"))
      << test::told(summary);
  EXPECT_TRUE(tells(
      summary,
      "ERROR 4 % of the force's rms on positions not seen by the fit 0.03 N = 6 %, 3 x noise"));
  EXPECT_TRUE(tells(summary, "VALUES elastic E = 1e+04 Pa ± 1e+02, nu = 0.4 ± not estimated"));
  EXPECT_TRUE(tells(summary, "DATA 18 presses at 6 positions, 738 samples; noise 0.01 N"));
  EXPECT_TRUE(tells(summary, "d is not determined"));
  EXPECT_FALSE(tells(summary, "e is not determined"));
  EXPECT_TRUE(tells(summary, "... and 2 more"));
  EXPECT_FALSE(tells(summary, "fewer than ten force components"));
  fitted.residuals = 19;
  EXPECT_TRUE(tells(fit_summary(w, fitted, 0.03, "", 0.5), "fewer than ten force components"));
  EXPECT_FALSE(tells(fit_summary(w, fitted, 0.03, "", 0.5), "not seen by the fit"));
  fitted.error.pooled = 0.011;
  EXPECT_EQ(fit_summary(w, fitted, 0.03, "", 0.5).mark, Summary::Mark::kGood);
}

TEST(FitWords, ProgramsGetTheNumbers) {
  const Experiment w = test::experiment();
  Fit fitted;
  fitted.model = test::elastic(1e4, 0.4);
  fitted.model.parameters[0].std_error = 100;
  fitted.error.pooled = 0.02;
  fitted.residuals = 1000;
  const auto json = nlohmann::json::parse(
      summary_json(fit_summary(w, fitted, std::nan(""), "positions", 0.5), "hs-identify"));
  EXPECT_EQ(json["tool"], "hs-identify");
  EXPECT_EQ(json["mark"], "open");
  EXPECT_DOUBLE_EQ(json["values"]["elastic.E"]["value"], 1e4);
  EXPECT_DOUBLE_EQ(json["values"]["elastic.E"]["std_error"], 100);
  EXPECT_FALSE(json["values"]["elastic.nu"].contains("std_error"));
  EXPECT_TRUE(json["values"]["heldout"]["value"].is_null());
  EXPECT_EQ(json["values"]["error"]["unit"], "N");
}

TEST(FitWords, BoundariesAreToldInMillimetres) {
  Fit before;
  before.error.pooled = 0.05;
  BoundaryFit refined;
  EXPECT_EQ(boundary_words(refined, before).rfind("the boundaries stay", 0), 0u);
  refined.better = true;
  refined.moved = {0.003, 0.004};
  refined.error = {0.001, 0.0005};
  EXPECT_EQ(boundary_words(refined, before),
            "boundaries moved by 3.5 mm (rms), at most 4 mm; error 0.05 N before; their points are "
            "known to 0.5 to 1 mm");
}

TEST(FitWords, TermsAndWhatComesLater) {
  TermChoice choice;
  choice.terms = 1;
  choice.trials.resize(2);
  for (int k = 0; k < 2; ++k) choice.trials[k].terms = k + 1;
  choice.trials[0].fit.error.pooled = 0.5;
  choice.trials[1].fit.error.pooled = 0.25;
  choice.trials[1].held_out.pooled = 0.75;
  EXPECT_EQ(choice_words(choice, "damper"),
            "1 term of damper chosen (1: error 0.5 N; 2: error 0.25 N, unseen 0.75 N)");
  EXPECT_EQ(later_words({0.02, 0.05, 40}, 1.5),
            "after 1.5 s, not seen by the fit: 40 samples, error 0.02 N, median 5 % of the peak of "
            "the press");
}

TEST(FitRecord, ForgetsWhatWasKnownOfTheStart) {
  const Experiment w = test::experiment();
  Metadata start;
  for (const auto& [key, value] : {std::pair{"heldout", "1"},
                                   {"until", "2"},
                                   {"unseen_band", "0.01"},
                                   {"unseen_chance", "0.95"},
                                   {"note", "kept"},
                                   {"converged", "no"},
                                   {"rmse", "9"}})
    start.set(key, value);
  Fit fitted;
  fitted.model = test::elastic(1e4, 0.4);
  fitted.error.pooled = 0.02;
  record_fit(fitted, start, w);
  const Metadata& metadata = fitted.model.metadata;
  EXPECT_EQ(metadata.find("rmse"), "0.02");
  EXPECT_EQ(metadata.find("force_noise"), "0.01");
  EXPECT_EQ(metadata.find("tool_radius"), "0.004");
  EXPECT_EQ(metadata.find("note"), "kept");
  for (const char* key : {"heldout", "until", "unseen_band", "unseen_chance", "converged"})
    EXPECT_FALSE(metadata.find(key)) << key;
  const HistoryRow row = history_row("m.csv", fitted, 0.03, "positions", 0.01, 0.5);
  EXPECT_EQ(row.effects, "elastic");
  EXPECT_EQ(row.parameters, 2);
  EXPECT_EQ(row.held_out_by, "positions");
  EXPECT_EQ(row.rmse, 0.02);
}

TEST(RequireShared, OneBodysParametersAreNotThoseOfSeveral) {
  Recording twice = test::presses();
  std::vector<hapsim::Setup> setups(twice.rows(), {0, 0.004});
  for (std::size_t i = twice.rows() / 2; i < twice.rows(); ++i) setups[i].body = 1;
  const Dataset one = make_dataset(twice), two = make_dataset(twice, setups);
  EXPECT_NO_THROW(require_shared({"elastic", "shift"}, one));
  EXPECT_NO_THROW(require_shared({"elastic"}, two));
  EXPECT_EQ(error_of(
                [&] {
                  require_shared({"elastic", "shift"}, two);
                },
                ExitCode::kUsage)
                .rfind("shift cannot be shared", 0),
            0u);
}

}  // namespace
}  // namespace hapsim
