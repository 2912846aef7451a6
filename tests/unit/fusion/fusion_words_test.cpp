#include "fusion/fusion_words.h"

#include <gtest/gtest.h>

#include "expect_error.h"

namespace hapsim {
namespace {

TEST(FusionWords, SayWhetherTheFilterKnowsItsError) {
  FusionReport report;
  report.observations = report.judged = 100;
  report.refused = 3;
  report.nis = 300;  // one per component, as it should be
  report.within = 95;
  EXPECT_EQ(fusion_words(report).rfind("100 slow forces taken, 3 refused; NIS 1, within", 0), 0u)
      << fusion_words(report);
  EXPECT_NE(fusion_words(report).find("95.0 % of them single"), std::string::npos);
  report.nis = 900;
  EXPECT_NE(fusion_words(report).find("NIS 3, outside"), std::string::npos);
}

TEST(FusionWords, AllThatCouldBeGivenOutIsCompared) {
  Recording fast;
  fast.press = {1, 1, 1};
  fast.t = {0, 0.001, 0.002};
  fast.u.assign(3, Vec3(0, 0, -0.001));
  fast.position.assign(3, Vec3::Zero());
  Recording exact = fast;
  exact.f.assign(3, Vec3(1, 1, 1));
  fast.f.assign(3, Vec3(1.5, 1.5, 1.5));
  FusedForces fused;
  fused.force = exact.f;
  fused.held.assign(3, Vec3::Zero());
  fused.extrapolated = fused.held;
  const std::vector<std::string> lines = quality_lines(fast, fused, exact);
  ASSERT_EQ(lines.size(), 5u);
  EXPECT_NE(lines[0].find("error   0.0000 N =   0.00 % of the force"), std::string::npos)
      << lines[0];
  EXPECT_NE(lines[1].find("error   0.5000 N =  50.00 % of the force"), std::string::npos)
      << lines[1];
  EXPECT_NE(lines[2].find("= 100.00 %"), std::string::npos) << lines[2];
  exact.press.pop_back();
  exact.name = "exact.csv";
  error_of([&] { quality_lines(fast, fused, exact); });
}

}  // namespace
}  // namespace hapsim
