// Fits under constraints between the model's parameters.
#include "fit/constraints.h"

#include <gtest/gtest.h>

#include <cmath>

#include "expect_error.h"
#include "fit/constraint_regions.h"
#include "model/model_edit.h"
#include "support/synthetic.h"

namespace hapsim {
namespace {

class Constrained : public ::testing::Test {
 protected:
  static Experiment& w() {
    static Experiment experiment = test::experiment();
    return experiment;
  }
  static FitOptions options(const std::string& constraints) {
    FitOptions result{0.01, 0, true};
    if (!constraints.empty()) result.constraints = parse_constraints({constraints}, "--constrain");
    return result;
  }
  static Fit fitted(const Model& start, const FitOptions& options) {
    return fit(start, w(), all_episodes(w().dataset), options);
  }
  static Model relaxing() {
    return test::with(test::elastic(1.5e4, 0.4), "viscoelastic", {6e3, 0.5});
  }
  static double value(const Fit& fit, const std::string& effect, const std::string& name) {
    return fit.model.find(effect, 0, name)->value;
  }
};

TEST_F(Constrained, WhatDoesNotBindChangesNothing) {
  test::measure(w(), relaxing(), 0.01, 1);
  const Fit free = fitted(relaxing(), options(""));
  const Fit kept = fitted(relaxing(), options("E >= 2*E1; tau1 <= 3 s"));
  ASSERT_EQ(kept.constraints.size(), 2u);
  EXPECT_FALSE(kept.constraints[0].active || kept.constraints[1].active);
  EXPECT_EQ(kept.unconstrained, free.error.told());
  for (std::size_t i = 0; i < free.model.parameters.size(); ++i) {
    EXPECT_EQ(kept.model.parameters[i].value, free.model.parameters[i].value);
    const double a = kept.model.parameters[i].std_error, b = free.model.parameters[i].std_error;
    EXPECT_TRUE(a == b || (std::isnan(a) && std::isnan(b)));
  }
}

// Forces are linear in both moduli: the cost by the multiplier is the rise of the error.
TEST_F(Constrained, TheCostIsTheRiseOfTheError) {
  test::measure(w(), relaxing(), 0.01, 2);
  Model start = relaxing();
  for (const char* held : {"nu", "tau1"}) set_state(start, held, ParameterState::kFixed);
  const Fit kept = fitted(start, options("elastic.E + E1 = 20 kPa"));
  ASSERT_TRUE(kept.converged) << kept.message;
  EXPECT_NEAR(value(kept, "elastic", "E") + value(kept, "viscoelastic", "E1"), 2e4, 1e-7);
  const double rise = kept.error.told() - kept.unconstrained;
  EXPECT_GT(rise, 1e-4);
  // The fit without ends within a share of the tolerance of least_squares.h.
  EXPECT_NEAR(kept.constraints[0].cost / rise, 1, 1e-3);
  EXPECT_GT(kept.constraints[0].doubt, 3);
  // What one gains the other loses.
  EXPECT_NEAR(kept.model.find("elastic", 0, "E")->std_error /
                  kept.model.find("viscoelastic", 0, "E1")->std_error,
              1, 1e-9);
}

TEST_F(Constrained, StandardErrorsCoverTheTruthThatKeepsThem) {
  const Model truth = test::with(test::elastic(1.5e4, 0.4), "viscoelastic", {7.5e3, 0.5});
  int covered = 0, counted = 0;
  double narrower = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    test::measure(w(), truth, 0.01, seed);
    const Fit kept = fitted(truth, options("E = 2*E1"));
    ASSERT_TRUE(kept.converged) << kept.message;
    if (seed == 1)
      narrower = kept.model.parameters[0].std_error /
                 fitted(truth, options("")).model.parameters[0].std_error;
    for (std::size_t i = 0; i < truth.parameters.size(); ++i) {
      const double error = kept.model.parameters[i].value - truth.parameters[i].value;
      covered += std::abs(error) < 1.96 * kept.model.parameters[i].std_error;
      ++counted;
    }
  }
  const double share = static_cast<double>(covered) / counted;
  std::printf("95 %% intervals cover the truth in %.1f %% of %d cases, E's %.2f times as wide\n",
              100 * share, counted, narrower);
  EXPECT_GT(share, 0.88);
  EXPECT_LE(share, 1.0);
  EXPECT_LT(narrower, 1);
}

TEST_F(Constrained, AnInclusionStaysWhereItIsKept) {
  const Model truth =
      test::with(test::elastic(1.5e4, 0.42), "inclusion", {0.04, 0.04, 0.025, 0.008, 4});
  test::measure(w(), truth, 0.005, 3);
  Model start = truth;
  for (const char* held : {"nu", "inclusion.x", "inclusion.y"})
    set_state(start, held, ParameterState::kFixed);
  const Fit kept = fitted(start, options("inclusion.z + inclusion.radius <= 31 mm; radius = 7 mm"));
  ASSERT_TRUE(kept.converged) << kept.message;
  EXPECT_NEAR(value(kept, "inclusion", "radius"), 7e-3, 1e-12);
  EXPECT_LE(value(kept, "inclusion", "z"), 24e-3 + 1e-9);
  // Both bind, so neither has a standard error of its own.
  EXPECT_EQ(kept.held, (std::vector<std::string>{"inclusion.z", "inclusion.radius"}));
  EXPECT_GT(kept.error.told(), kept.unconstrained);
}

TEST_F(Constrained, NamesAndSetsThatCannotBe) {
  const Model model = test::with(relaxing(), "tip", {100});
  const auto told = [&](const std::string& text) {
    return error_of([&] { require_constraints(model, options(text).constraints); },
                    ExitCode::kUsage);
  };
  EXPECT_NE(told("E2 >= E").find("the model has no parameter 'E2', of 'E2 >= E'; it has elastic.E, "
                                 "elastic.nu, viscoelastic.E1, viscoelastic.tau1, tip."),
            std::string::npos);
  EXPECT_NE(told("E1 >= 3; E >= 20 kPa; nu <= 0.3; E <= 9000")
                .find("E >= 20 kPa and E <= 9000 contradict each other"),
            std::string::npos);
  EXPECT_NE(told("nu >= 0.7").find("nu >= 0.7 and elastic.nu's upper bound"), std::string::npos);
  EXPECT_NO_THROW(require_constraints(model, options("E >= 30 kPa; E1 = E/2").constraints));
}

TEST_F(Constrained, WhatIsNotInTheModelYetIsNotAsked) {
  const auto own =
      bind_constraints(test::elastic(1e4, 0.4), options("E1 <= E; E <= 5").constraints);
  EXPECT_EQ(own.number, (std::vector<std::size_t>{1}));
}

// Two tetrahedra on one triangle, of regions 0 and 1.
TetMesh two_regions() {
  TetMesh body;
  body.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}};
  body.tets = {{0, 1, 2, 3, -1, -1, -1, -1, -1, -1}, {0, 2, 1, 4, -1, -1, -1, -1, -1, -1}};
  body.region = {0, 1};
  return body;
}

