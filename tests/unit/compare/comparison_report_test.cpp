// What a report shows of forces whose error is known.
#include "compare/comparison_report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "compare/error_surface.h"
#include "compare/report_body.h"
#include "compare/report_tables.h"
#include "compare/wording.h"
#include "effects/catalogue.h"
#include "report/palette.h"
#include "support/shapes.h"
#include "support/synthetic.h"
#include "synthetic_recording.h"

namespace hapsim {
namespace {

struct Compared {
  Recording measured;
  std::vector<SimulatedVersion> versions;
  Comparison comparison;
};

Compared compared(int presses, double gain, double noise = 0.02) {
  const Synthetic s = synthetic(presses, 4, noise, 1, [gain](const RowState&) { return gain; });
  Compared c{s.measured, {{"first", s.measured}}, {}};
  c.versions[0].recording.f = s.simulated;
  c.comparison = compare(c.measured, c.versions[0].recording);
  return c;
}

CsvTable table(const std::string& text) {
  Input input = Input::from_bytes(text, "table.csv");
  return read_csv(input);
}

const KeyNumber* number_named(const Report& report, const std::string& label) {
  const auto found = std::find_if(report.numbers.begin(), report.numbers.end(),
                                  [&](const KeyNumber& n) { return n.label == label; });
  return found == report.numbers.end() ? nullptr : &*found;
}

// A diagnosis without one, what it asks for with one, the model's use where that is nothing.
TEST(ComparisonReport, SaysTheNextStep) {
  const Compared c = compared(12, 0.5);
  ReportExtras extras;
  const auto report = [&] {
    return comparison_report(c.measured, c.versions, c.comparison, ErrorMap{}, extras);
  };
  EXPECT_FALSE(report().next_is_command);  // of which model?
  extras.files = {{"body", "my body.ply"}, {"model", "m0.csv"}};
  EXPECT_TRUE(report().next_is_command);
  EXPECT_EQ(report().next, "hs-diagnose " + c.measured.name +
                               " --body 'my body.ply' --model m0.csv -o effects.csv");
  const auto diagnosed = [&](const std::string& rows) {
    extras.diagnoses = {{"", table("effect,verdict,next_measurement,command\n" + rows)}};
    return report();
  };
  EXPECT_EQ(diagnosed("model,incomplete,,\nregions,missing,,add it\n").next, "add it");
  EXPECT_EQ(diagnosed("model,complete,,\nregions,absent,,\n").next.rfind("hs-simulate ", 0), 0u);
  const Report open = diagnosed("model,ambiguous,,\ntip,indistinguishable,press deeper,add it\n");
  EXPECT_EQ(open.next, "to tell them apart: press deeper");
  EXPECT_FALSE(open.next_is_command);
  EXPECT_EQ(diagnosed("model,unexplained,,\n").next, "");
}

// Before and after are on one scale.
TEST(ComparisonReport, ColoursTheBodyBeforeAndAfterAlike) {
  Compared c = compared(12, 0.9);
  SimulatedVersion worse{"worse", c.versions[0].recording};
  for (Vec3& f : worse.recording.f) f *= 0.2;
  c.versions.insert(c.versions.begin(), worse);
  std::vector<double> error;
  for (const BinError& e : c.comparison.by_position().errors) error.push_back(e.rmse);
  Surface square;
  square.vertices = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  square.faces = {{0, 1, 2}, {0, 2, 3}};
  const ErrorMap map = map_error(square, c.comparison.facts.positions, error);
  const Report report = comparison_report(c.measured, c.versions, c.comparison, map, {});
  ASSERT_GE(report.body.layers.size(), 2u);
  const BodyLayer &now = report.body.layers[0], &before = report.body.layers[1];
  EXPECT_EQ(before.name, "error before");
  EXPECT_EQ(before.top, now.top);
  EXPECT_EQ(before.value.size(), report.body.vertices.size());
  EXPECT_GT(*std::max_element(before.at_position.begin(), before.at_position.end()),
            2 * *std::max_element(now.at_position.begin(), now.at_position.end()));
}

TEST(ReportBody, ScalesEndAtRoundNumbers) {
  for (const auto& [value, top] : {std::pair{1.0, 1.0},
                                   {1.01, 1.5},
                                   {0.034, 0.04},
                                   {6.1, 8.0},
                                   {8.2, 10.0},
                                   {99.0, 100.0},
                                   {0.003, 0.003}})
    EXPECT_NEAR(round_up(value), top, 1e-12 * top) << value;
}

TEST(ReportBody, ErrorsBelowTheNoiseDoNotAlarm) {
  const Compared quiet = compared(12, 1);
  EXPECT_DOUBLE_EQ(top_error(quiet.comparison), 0.04);  // twice the noise of 0.02 N
  const Compared wrong = compared(12, 0.5);
  double worst = 0;
  for (const BinError& e : wrong.comparison.by_position().errors) worst = std::max(worst, e.rmse);
  EXPECT_GE(top_error(wrong.comparison), worst);
  EXPECT_LE(top_error(wrong.comparison), 1.5 * worst * (1 + 1e-12));
}

TEST(ReportBody, ColoursByErrorAndByMissingStiffness) {
  const Compared c = compared(12, 1.25);  // the body is stiffer by a quarter
  const Surface square{{{-0.1, -0.1, 0}, {0.1, -0.1, 0}, {0.1, 0.1, 0}, {-0.1, 0.1, 0}},
                       {{0, 1, 2}, {0, 2, 3}}};
  std::vector<double> error;
  for (const BinError& e : c.comparison.by_position().errors) error.push_back(e.rmse);
  const ErrorMap map = map_error(square, c.comparison.facts.positions, error);
  Report report;
  add_body(c.comparison, map, nullptr, nullptr, report);
  ASSERT_EQ(report.body.layers.size(), 2u);
  EXPECT_EQ(report.body.layers[0].at_position, error);
  EXPECT_EQ(report.body.layers[0].mark, c.comparison.noise.value);
  for (const double stiffer : report.body.layers[1].at_position) EXPECT_NEAR(stiffer, 25, 2);
  EXPECT_EQ(report.body.layers[1].value.size(), report.body.vertices.size());
  Report bare;
  add_body(c.comparison, {}, nullptr, nullptr, bare);
  EXPECT_EQ(bare.body.layers.size(), 1u);  // positions alone, by error
}

TEST(ErrorSurface, IsGreyBeyondTheReach) {
  ErrorMap map;
  map.surface = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  map.error = {0, 0.5, 0.2};
  map.distance = {0.01, 0.1, 0.3};
  map.reach = 0.1;
  const PlyFile ply = coloured_ply(map, 0.5);
  const PlyElement& vertex = *ply.find("vertex");
  const auto colour = [&](std::size_t i) {
    return Rgb{static_cast<std::uint8_t>(vertex.find("red")->values[i]),
               static_cast<std::uint8_t>(vertex.find("green")->values[i]),
               static_cast<std::uint8_t>(vertex.find("blue")->values[i])};
  };
  EXPECT_EQ(colour(0), error_colour(0));
  EXPECT_EQ(colour(1), error_colour(1));
  EXPECT_EQ(colour(2), kUnknownColour);
  EXPECT_EQ(vertex.find("error")->values[1], 0.5);
  EXPECT_TRUE(std::isnan(vertex.find("error")->values[2]));
  EXPECT_EQ(ply.find("face")->properties[0].values, (std::vector<double>{0, 1, 2}));
}

TEST(ReportTables, HistoryKeepsTextAndRoundsFractions) {
  Report report;
  add_history(table("model,effects,rmse,free\nm0.csv,a+b,0.123456,3\nm1.csv,a,1e-5,12345\n"),
              report);
  EXPECT_EQ(report.history.columns[2], "rmse [N]");
  EXPECT_EQ(report.history.rows[0], (std::vector<std::string>{"m0.csv", "a+b", "0.1235", "3"}));
  EXPECT_EQ(report.history.rows[1][3], "12345");
  ASSERT_EQ(report.versions.size(), 2u);
  EXPECT_EQ(report.versions[1].rmse, 1e-5);
  EXPECT_TRUE(std::isnan(report.versions[1].held_out));
}

TEST(ReportTables, DiagnosisTellsChancesAndRivals) {
  Report report;
  add_diagnosis(table("rank,effect,verdict,rmse_now,rmse_after,p_value,confused_with,evidence\n"
                      "1,a,indistinguishable,0.5,0.25,0.0001,b,clear\n2,c,possible,0.5,,0.25,b,\n"),
                "m1", report);
  ASSERT_EQ(report.diagnoses.size(), 1u);
  using Facts = std::vector<std::pair<std::string, std::string>>;
  EXPECT_EQ(report.diagnoses[0].rows[0].facts, (Facts{{"error of the fit", "0.5 to 0.25 N"},
                                                      {"chance of a false alarm", "below 0.001"},
                                                      {"cannot be told from", "b"}}));
  EXPECT_EQ(report.diagnoses[0].rows[0].notes, (Facts{{"evidence", "clear"}}));
  EXPECT_EQ(report.diagnoses[0].rows[1].facts, (Facts{{"error of the fit", "0.5 N"},
                                                      {"chance of a false alarm", "0.25"},
                                                      {"alone nearly as good", "b"}}));
}

TEST(ReportTables, OnlyFittedParametersHaveAnInterval) {
  Model model;
  model.parameters = {{.effect = "a", .name = "E", .value = 100, .unit = "Pa", .std_error = 10},
                      {.effect = "a",
                       .name = "nu",
                       .value = 0.45,
                       .unit = "1",
                       .std_error = 0.1,
                       .state = ParameterState::kFixed}};
  Report report;
  add_parameters(model, report);
  EXPECT_EQ(report.parameters.rows[0], (std::vector<std::string>{"a", "0", "E", "100", "10",
                                                                 "80.4 to 119.6", "Pa", "fitted"}));
  EXPECT_EQ(report.parameters.rows[1],
            (std::vector<std::string>{"a", "0", "nu", "0.45", "", "", "", "fixed"}));
  model.parameters.assign(61, model.parameters[0]);
  Report full;
  add_parameters(model, full);
  EXPECT_EQ(full.parameters.rows.size(), 60u);
  EXPECT_NE(full.parameters.caption.find("The first 60 of 61."), std::string::npos);
}

TEST(ReportCurves, PressesAreThinnedAndTheirPeaksKept) {
  Compared c = compared(8, 1);
  Report report;
  add_presses(c.measured, c.versions, c.comparison, report);
  ASSERT_EQ(report.presses.size(), 8u);
  EXPECT_EQ(report.presses[0].t.size(), 113u);  // short enough to stay whole
  double square = 0;
  for (int i = 0; i < 113; ++i)
    square += (c.measured.f[i] - c.versions[0].recording.f[i]).squaredNorm();
  EXPECT_NEAR(report.presses[0].rmse, std::sqrt(square / (3 * 113)), 1e-15);
  EXPECT_NEAR(report.presses[0].direction.dot(c.measured.position[0].normalized()), 1, 0.01);
}

TEST(ReportCurves, ResidualsAreAlongTheNormal) {
  Compared c = compared(8, 1.5, 1e-6);
  Report report;
  add_residual_plots(c.measured, c.versions[0].recording, c.comparison, report);
  ASSERT_EQ(report.residuals.size(), 4u);
  const ResidualPlot& depth = report.residuals[0];
  EXPECT_EQ(depth.x_label, "depth [mm]");
  for (std::size_t i = 0; i < depth.x.size(); ++i)  // half of 200 N/m, 0.1 N a millimetre
    EXPECT_NEAR(depth.y[i], 0.1 * depth.x[i], 1e-4);
  c.measured.t.clear();
  Report quasi_static;
  const Comparison without_time = compare(c.measured, c.versions[0].recording);
  add_residual_plots(c.measured, c.versions[0].recording, without_time, quasi_static);
  EXPECT_EQ(quasi_static.residuals.size(), 1u);
}

TEST(ComparisonReport, IsGoodWhereOnlyNoiseIsLeft) {
  const Compared quiet = compared(12, 1), wrong = compared(12, 0.8);
  EXPECT_TRUE(only_noise_left(quiet.comparison));
  EXPECT_FALSE(only_noise_left(wrong.comparison));
  const auto report = [](const Compared& c, const ReportExtras& extras) {
    return comparison_report(c.measured, c.versions, c.comparison, {}, extras);
  };
  EXPECT_TRUE(report(quiet, {}).good);
  EXPECT_FALSE(report(wrong, {}).good);
  EXPECT_EQ(report(quiet, {}).title, "Measured and simulated forces of synthetic");
  ReportExtras extras;
  extras.title = "";
  extras.diagnoses.emplace_back(
      "m1", table("rank,effect,verdict,evidence\n0,model,complete,nothing is missing\n"));
  const Report diagnosed = report(wrong, extras);  // the diagnosis knows more than the numbers
  EXPECT_TRUE(diagnosed.good);
  EXPECT_EQ(diagnosed.title, "");
  EXPECT_NE(diagnosed.verdict.find(" The model is complete: nothing is missing"),
            std::string::npos);
  extras.diagnoses.emplace_back("m2", table("rank,effect,verdict\n0,model,incomplete\n"));
  EXPECT_FALSE(report(quiet, extras).good);  // the last one counts
}

TEST(ComparisonReport, TellsWhatTheForcesAndTheHistoryKnow) {
  Compared c = compared(12, 1);
  c.versions[0].recording.metadata.set("mesh_uncertainty", "0.02");
  ReportExtras extras;
  extras.history = table("rmse,heldout\n0.3,0.4\n0.2,\n");
  const Report report = comparison_report(c.measured, c.versions, c.comparison, {}, extras);
  EXPECT_NEAR(report.mesh_uncertainty, 0.02 * c.comparison.size.force_rms, 1e-15);
  ASSERT_NE(number_named(report, "error on unseen positions"), nullptr);
  EXPECT_EQ(number_named(report, "error on unseen positions")->value, "0.4 N");
  EXPECT_EQ(number_named(report, "recording")->value, "12 presses");
  EXPECT_NE(std::find(report.provenance.begin(), report.provenance.end(),
                      std::pair<std::string, std::string>{"measured: force_noise", "0.020000"}),
            report.provenance.end());
}

bool has_table(const Report& report, const std::string& caption) {
  return std::any_of(report.tables.begin(), report.tables.end(),
                     [&](const ReportTable& t) { return t.caption.rfind(caption, 0) == 0; });
}

TEST(ComparisonReport, ShowsHowSureADiagnosisIsAndTheFlagsOfLiveForces) {
  Compared c = compared(12, 0.5);
  ReportExtras extras;
  EXPECT_FALSE(
      has_table(comparison_report(c.measured, c.versions, c.comparison, {}, extras), "How sure"));
  extras.diagnoses = {{"", table("effect,verdict,p_value\nmodel,incomplete,\nfriction,absent,0.4\n"
                                 "regions,missing,1e-5\nlayer,possible,0.03\n")}};
  extras.flags = {{"beyond", {{1, "deep"}, {8, "elsewhere"}, {16, "fast"}}}};
  c.measured.extra_header = {"beyond"};
  c.measured.extra = {std::vector<std::string>(c.measured.rows(), "0")};
  c.measured.extra[0][3] = "9";
  c.measured.extra[0][5] = "8";
  const Report report = comparison_report(c.measured, c.versions, c.comparison, {}, extras);
  ASSERT_TRUE(has_table(report, "How sure") && has_table(report, "What the live force"));
  const ReportTable& sure = report.tables[report.tables.size() - 2];
  ASSERT_EQ(sure.rows.size(), 3u);
  EXPECT_EQ(sure.rows[0][0], "regions");
  EXPECT_EQ(sure.rows[0][2], "below 0.001");
  EXPECT_EQ(sure.rows[2][0], "friction");
  EXPECT_GT(sure.bar[0], sure.bar[1]);
  const ReportTable& flags = report.tables.back();
  ASSERT_EQ(flags.rows.size(), 2u);
  EXPECT_EQ(flags.rows[0][1], "deep");
  EXPECT_EQ(flags.rows[0][3], "1");
  EXPECT_EQ(flags.rows[1][3], "2");
  EXPECT_EQ(flags.rows[1][2], "line " + std::to_string(c.measured.line[3]));
}

// A block with a stiff ball in the middle: each cut through it shows both, and nothing outside.
TEST(ComparisonReport, CutsABodyWithABallInsideOpen) {
  const Effect& ball = require_effect("inclusion");
  Model model = test::elastic(1e4, 0.4);
  Report report;
  add_slices(test::box({0.04, 0.03, 0.02}), model, nullptr, report);
  EXPECT_TRUE(report.slices.empty());
  const std::map<std::string, double> value{
      {"x", 0.02}, {"y", 0.015}, {"z", 0.01}, {"radius", 0.006}, {"ratio", 3}};
  for (const ParameterCard& card : ball.card().parameters) {
    Parameter p = test::elastic(1, 0.4).parameters.front();
    p.effect = ball.card().name;
    p.name = card.name;
    p.value = value.count(card.name) != 0 ? value.at(card.name) : card.start;
    model.parameters.push_back(p);
  }
  add_slices(test::box({0.04, 0.03, 0.02}), model, nullptr, report);
  ASSERT_EQ(report.slices.size(), 3u);
  for (const ReportSlice& slice : report.slices) {
    const std::set<double> found(slice.modulus.begin(), slice.modulus.end());
    EXPECT_EQ(found.size(), 2u) << slice.title;  // a block fills its box
    EXPECT_EQ(*found.begin(), 1e4);
  }
}

}  // namespace
}  // namespace hapsim
