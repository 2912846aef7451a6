#include "compare/error_limit.h"

#include <gtest/gtest.h>

#include "expect_error.h"

namespace hapsim {
namespace {

// A force of 2 N rms, an error of 0.1 N, a noise of 0.05 N.
Comparison sized() {
  Comparison c;
  c.size.rmse = 0.1;
  c.size.force_rms = 2;
  c.noise.value = 0.05;
  c.breakdowns.emplace_back();
  return c;
}

double newtons_of(const std::string& text) {
  return parse_error_limit(text, "--limit").newtons_of(sized());
}

TEST(ErrorLimit, IsInNewtonsShareOrNoise) {
  EXPECT_DOUBLE_EQ(newtons_of("0.05N"), 0.05);
  EXPECT_DOUBLE_EQ(newtons_of("50 mN"), 0.05);
  EXPECT_DOUBLE_EQ(newtons_of("5%"), 0.1);
  EXPECT_DOUBLE_EQ(newtons_of("5 %"), 0.1);
  EXPECT_DOUBLE_EQ(newtons_of("1.5noise"), 0.075);
  EXPECT_DOUBLE_EQ(newtons_of("1.5xnoise"), 0.075);
}

TEST(ErrorLimit, RefusesWhatIsNoLimit) {
  for (const char* text : {"", "5", "noise", "%", "-5%", "5 m", "five N", "5%noise"})
    EXPECT_EQ(
        error_of([&] { parse_error_limit(text, "--limit"); }, ExitCode::kUsage).rfind("--limit", 0),
        0u)
        << text;
}

TEST(ErrorLimit, AnErrorAtTheLimitPasses) {
  EXPECT_EQ(excess_over(parse_error_limit("0.1N", "--limit"), sized(), "data.csv"), "");
  EXPECT_EQ(excess_over(parse_error_limit("0.099N", "--limit"), sized(), "data.csv"),
            "typical error 0.1 N exceeds 0.099 N (0.099N)");
}

TEST(ErrorLimit, UnknownNoiseIsNoJudge) {
  Comparison c = sized();
  c.noise.value = 0;
  const ErrorLimit limit = parse_error_limit("2noise", "--limit");
  EXPECT_EQ(error_of([&] { excess_over(limit, c, "data.csv"); }).rfind("data.csv: ", 0), 0u);
  EXPECT_EQ(excess_over(parse_error_limit("1N", "--limit"), c, "data.csv"), "");
}

TEST(ErrorLimit, AFailedCaseNamesTheWorstPosition) {
  Comparison c = sized();
  c.observations = {{"depth", "It grows with depth."}};
  c.breakdowns[0].grouping.bins = {{"first"}, {"second"}};
  c.breakdowns[0].errors.resize(2);
  c.breakdowns[0].errors[1].rmse = 0.2;
  const JunitCase failed = error_case(parse_error_limit("1%", "--limit"), c, "data.csv");
  EXPECT_EQ(failed.name, "data.csv below 1%");
  EXPECT_NE(failed.failure.find("; worst position second"), std::string::npos);
  EXPECT_EQ(failed.details, failed.failure + "\nIt grows with depth.");
  EXPECT_TRUE(error_case(parse_error_limit("10%", "--limit"), c, "data.csv").failure.empty());
}

}  // namespace
}  // namespace hapsim