std::vector<std::string> numbered(const std::string& text, const Model& model) {
  const auto relations = parse_constraints({text}, "--constrain");
  const auto result = number_regions(relations, model, two_regions());
  EXPECT_EQ(result[0].text, relations[0].text);
  return result[0].difference.names();
}

using Names = std::vector<std::string>;

TEST(ConstraintRegions, ByNameAndByThePlaceInALabelledBody) {
  Model model = test::elastic(1e4, 0.4);
  Parameter lump = model.parameters[0];
  lump.region = 1;
  model.parameters.insert(model.parameters.begin() + 1, lump);
  model.metadata.set("region_names", "liver, tumour");
  EXPECT_EQ(numbered("E(tumour) = 3*E(liver)", model), (Names{"E[1]", "E[0]"}));
  EXPECT_EQ(numbered("E(10 cm, 0.1, 100 mm) >= E(0.1, 0.1, -0.2)", model), (Names{"E[0]", "E[1]"}));
  const BoundConstraints own = bind_constraints(
      model, number_regions(parse_constraints({"E(tumour) = 3*E(liver)"}, "--constrain"), model,
                            two_regions()));
  ASSERT_EQ(own.among.size(), 1u);
  EXPECT_EQ(own.among[0].at(Eigen::Vector3d(2, 7, 0.4)).value, 7 - 3 * 2);
  const auto told = [&](const std::string& text) {
    return error_of([&] { numbered(text, model); }, ExitCode::kUsage);
  };
  EXPECT_NE(told("E(spleen) >= E")
                .find("no region is called 'spleen', of 'E(spleen) >= E'; "
                      "regions 0, 1, ... are called liver, tumour"),
            std::string::npos);
  EXPECT_NE(told("E(2, 2, 2) >= E").find("nothing of the body is at (2,2,2)"), std::string::npos);
  EXPECT_NE(told("E(0.1, 0.1) >= E").find("needs three coordinates"), std::string::npos);
  model.metadata.remove("region_names");
  EXPECT_NE(told("E(liver) >= E").find("name regions 0, 1, ... by --region-names"),
            std::string::npos);
}

TEST(ConstraintRegions, PointsAreNoneBesideAnInclusion) {
  const Model model =
      test::with(test::elastic(1e4, 0.4), "inclusion", {0.04, 0.04, 0.025, 0.008, 4});
  EXPECT_NE(error_of([&] { numbered("E(0.1, 0.1, 0.1) >= 9", model); }, ExitCode::kUsage)
                .find("where the model has a layer or an inclusion"),
            std::string::npos);
}

TEST(ConstraintRegions, AMapDividesInPlanView) {
  Model model = test::elastic(1e4, 0.4);
  Parameter lump = model.parameters[0];
  lump.region = 1;
  model.parameters.insert(model.parameters.begin() + 1, lump);
  for (const auto& [region, x] : {std::pair(0, 0.02), std::pair(1, 0.06)})
    for (const auto& [name, value] : {std::pair("x", x), std::pair("y", 0.03)}) {
      Parameter p = model.parameters.front();
      p.effect = "regions";
      p.region = region;
      p.name = name;
      p.value = value;
      model.parameters.push_back(p);
    }
  EXPECT_EQ(numbered("E(0.02, 0.04) >= E(0.06, 0.04)", model), (Names{"E[0]", "E[1]"}));
}

TEST(ConstraintRegions, NamesAreWordsAndStandOnce) {
  EXPECT_EQ(region_names("liver, tumour_2", "--region-names"), (Names{"liver", "tumour_2"}));
  for (const char* bad : {"liver,,tumour", "2b", "a-b", "liver,liver", ""})
    EXPECT_NE(error_of([&] { region_names(bad, "--region-names"); }, ExitCode::kUsage), "");
}

}  // namespace
}  // namespace hapsim
