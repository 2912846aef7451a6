#include "model/golden_model.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hapsim {
namespace {

Model model(double E, double std_error, double rmse) {
  Model m;
  m.metadata.set("rmse", std::to_string(rmse));
  m.parameters.push_back({"elastic", 0, "E", E, "Pa", std_error, 1, 1e12, ParameterState::kFree});
  m.parameters.push_back({"elastic", 0, "nu", 0.4, "1", NAN, 0, 0.499, ParameterState::kFixed});
  return m;
}

GoldenOptions options(double tolerance) {
  GoldenOptions o;
  o.tolerances = {{"", tolerance, true}};
  return o;
}

TEST(Golden, ToleranceOrStandardErrorsWhicheverIsMore) {
  const Model golden = model(10000, 40, 0.1);
  const auto row = [&](double E, double error, double tolerance) {
    return compare_with_golden(model(E, error, 0.1), golden, options(tolerance))[0];
  };
  // A factor of exp(3 sqrt(0.003^2 + 0.004^2)) against 1 % = 100.
  EXPECT_NEAR(row(10000, 30, 0.01).allowed, 1e4 * std::expm1(0.015), 1e-9);
  EXPECT_EQ(row(10149, 30, 0.01).verdict, GoldenVerdict::kSame);
  EXPECT_EQ(row(10151, 30, 0.01).verdict, GoldenVerdict::kDiffers);
  EXPECT_NEAR(row(10000, 30, 0.02).allowed, 200, 1e-9);
  EXPECT_NE(row(10151, 30, 0.01).why.find("3 standard errors"), std::string::npos);
  EXPECT_NE(row(10201, 30, 0.02).why.find("(tolerance)"), std::string::npos);
}

// Linear standard errors would take any smaller modulus for the same.
TEST(Golden, StandardErrorsOfAModulusAreFactors) {
  const auto verdict = [&](double E) {
    return compare_with_golden(model(E, 0.35 * E, 0.1), model(10000, 3500, 0.1), options(0.01))[0]
        .verdict;
  };
  const double factor = std::exp(3 * std::sqrt(2.0) * 0.35);  // 4.4
  for (const double at : {1.01, factor / 1.01}) {
    EXPECT_EQ(verdict(10000 * at), GoldenVerdict::kSame) << at;
    EXPECT_EQ(verdict(10000 / at), GoldenVerdict::kSame) << at;
  }
  EXPECT_EQ(verdict(10000 * factor * 1.01), GoldenVerdict::kDiffers);
  EXPECT_EQ(verdict(10000 / factor / 1.01), GoldenVerdict::kDiffers);
}

TEST(Golden, WhatOnlyOneModelHasDiffers) {
  const Model golden = model(10000, 40, 0.1);
  Model more = golden;
  more.parameters.push_back({"damper", 0, "c", 3, "N s/m", NAN, 0, 10, ParameterState::kFree});
  const auto now = compare_with_golden(more, golden, options(0.01));
  EXPECT_EQ(now[2].verdict, GoldenVerdict::kNew);
  EXPECT_EQ(compare_with_golden(golden, more, options(0.01))[2].verdict, GoldenVerdict::kGone);
  Model freed = golden;
  freed.parameters[1].state = ParameterState::kFree;
  EXPECT_EQ(compare_with_golden(freed, golden, options(0.01))[1].verdict, GoldenVerdict::kDiffers);
}

TEST(Golden, AnErrorMayFall) {
  const Model golden = model(10000, 40, 0.1);
  const auto verdict = [&](double rmse) {
    return compare_with_golden(model(10000, 40, rmse), golden, options(0.01)).back().verdict;
  };
  EXPECT_EQ(verdict(0.01), GoldenVerdict::kSame);
  EXPECT_EQ(verdict(0.109), GoldenVerdict::kSame);
  EXPECT_EQ(verdict(0.111), GoldenVerdict::kDiffers);
}

TEST(Golden, AnErrorMayNotBeAbsentNorTheFitEndedEarly) {
  const Model golden = model(10000, 40, 0.1);
  Model silent = golden, early = golden;
  silent.metadata.remove("rmse");
  EXPECT_EQ(compare_with_golden(silent, golden, options(0.01)).back().verdict,
            GoldenVerdict::kGone);
  EXPECT_EQ(compare_with_golden(golden, silent, options(0.01)).size(), 2U);
  early.metadata.set("converged", "no");
  const GoldenRow row = compare_with_golden(early, golden, options(0.01)).back();
  EXPECT_EQ(row.verdict, GoldenVerdict::kDiffers);
  EXPECT_NE(row.why.find("before it converged"), std::string::npos);
  EXPECT_EQ(compare_with_golden(early, early, options(0.01)).back().parameter, "rmse");
}

TEST(Golden, FixedValuesByToleranceAlone) {
  Model golden = model(10000, 40, 0.1), now = golden;
  now.parameters[1].value = 0.401;
  EXPECT_EQ(compare_with_golden(now, golden, options(0.01))[1].verdict, GoldenVerdict::kSame);
  EXPECT_EQ(compare_with_golden(now, golden, options(0))[1].verdict, GoldenVerdict::kDiffers);
  GoldenOptions own = options(0);
  own.tolerances.push_back({"elastic.nu", 0.002, false});
  EXPECT_EQ(compare_with_golden(now, golden, own)[1].verdict, GoldenVerdict::kSame);
}

}  // namespace
}  // namespace hapsim
