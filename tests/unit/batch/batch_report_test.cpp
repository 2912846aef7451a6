#include "batch/batch_report.h"

#include <gtest/gtest.h>

namespace hapsim {
namespace {

class BatchReport : public ::testing::Test {
 protected:
  BatchReport() {
    batch.manifest.name = "m.csv";
    batch.manifest.rows.resize(3);
    for (std::size_t r = 0; r < 3; ++r) batch.manifest.rows[r].name = std::string(1, "abc"[r]);
    batch.chain.resize(3);
    outcomes.resize(3);
    outcomes[0].state = RecordingState::kDone;
    outcomes[0].rmse = 0.02;
    outcomes[0].modulus = "12345.678";
    outcomes[0].nu = "unknown";
    outcomes[1].state = RecordingState::kFailed;
    outcomes[1].message = "it does not converge";
    outcomes[1].command = "make b";
  }
  Batch batch;
  std::vector<RecordingOutcome> outcomes;
};

TEST_F(BatchReport, CountsWhatIsDone) {
  EXPECT_EQ(batch_verdict(outcomes), "1 of 3 recordings done, 1 failed, 1 not run");
  EXPECT_FALSE(all_done(outcomes));
  outcomes.resize(1);
  EXPECT_EQ(batch_verdict(outcomes), "1 of 1 recordings done");
  EXPECT_TRUE(all_done(outcomes));
}

TEST_F(BatchReport, OverviewPutsEachWhereItBelongs) {
  const Overview page = batch_overview(batch, outcomes, "/somewhere", "1.2");
  ASSERT_EQ(page.rows.size(), 1u);
  EXPECT_EQ(page.rows[0].name, "a");
  EXPECT_EQ(page.rows[0].modulus, "1.235e+04");
  EXPECT_EQ(page.rows[0].nu, "unknown");
  EXPECT_EQ(page.rows[0].link, "");  // no report was made
  ASSERT_EQ(page.failures.size(), 1u);
  EXPECT_EQ(page.failures[0].command, "make b");
  EXPECT_EQ(page.not_run, (std::vector<std::string>{"c"}));
  EXPECT_EQ(page.verdict, batch_verdict(outcomes));
}

TEST_F(BatchReport, CasesFailWithTheirCommand) {
  const std::vector<JunitCase> cases = batch_cases(batch, outcomes);
  ASSERT_EQ(cases.size(), 3u);
  EXPECT_EQ(cases[0].failure, "");
  EXPECT_FALSE(cases[0].skipped);
  EXPECT_EQ(cases[1].details, "it does not converge\nmake b");
  EXPECT_TRUE(cases[2].skipped);
}

}  // namespace
}  // namespace hapsim
