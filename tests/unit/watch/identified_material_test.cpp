#include "watch/identified_material.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "effects/catalogue.h"
#include "expect_error.h"
#include "model/body_parameters.h"

namespace hapsim {
namespace {

OnlineEstimate found() {
  OnlineEstimate e;
  e.moduli = ModuliVector::Zero(3);
  e.moduli << 10000, 3000, 1234.56;
  e.error = ModuliVector::Zero(3);
  e.error << 20, 30, std::numeric_limits<double>::infinity();
  e.rmse = 0.02;
  return e;
}

TEST(IdentifiedMaterial, TimesArePositiveAndFew) {
  EXPECT_EQ(parse_relaxation_times({"0.05", "2"}, "--times"), (std::vector<double>{0.05, 2}));
  for (const std::vector<std::string>& texts :
       {std::vector<std::string>{"0"}, {"-1"}, {"soon"}, {"1", "2", "3", "4", "5", "6"}})
    EXPECT_EQ(error_of([&] { parse_relaxation_times(texts, "--times"); }, ExitCode::kUsage)
                  .rfind("--times '", 0),
              0u);
  EXPECT_EQ(parse_relaxation_times({"1", "2", "3", "4", "5"}, "--times").size(), 5u);
}

TEST(IdentifiedMaterial, IsAModelThatCanBeReadAgain) {
  std::stringstream file;
  write_model(file, identified_model(found(), {0.5, 5}, 0.45));
  Input input = Input::from_bytes(file.str(), "m.csv");
  const Model model = read_model(input);
  EXPECT_EQ(modulus_of(model)->value, 10000);
  EXPECT_EQ(modulus_of(model)->std_error, 20);
  EXPECT_EQ(poissons_ratio_of(model)->value, 0.45);
  EXPECT_EQ(poissons_ratio_of(model)->state, ParameterState::kFixed);
  const std::string maxwell = maxwell_effect().card().name;
  EXPECT_EQ(model.find(maxwell, 0, "E2")->value, 1234.56);
  EXPECT_EQ(model.find(maxwell, 0, "tau2")->value, 5);
  EXPECT_FALSE(identified_model(found(), {}, 0.45).has(maxwell));
  EXPECT_EQ(modulus_of(unit_model(0.3))->value, 1);
}

TEST(IdentifiedMaterial, WhatIsNotKnownStaysEmpty) {
  EXPECT_EQ(estimate_columns(2), (std::vector<std::string>{"t", "rows", "E", "E_std", "E1",
                                                           "E1_std", "E2", "E2_std", "rmse"}));
  EXPECT_EQ(
      estimate_row(1.5, 300, found()),
      (std::vector<std::string>{"1.5", "300", "10000", "20", "3000", "30", "1234.56", "", "0.02"}));
  EXPECT_EQ(moduli_words(found(), {0.5, 5}, 3),
            "E = 1e+04 Pa ± 20, 3e+03 Pa at 0.5 s, 1.23e+03 Pa at 5 s");
}

}  // namespace
}  // namespace hapsim
