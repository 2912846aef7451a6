// Tables with faults: mended and said, or refused with file and line.
#include <gtest/gtest.h>

#include "synthetic.h"

namespace hapsim::test {
namespace {

std::string lines(const std::vector<RampRow>& rows,
                  const std::function<std::string(std::size_t, const RampRow&)>& write) {
  std::string text = "t_s,travel_mm,force_N\n";
  for (std::size_t i = 0; i < rows.size(); ++i) text += write(i, rows[i]);
  return text;
}

std::string plain(const RampRow& row) {
  return fmt::format("{:.4f},{:.5f},{:.5f}\n", row.t, row.travel, row.force);
}

void expect_refusal(const std::string& text, const std::string& where, const std::string& wrong,
                    const ImportOptions& options = {}, ExitCode code = ExitCode::kBadInput) {
  try {
    import_text(text, options);
    FAIL() << "not refused: " << wrong;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code) << error.what();
    EXPECT_EQ(std::string(error.what()).find(where), 0u) << error.what();
    EXPECT_NE(std::string(error.what()).find(wrong), std::string::npos) << error.what();
  }
}

TEST(ImportMalformed, RowsOutOfOrderAreSorted) {
  std::vector<RampRow> rows = ramp({});
  std::swap(rows[100], rows[103]);
  const ImportResult result =
      import_text(lines(rows, [](std::size_t, const RampRow& r) { return plain(r); }));
  EXPECT_TRUE(std::is_sorted(result.recording.t.begin(), result.recording.t.end()));
  EXPECT_EQ(result.recording.presses().size(), 1u);
  EXPECT_TRUE(mentions(result.notes.warnings, "sorted by time"));
}

TEST(ImportMalformed, RepeatedTimesAreLeftOut) {
  const ImportResult result = import_text(lines(ramp({}), [](std::size_t i, const RampRow& r) {
    return plain(r) + (i % 10 == 3 ? plain(r) : "");
  }));
  EXPECT_TRUE(mentions(result.notes.warnings, "repeat a time"));
  EXPECT_EQ(result.recording.rows(), ramp({}).size());
}

TEST(ImportMalformed, FewMissingNumbersAreLeftOut) {
  const ImportResult result = import_text(lines(ramp({}), [](std::size_t i, const RampRow& r) {
    return i % 50 == 9 ? fmt::format("{:.4f},{:.5f},NaN\n", r.t, r.travel) : plain(r);
  }));
  EXPECT_TRUE(
      mentions(result.notes.warnings, "missing numbers are left out (the first is line 11)"));
}

TEST(ImportMalformed, ManyMissingNumbersAreRefused) {
  expect_refusal(lines(ramp({}),
                       [](std::size_t i, const RampRow& r) {
                         return i % 2 ? fmt::format("{:.4f},{:.5f},\n", r.t, r.travel) : plain(r);
                       }),
                 "data.csv:3: ", "missing");
}

TEST(ImportMalformed, TextInPlaceOfNumbersIsRefused) {
  expect_refusal(lines(ramp({}),
                       [](std::size_t i, const RampRow& r) {
                         return i == 5 ? fmt::format("{:.4f},{:.5f},overload\n", r.t, r.travel)
                                       : plain(r);
                       }),
                 "data.csv: ", "'overload' (line 7)");
}

TEST(ImportMalformed, RaggedRowsAreRefusedWithTheirLines) {
  expect_refusal(lines(ramp({}),
                       [](std::size_t i, const RampRow& r) {
                         return i == 7 || i == 9 ? fmt::format("{:.4f},{:.5f}\n", r.t, r.travel)
                                                 : plain(r);
                       }),
                 "data.csv:9: ", "2 cells where the header names 3 (so are lines 11)");
}

TEST(ImportMalformed, ACutLastRowIsLeftOut) {
  const std::string text = lines(ramp({}), [](std::size_t, const RampRow& r) { return plain(r); });
  const ImportResult result = import_text(text + "29.0,9.0");
  EXPECT_TRUE(mentions(result.notes.facts, "the last row is cut"));
}

TEST(ImportMalformed, SaturatedForceIsLeftOut) {
  const ImportResult result = import_text(lines(ramp({}), [](std::size_t, const RampRow& r) {
    return fmt::format("{:.4f},{:.5f},{:.5f}\n", r.t, r.travel, std::min(r.force, 1.0));
  }));
  EXPECT_TRUE(mentions(result.notes.warnings, "sensor's limit (1 N)"));
}

TEST(ImportMalformed, NoHeaderNoNumbersNoFile) {
  expect_refusal("1,2,3\n2,3,4\n3,4,5\n", "data.csv:1: ", "no header row");
  expect_refusal("", "data.csv: ", "empty");
  expect_refusal("a,b,c\nx,y,z\n", "data.csv: ", "no table of numbers");
  expect_refusal("MATLAB 5.0 MAT-file, Platform: GLNXA64", "data.csv: ", "MATLAB");
  expect_refusal(std::string("a,b\n1,2\n\0\1\2", 12), "data.csv: ", "binary");
}

TEST(ImportMalformed, MixedDecimalMarksAreRefused) {
  expect_refusal("t;weg;kraft\n0,1;0,2;0,3\n0.2;0.3;0.4\n", "data.csv: ", "are mixed");
}

TEST(ImportMalformed, MissingQuantitiesAreNamed) {
  expect_refusal("t,travel\n0,1\n1,2\n2,3\n", "data.csv: ", "no column holds a force");
  expect_refusal("t,force\n0,1\n1,2\n2,3\n", "data.csv: ", "no column holds a depth");
}

TEST(ImportMalformed, WrongColumnsAreNamed) {
  const std::string text = lines(ramp({}), [](std::size_t, const RampRow& r) { return plain(r); });
  ImportOptions options;
  options.columns = {"force=force_n"};
  expect_refusal(text, "data.csv: --column", "did you mean 'force_N'?", options);
  options.columns = {"weight=force_N"};
  expect_refusal(text, "--column", "is no role", options, ExitCode::kUsage);
  options.columns = {"tipx=force_N"};
  expect_refusal(text, "--column", "all of its three components", options, ExitCode::kUsage);
}

TEST(ImportMalformed, MetresThatAreMillimetresAreSaid) {
  ImportOptions options;
  options.units.length = "m";
  std::string text = "t_s,travel,force_N\n";
  for (const RampRow& r : ramp({})) text += plain(r);
  EXPECT_TRUE(mentions(import_text(text, options).notes.warnings, "is the unit of length right?"));
}

}  // namespace
}  // namespace hapsim::test
