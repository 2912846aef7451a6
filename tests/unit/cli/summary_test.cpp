// The grammar of what a tool has found.
#include "cli/summary.h"

#include <gtest/gtest.h>

#include "cli/wrap.h"

namespace hapsim {
namespace {

using Lines = std::vector<std::string>;

TEST(Summary, HasTheVerdictFirstAndTheCommandWhole) {
  Summary s;
  s.mark = Summary::Mark::kBad;
  s.verdict = "a.csv: something is missing";
  s.size = "error 0.07 N";
  s.items = {{"MISSING", "friction", "p < 0.001", {"error 0.07 -> 0.01 N"}}};
  s.notes = {"A note."};
  s.next = "hs-identify " + std::string(90, 'x');
  s.details = "All: -v";
  const Lines lines = summary_lines(s);
  EXPECT_EQ(lines, (Lines{"✗ a.csv: something is missing" + std::string(39, ' ') + "error 0.07 N",
                          "", "  MISSING  friction" + std::string(52, ' ') + "p < 0.001",
                          "           error 0.07 -> 0.01 N", "", "  A note.", "",
                          "Next:  " + s.next, "All: -v"}));
}

TEST(Summary, LongTextsAreWrappedAndTheirNumbersMoveToTheNextLine) {
  Summary s;
  s.verdict = std::string(70, 'v');
  s.size = "error 0.07 N";
  s.notes = {
      "word word word word word word word word word word word word word word word word word"};
  const Lines lines = summary_lines(s);
  ASSERT_EQ(lines.size(), 5u);
  EXPECT_EQ(lines[0], "✓ " + s.verdict);
  EXPECT_EQ(lines[1], std::string(68, ' ') + s.size);
  for (const std::string& line : lines) EXPECT_LE(columns(line), kTextWidth) << line;
}

}  // namespace
}  // namespace hapsim
