// A diagnosis on one screen: short, the verdict first, and a command that can be copied.
#include "diagnose/diagnosis_summary.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "cli/wrap.h"

namespace hapsim {
namespace {

const DiagnosedFiles kFiles{"a.csv", "body.ply", "a0.csv", "", "a0-effects.csv"};

Finding finding(const std::string& effect, Verdict verdict) {
  Finding f;
  f.effect = effect;
  f.verdict = verdict;
  f.rmse_now.pooled = 0.0731;
  f.rmse_after.pooled = 0.0108;
  f.held_out_now.pooled = 0.0799;
  f.held_out_after.pooled = 0.0157;
  f.p_value = 1e-4;
  f.evidence = "evidence";
  f.next_measurement = "press between the places";
  return f;
}

// Thirty effects, as the catalogue has them.
Diagnosis diagnosed(ModelVerdict verdict) {
  Diagnosis d;
  d.verdict = verdict;
  d.noise = 0.01;
  d.rmse.pooled = 0.0731;
  d.held_out_by = "positions";
  for (int k = 0; k < 27; ++k)
    d.findings.push_back(finding("effect-" + std::to_string(k), Verdict::kAbsent));
  d.findings.push_back(finding("temperature", Verdict::kNotTestable));
  d.findings.push_back(finding("slack", Verdict::kNotTestable));
  return d;
}

Diagnosis lacking(const std::string& effect) {
  Diagnosis d = diagnosed(ModelVerdict::kIncomplete);
  d.explanation = "missing: " + effect + ".";
  Finding f = finding(effect, Verdict::kMissing);
  f.confused_with = {"inclusion", "base"};
  f.fitted = "2 regions, E from 1.51e+04 to 2.42e+04 Pa";
  f.where = "stiffest near (2, -18) mm; softest near (-4, -17) mm; ratio 1.6";
  d.findings.insert(d.findings.begin(), f);
  return d;
}

std::string text_of(const Summary& s) {
  std::string text;
  for (const std::string& line : summary_lines(s)) text += line + "\n";
  return text;
}

bool has(const Summary& s, const std::string& part) {
  return text_of(s).find(part) != std::string::npos;
}

TEST(DiagnosisSummary, FitsOnAScreenWithVerdictCauseAndNextCommand) {
  const Summary s = diagnosis_summary(lacking("regions"), kFiles, "");
  const std::vector<std::string> lines = summary_lines(s);
  EXPECT_LE(lines.size(), 20u) << text_of(s);
  for (const std::string& line : lines)
    if (line.rfind("Next:", 0) != 0) {
      EXPECT_LE(columns(line), kTextWidth) << line;
    }
  EXPECT_EQ(lines.front().rfind("✗ a.csv: incomplete", 0), 0u) << text_of(s);
  EXPECT_TRUE(lines.front().ends_with("error 0.0731 N = 7.3 x noise"));
  EXPECT_TRUE(has(s, "  MISSING  regions")) << text_of(s);
  EXPECT_TRUE(has(s, "false alarm p < 0.001"));
  EXPECT_TRUE(has(s, "error 0.0731 -> 0.0108 N; unseen positions 0.0799 -> 0.0157 N"));
  EXPECT_TRUE(has(s, "could also be inclusion, base; to tell: press between the places"));
  EXPECT_TRUE(has(s, "27 effects tested and not needed; 2 not testable: temperature, slack"));
  EXPECT_TRUE(has(s,
                  "Next:  hs-identify a.csv --body body.ply --model a0.csv --add regions -o "
                  "a1.csv\n"));
  EXPECT_TRUE(has(s, "All effects: -v, or a0-effects.csv"));
  EXPECT_FALSE(has(s, "effect-3"));
  EXPECT_FALSE(has(s, "missing: regions"));  // said once
}

TEST(DiagnosisSummary, SeveralMissingEffectsAreAddedByOneCommand) {
  Diagnosis d = lacking("friction");
  d.findings.insert(d.findings.begin() + 1, finding("viscoelastic", Verdict::kMissing));
  d.explanation = "missing: friction, then viscoelastic. After that 0.02 N is left.";
  DiagnosedFiles files = kFiles;
  files.recording = "my data.csv";
  files.flags = " --noise 0.02";
  const Summary s = diagnosis_summary(d, files, "");
  EXPECT_TRUE(has(s,
                  "Next:  hs-identify 'my data.csv' --body body.ply --model a0.csv --noise 0.02 "
                  "--add friction,viscoelastic -o a1.csv\n"))
      << text_of(s);
  EXPECT_TRUE(has(s, "  After that 0.02 N is left."));
  EXPECT_LE(summary_lines(s).size(), 22u);
}

TEST(DiagnosisSummary, EachVerdictHasItsNextStep) {
  const Summary good = diagnosis_summary(diagnosed(ModelVerdict::kComplete), kFiles, "");
  EXPECT_EQ(good.mark, Summary::Mark::kGood);
  EXPECT_EQ(good.next.rfind("hs-simulate a.csv --body body.ply --model a0.csv", 0), 0u);
  const Summary lost = diagnosis_summary(diagnosed(ModelVerdict::kUnexplained), kFiles, "");
  EXPECT_EQ(lost.mark, Summary::Mark::kBad);
  EXPECT_NE(lost.next.find("--html report.html"), std::string::npos);
  Diagnosis d = diagnosed(ModelVerdict::kAmbiguous);
  d.findings.insert(d.findings.begin(), finding("tip", Verdict::kIndistinguishable));
  d.findings.front().confused_with = {"layer"};
  const Summary open = diagnosis_summary(d, kFiles, "");
  EXPECT_EQ(open.mark, Summary::Mark::kOpen);
  EXPECT_NE(open.next.find("--plan next.csv"), std::string::npos);
  EXPECT_NE(diagnosis_summary(d, kFiles, "more.csv").next.find("more.csv"), std::string::npos);
  EXPECT_TRUE(has(open, "  ONE OF   tip"));
  d.findings.front().confused_with = {"shape"};
  EXPECT_EQ(diagnosis_summary(d, kFiles, "").next.rfind("scan the body again", 0), 0u);
}

}  // namespace
}  // namespace hapsim
