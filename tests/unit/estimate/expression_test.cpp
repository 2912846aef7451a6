#include "estimate/expression.h"

#include <gtest/gtest.h>

#include "base/random.h"
#include "expect_error.h"

using namespace hapsim;

namespace {

std::vector<Relation> parsed(const std::string& text) {
  return parse_relations(text, "--constrain");
}

Taylor difference(const std::string& text, const std::vector<double>& values) {
  const Eigen::Map<const Eigen::VectorXd> x(values.data(),
                                            static_cast<Eigen::Index>(values.size()));
  return parsed(text).at(0).difference.at(x);
}

}  // namespace

TEST(Expression, CountsAsPeopleDo) {
  EXPECT_DOUBLE_EQ(difference("a = 1 + 2*3 - 4/8", {0}).value, -6.5);
  EXPECT_DOUBLE_EQ(difference("a = -2^2", {0}).value, 4);
  EXPECT_DOUBLE_EQ(difference("a = 2^3^2", {0}).value, -512);
  EXPECT_DOUBLE_EQ(difference("a = 2^-1", {0}).value, -0.5);
  EXPECT_DOUBLE_EQ(difference("a = (1 + 2)*3 - 10 - 2", {0}).value, 3);
  EXPECT_DOUBLE_EQ(difference("a = 8/4/2", {0}).value, -1);
  EXPECT_DOUBLE_EQ(difference("a >= b", {3, 1}).value, 2);
  EXPECT_DOUBLE_EQ(difference("a <= b", {3, 1}).value, 2) << "b - a, names in their order: b, a";
}

TEST(Expression, TakesUnits) {
  EXPECT_DOUBLE_EQ(difference("E <= 50 kPa", {20e3}).value, 30e3);
  EXPECT_DOUBLE_EQ(difference("z <= -5mm", {-0.01}).value, 0.005);
  EXPECT_DOUBLE_EQ(difference("tau = 2e3ms", {2}).value, 0);
}

TEST(Expression, ReadsNamesWithOwnersAndRegions) {
  EXPECT_EQ(parsed("E[2] >= E(1)*2")[0].difference.names(),
            (std::vector<std::string>{"E[2]", "E[1]"}));
  EXPECT_EQ(parsed("sensor-gain.gx = elastic.E[3] - E")[0].difference.names(),
            (std::vector<std::string>{"sensor-gain.gx", "elastic.E[3]", "E"}));
  EXPECT_EQ(parsed("E-E1 >= 0")[0].difference.names(), (std::vector<std::string>{"E", "E1"}));
}

TEST(Expression, ReadsChainsAndLists) {
  const auto all = parsed("1 <= E/E1 < 3; nu == 0.4\n E>2*E1");
  ASSERT_EQ(all.size(), 4u);
  EXPECT_EQ(all[0].text, "1 <= E/E1");
  EXPECT_EQ(all[1].text, "E/E1 <= 3");
  EXPECT_EQ(all[2].text, "nu = 0.4");
  EXPECT_EQ(all[3].text, "E >= 2*E1");
  EXPECT_FALSE(all[1].equality);
  EXPECT_TRUE(all[2].equality);
}

TEST(Expression, DerivativesAreThoseOfDifferences) {
  Random random(3);
  for (const char* text :
       {"a*b - c/a >= 1", "a^2 + b^3*c = 2", "(a + b)^c >= a^0.5", "a/(b + c) - b/a <= c*a*b",
        "-(a - 2*b)^3/c = a^-2", "1/a/b/c >= (a*b*c)^(1/3)", "2^a*b^c >= c", "a^b^c <= 3"}) {
    const Expression f = parsed(text)[0].difference;
    const auto n = static_cast<Eigen::Index>(f.names().size());
    for (int k = 0; k < 5; ++k) {
      Eigen::VectorXd x(n);
      for (Eigen::Index i = 0; i < n; ++i) x[i] = 0.5 + random.uniform();
      const Taylor exact = f.at(x);
      const double size = 1 + std::abs(exact.value) + exact.slope.norm();
      constexpr double h = 1e-5;
      for (Eigen::Index i = 0; i < n; ++i) {
        const Eigen::VectorXd step = h * Eigen::VectorXd::Unit(n, i);
        const Taylor up = f.at(x + step), down = f.at(x - step);
        EXPECT_NEAR(exact.slope[i], (up.value - down.value) / (2 * h), 1e-7 * size) << text;
        const double far = (1e-7) * (size + exact.curvature.norm());
        EXPECT_LT((exact.curvature.col(i) - (up.slope - down.slope) / (2 * h)).norm(), far) << text;
      }
    }
  }
}

TEST(Expression, SaysWhereAFormulaEnds) {
  const auto expect = [](const std::string& text, const std::string& words) {
    const std::string told = error_of([&] { parsed(text); }, ExitCode::kUsage);
    EXPECT_NE(told.find(words), std::string::npos) << told;
  };
  expect("E1", "--constrain 'E1' has no =, <= or >= where one is due at its end");
  expect("E1 >= ", "lacks a number or a name at its end");
  expect("E1 >= 2*(E", "lacks a ')' at its end");
  expect("E1 >= 2 fish", "neither an operator nor a unit after the number at 'fish'");
  expect("E1 >= %", "has no number and no name at '%'");
  expect("E1 >= E[tumour", "does not end the region");
  expect("E1 >= E(2 mm)", "has neither a region nor the two or three coordinates of a point");
  expect("E1 >= E(1, 2, 3, 4)", "has neither a region nor the two or three coordinates");
  expect("E1 >= E[the lump]", "has neither a region nor the two or three coordinates of a point");
  expect("E1 E2 >= 3", "has no =, <= or >= where one is due at 'E2 >= 3'");
  expect(" ; ", "--constrain is empty");
  expect(std::string(5000, '(') + "a = 1", "is nested too deeply");
}

TEST(Expression, RegionsByNameAndByPoint) {
  const Expression f =
      parsed("E(tumour) + E[ liver ] >= E(20 mm, -2.5cm) + E[0.01, 0.02, 0]*E(2)")[0].difference;
  EXPECT_EQ(f.names(), (std::vector<std::string>{"E[tumour]", "E[liver]", "E[0.02,-0.025]",
                                                 "E[0.01,0.02,0]", "E[2]"}));
  // Two names of one unknown.
  const Expression g = f.renamed({"E[1]", "E", "E[1]", "E", "E[2]"});
  EXPECT_EQ(g.names(), (std::vector<std::string>{"E[1]", "E", "E[2]"}));
  const Taylor at = g.at(Eigen::Vector3d(3, 5, 7));
  EXPECT_EQ(at.value, 3 + 5 - 3 - 5 * 7);
  EXPECT_EQ(at.slope, Eigen::Vector3d(0, 1 - 7, -5));
}
