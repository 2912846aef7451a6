// model.csv: round trip, and what it refuses.
#include "model/model.h"

#include <gtest/gtest.h>

#include <sstream>

#include "effects/catalogue.h"
#include "expect_error.h"
#include "model/model_edit.h"

namespace hapsim {
namespace {

Model every_effect() {
  Model model;
  for (const Effect* effect : catalogue()) {
    const auto values = effect->starts({}, effect->card().terms ? 2 : 1).front();
    for (const Parameter& p : effect_rows(*effect, effect->card().terms ? 2 : 1, values))
      model.parameters.push_back(p);
  }
  model.metadata.set("rmse", "0.01");
  return model;
}

Model read(const std::string& text) {
  Input input = Input::from_bytes(text, "m.csv");
  return read_model(input);
}

const std::string kHead = "effect,region,parameter,value,unit,std_error,lower,upper,state\n";
const std::string kElastic =
    "elastic,0,E,10000,Pa,12.5,1,1e12,free\nelastic,0,nu,0.45,1,,0,0.499,fixed\n";

TEST(ModelFile, RoundTripsEveryEffect) {
  const Model model = every_effect();
  std::ostringstream out;
  write_model(out, model);
  const Model again = read(out.str());
  ASSERT_EQ(again.parameters.size(), model.parameters.size());
  for (std::size_t i = 0; i < model.parameters.size(); ++i) {
    EXPECT_EQ(again.parameters[i].effect, model.parameters[i].effect);
    EXPECT_EQ(again.parameters[i].name, model.parameters[i].name);
    EXPECT_EQ(again.parameters[i].value, model.parameters[i].value);
    EXPECT_EQ(again.parameters[i].state, model.parameters[i].state);
  }
  std::ostringstream second;
  write_model(second, again);
  EXPECT_EQ(second.str(), out.str());
}

TEST(ModelFile, RowsMayStandInAnyOrder) {
  const std::string head = "effect,region,parameter,value\n";
  const Model model = read(head +
                           "viscoelastic,0,tau2,2\nelastic,0,nu,0.4\nviscoelastic,0,tau1,0.3\n"
                           "elastic,0,E,10000\nviscoelastic,0,E2,200\nviscoelastic,0,E1,3000\n");
  std::string names;
  for (const Parameter& p : model.parameters)
    if (p.effect == "viscoelastic") names += p.name + " ";
  EXPECT_EQ(names, "E1 tau1 E2 tau2 ");
}

TEST(ModelFile, WhatMayBeLeftOutDoesNothing) {
  const Model model = read(kHead + kElastic + "damper,0,c,3,N s/m,,0,9,free\n");
  const Parameter* tau = model.find("damper", 0, "tau");
  ASSERT_NE(tau, nullptr);
  EXPECT_EQ(tau->value, 0);
  EXPECT_EQ(tau->state, ParameterState::kFixed);
}

TEST(ModelFile, RefusesWhatItCannotMean) {
  EXPECT_NE(error_of([] {
              read(kHead + kElastic + "magic,0,x,1,1,,0,2,free\n");
            }).find("m.csv:4: unknown effect 'magic'"),
            std::string::npos);
  EXPECT_NE(error_of([] {
              read(kHead + kElastic + "damper,0,d,1,1,,0,2,free\n");
            }).find("damper has no parameter 'd'"),
            std::string::npos);
  EXPECT_NE(error_of([] { read(kHead + "elastic,0,E,10,kPa,,1,1e12,free\n"); }).find("in 'kPa'"),
            std::string::npos);
  EXPECT_NE(error_of([] {
              read(kHead + kElastic + "damper,0,c,-3,N s/m,,0,2,free\n");
            }).find("outside its bounds"),
            std::string::npos);
  // Solvers cannot do with what these bounds would allow.
  for (const char* nu : {"0.4,1,,0,0.5,free\n", "-0.5,1,,-2,0.49,free\n", "0.6,1,,0,0.9,fixed\n"})
    EXPECT_NE(error_of([&] {
                read(kHead + "elastic,0,E,1e4,Pa,,1,1e12,free\nelastic,0,nu," + nu);
              }).find("reach what it cannot be; keep them within [0, 0.499]"),
              std::string::npos);
  EXPECT_NE(error_of([] { read(kHead + "elastic,0,E,0,Pa,,0,1e12,free\n"); }).find("positive"),
            std::string::npos);
  EXPECT_NE(error_of([] { read(kHead + kElastic + kElastic); }).find("stands twice"),
            std::string::npos);
  EXPECT_NE(
      error_of([] { read(kHead + "elastic,0,E,10,Pa,,1,1e12,free\n"); }).find("lacks E or nu"),
      std::string::npos);
  EXPECT_NE(
      error_of([] { read(kHead + kElastic + "sensor-lag,0,tau,nan,s,,0,1,free\n"); }).find("nan"),
      std::string::npos);
}

TEST(ModelEdit, FixesFreesAndRemoves) {
  Model model = read(kHead + kElastic);
  set_state(model, "nu=0.4", ParameterState::kFixed);
  EXPECT_EQ(model.find("elastic", 0, "nu")->value, 0.4);
  set_state(model, "elastic.nu", ParameterState::kFree);
  EXPECT_EQ(model.free_parameters().size(), 2u);
  error_of([&] { set_state(model, "nu=0.6", ParameterState::kFixed); }, ExitCode::kUsage);
  error_of([&] { set_state(model, "bogus", ParameterState::kFixed); }, ExitCode::kUsage);
  error_of([&] { remove_effect(model, "elastic"); }, ExitCode::kUsage);
  error_of([&] { remove_effect(model, "damper"); }, ExitCode::kUsage);
}

}  // namespace
}  // namespace hapsim
