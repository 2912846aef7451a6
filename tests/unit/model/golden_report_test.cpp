#include "model/golden_report.h"

#include <gtest/gtest.h>

#include <sstream>

#include "expect_error.h"
#include "io/csv.h"

namespace hapsim {
namespace {

std::vector<GoldenRow> rows() {
  std::vector<GoldenRow> all(2);
  all[0] = {"elastic", 2, "E", "Pa", 1010, 1000, 20, GoldenVerdict::kSame, ""};
  all[1] = {"", 0, "rmse", "N", NAN, 0.1, 0.01, GoldenVerdict::kGone, "rmse is gone"};
  return all;
}

TEST(GoldenReport, TolerancesAreSharesOrUnits) {
  EXPECT_EQ(parse_tolerance("2%", "--tolerance").value, 0.02);
  EXPECT_TRUE(parse_tolerance("2%", "--tolerance").relative);
  const Tolerance nu = parse_tolerance("elastic.nu=0.01", "--tolerance");
  EXPECT_EQ(nu.parameter, "elastic.nu");
  EXPECT_EQ(nu.value, 0.01);
  EXPECT_FALSE(nu.relative);
  EXPECT_EQ(parse_share("10%", "--worse"), parse_share("0.1", "--worse"));
  for (const char* text : {"", "%", "-1%", "nu=", "much"}) {
    EXPECT_EQ(error_of([&] { parse_tolerance(text, "--tolerance"); }, ExitCode::kUsage)
                  .rfind("--tolerance '", 0),
              0u);
    error_of([&] { parse_share(text, "--worse"); }, ExitCode::kUsage);
  }
}

TEST(GoldenReport, ATolerancesParameterMustBeThere) {
  EXPECT_NO_THROW(require_named({{"", 0.1}, {"E", 0.1}, {"elastic.E", 0.1}, {"rmse", 0.1}}, rows(),
                                "--tolerance"));
  EXPECT_NE(error_of(
                [] {
                  require_named({{"elastic.nu", 0.1}}, rows(), "--tolerance");
                },
                ExitCode::kUsage)
                .find("'elastic.nu'"),
            std::string::npos);
}

TEST(GoldenReport, IsATableAndCases) {
  std::ostringstream out;
  write_golden(out, rows());
  Input input = Input::from_bytes(out.str(), "t.csv");
  const CsvTable t = read_csv(input);
  const auto column = [&](const std::string& name) {
    return t.columns[static_cast<std::size_t>(t.find(name))];
  };
  EXPECT_EQ(column("value"), (std::vector<std::string>{"1010", ""}));
  EXPECT_EQ(column("verdict"), (std::vector<std::string>{"same", "gone"}));
  const std::vector<JunitCase> cases = golden_cases(rows());
  EXPECT_EQ(cases[0].name, "elastic.E[2]");
  EXPECT_EQ(cases[1].name, "rmse");
  EXPECT_EQ(cases[1].failure, "rmse is gone");
}

}  // namespace
}  // namespace hapsim
