// A diagnosis as tables, JSON, words and cases.
#include "diagnose/diagnosis_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "expect_error.h"

namespace hapsim {
namespace {

const DiagnosedFiles kTableFiles{"data.csv", "body.ply", "m0.csv"};

Finding table_finding(const std::string& effect, Verdict verdict) {
  Finding f;
  f.effect = effect;
  f.verdict = verdict;
  f.rmse_now.pooled = 0.5;
  f.rmse_after.pooled = 0.25;
  f.evidence = "evidence of " + effect;
  return f;
}

Diagnosis diagnosed() {
  Diagnosis d;
  d.verdict = ModelVerdict::kIncomplete;
  d.explanation = "something is missing";
  d.findings = {
      table_finding("friction", Verdict::kMissing), table_finding("regions", Verdict::kPossible),
      table_finding("tare", Verdict::kAbsent), table_finding("temperature", Verdict::kNotTestable)};
  d.findings[0].confused_with = {"slack", "shape"};
  d.findings[0].p_value = 0.004;
  d.findings[0].values = {{"mu", "1", 0.12, 0.002, 1000}};
  d.findings[0].fitted = "mu = 0.12 ± 0.002";
  d.findings[0].smallest = {"mu", "1", 0.01, std::nan(""), 1000};
  d.findings[1].every_site = true;
  return d;
}

CsvTable written(const Diagnosis& d) {
  std::ostringstream out;
  write_diagnosis(out, d, kTableFiles, "7");
  Input input = Input::from_bytes(out.str(), "effects.csv");
  return read_csv(input);
}

TEST(DiagnosisTable, NamesTheCommandOnlyWhereTheEffectMayBeThere) {
  const CsvTable table = written(diagnosed());
  ASSERT_EQ(table.rows(), 5u);
  const auto cell = [&](const std::string& column, std::size_t row) {
    return table.columns[static_cast<std::size_t>(table.find(column))][row];
  };
  EXPECT_EQ(cell("effect", 0), "model");
  EXPECT_EQ(cell("evidence", 0), "something is missing");
  EXPECT_EQ(cell("command", 1),
            "hs-identify data.csv --body body.ply --model m0.csv --add friction -o m1.csv");
  EXPECT_NE(cell("command", 2).find("--add regions --regions sites"), std::string::npos);
  EXPECT_EQ(cell("command", 3), "");
  EXPECT_EQ(cell("confused_with", 1), "slack shape");
  EXPECT_EQ(cell("rmse_after", 1), "0.25");
  EXPECT_EQ(cell("rmse_after", 4), "");  // not tried
  EXPECT_EQ(table.metadata.find("seed"), "7");
}

TEST(DiagnosisTable, WhatIsMissingIsReadAgain) {
  Diagnosis d = diagnosed();
  EXPECT_EQ(missing_effects(written(d)), (std::vector<std::string>{"friction"}));
  d.findings[2].verdict = Verdict::kMissing;
  EXPECT_EQ(missing_effects(written(d)), (std::vector<std::string>{"friction", "tare"}));
  Input other = Input::from_bytes("a,b\n1,2\n", "other.csv");
  const CsvTable table = read_csv(other);
  EXPECT_EQ(error_of([&] { missing_effects(table); }).rfind("other.csv: this is no diagnosis", 0),
            0u);
}

TEST(DiagnosisTable, JsonHasTheSame) {
  const auto json = nlohmann::json::parse(diagnosis_json(diagnosed(), kTableFiles));
  EXPECT_EQ(json["verdict"], verdict_name(ModelVerdict::kIncomplete));
  ASSERT_EQ(json["effects"].size(), 4u);
  EXPECT_EQ(json["effects"][0]["verdict"], "missing");
  EXPECT_EQ(json["effects"][0]["confused_with"][1], "shape");
  EXPECT_DOUBLE_EQ(json["effects"][0]["rmse_after"], 0.25);
  EXPECT_DOUBLE_EQ(json["effects"][0]["p_value"], 0.004);
  EXPECT_EQ(json["effects"][0]["values"][0]["parameter"], "mu");
  EXPECT_DOUBLE_EQ(json["effects"][0]["values"][0]["value"], 0.12);
  EXPECT_DOUBLE_EQ(json["effects"][0]["smallest_seen"]["size"], 0.01);
}

TEST(DiagnosisTable, JsonOfWhatIsNotThereHasNoCommandAndNoValue) {
  Diagnosis d = diagnosed();
  d.findings[2].values = d.findings[0].values;
  const auto json = nlohmann::json::parse(diagnosis_json(d, kTableFiles))["effects"];
  EXPECT_TRUE(json[0]["command"].is_string());
  EXPECT_TRUE(json[2]["command"].is_null());
  EXPECT_TRUE(json[2]["values"].empty());
  EXPECT_TRUE(json[2]["p_value"].is_number());
  EXPECT_TRUE(json[3]["command"].is_null());
  EXPECT_TRUE(json[3]["p_value"].is_null());
  EXPECT_TRUE(json[3]["rmse_now"].is_null());
}

// An effect that is not there has no value, and no size where the fitted one lies far from nothing.
TEST(DiagnosisTable, WhatIsNotThereHasNoValueInWords) {
  Diagnosis d = diagnosed();
  Finding& absent = d.findings[2];
  absent.fitted = "mu = 0.393 ± 0.006";
  absent.values = {{"mu", "1", 0.393, 0.006, 1000}};
  absent.smallest = {"mu", "1", 0.012, std::nan(""), 1000};
  const auto line_of = [&] {
    for (const std::string& line : diagnosis_lines(d, kTableFiles))
      if (line.find("  tare ") == 0) return line;
    return std::string();
  };
  EXPECT_EQ(line_of().find("mu"), std::string::npos) << line_of();
  absent.values = {{"gx", "1", 1.01, 0.01, 1}};
  absent.smallest = {"gx", "1", 0.027, std::nan(""), 1};
  EXPECT_NE(line_of().find("would show from gx = 1 ± 0.027"), std::string::npos) << line_of();
}

TEST(DiagnosisTable, OnlyWhatIsLackingIsToBeAdded) {
  const std::vector<std::string> lines = diagnosis_lines(diagnosed(), kTableFiles);
  EXPECT_EQ(lines.front(), "incomplete: something is missing");
  const auto commands = std::count_if(lines.begin(), lines.end(), [](const std::string& l) {
    return l.find("add it: ") != std::string::npos;
  });
  EXPECT_EQ(commands, 1);
  EXPECT_NE(std::find(lines.begin(), lines.end(),
                      "  temperature   not testable: evidence of temperature"),
            lines.end());
}

TEST(DiagnosisTable, CasesFailWhereAnEffectIsLacking) {
  const std::vector<JunitCase> cases = diagnosis_cases(diagnosed());
  ASSERT_EQ(cases.size(), 5u);
  EXPECT_EQ(cases[0].failure, "incomplete: something is missing");
  EXPECT_EQ(cases[1].failure.rfind("missing: evidence of friction", 0), 0u);
  EXPECT_EQ(cases[2].failure, "");  // possible
  EXPECT_EQ(cases[3].failure, "");
  EXPECT_TRUE(cases[4].skipped);
  Diagnosis complete;
  EXPECT_EQ(diagnosis_cases(complete)[0].failure, "");
}

}  // namespace
}  // namespace hapsim
