// What data must have for an effect to be testable, and what presses tell of their past.
#include "fit/testable.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "expect_error.h"
#include "support/synthetic.h"

namespace hapsim {
namespace {

// Two presses at one place: in to 2 mm and out, in to 3 mm and a little sideways.
Recording two_presses() {
  Recording r;
  r.name = "two";
  r.metadata.set("tool_radius", "0.004");
  const auto row = [&](int press, const Vec3& u) {
    r.line.push_back(static_cast<long>(r.line.size()) + 2);
    r.press.push_back(press);
    r.t.push_back(0.1 * static_cast<double>(r.t.size()));
    r.position.emplace_back(0.01, 0.02, 0.04);
    r.u.push_back(u);
    r.f.push_back(Vec3::Zero());
  };
  for (const double depth : {0.0, 1e-3, 2e-3, 1e-3, 0.0}) row(0, {0, 0, -depth});
  row(1, {0, 0, -3e-3});
  row(1, {1e-3, 0, -3e-3});
  return r;
}

Dataset dataset_of(const Recording& recording) {
  Dataset d = make_dataset(recording);
  const std::vector<ToolStand> stands(d.positions.size());
  return on_body(std::move(d), stands);
}

std::string lack(const std::string& effect, const Recording& recording) {
  return lacking_for(find_effect(effect)->card(), dataset_of(recording));
}

TEST(Dataset, KnowsThePressesBefore) {
  const Dataset d = dataset_of(two_presses());
  ASSERT_EQ(d.episodes.size(), 2u);
  EXPECT_EQ(d.episodes[0].view.past_depth, 0);
  EXPECT_EQ(d.episodes[1].view.past_depth, 2e-3);
  EXPECT_EQ(d.episodes[1].view.number, 2);
  EXPECT_NEAR((d.episodes[1].view.direction - Vec3(1, 0, -3).normalized()).norm(), 0, 1e-12);
  Recording healed = two_presses();
  healed.metadata.set("recovery", "full");
  EXPECT_EQ(dataset_of(healed).episodes[1].view.past_depth, 0);
}

TEST(Experiment, RefusesDisplacementsBeyondTheBody) {
  Recording wild = two_presses();
  wild.u[2] = {0.6, 0, -1e-3};
  const auto prepare = [](const Recording& r) {
    ExperimentOptions options;
    options.rim_edge = 0.5;
    return make_experiment(test::block_mesh({0.08, 0.08, 0.04}, 4, 4, 3, 1), r, options);
  };
  EXPECT_NE(error_of([&] { prepare(wild); }).find("two:4: a displacement of 0.6 m on a body of"),
            std::string::npos);
  wild.contact.assign(wild.rows(), 1);
  wild.contact[2] = 0;  // far away in the air
  EXPECT_NO_THROW(prepare(wild));
  wild.position[5] = wild.position[6] = {0.01, 0.02, 0.5};
  EXPECT_NE(error_of([&] { prepare(wild); }).find("two: contact at (0.01, 0.02, 0.5): lies"),
            std::string::npos);
}

TEST(Testable, SaysWhatTheDataLack) {
  const Recording both = two_presses();
  EXPECT_EQ(lack("softening", both), "");
  EXPECT_EQ(lack("friction", both), "");
  EXPECT_EQ(lack("backlash", both), "");
  EXPECT_NE(lack("temperature", both).find("no column temp"), std::string::npos);
  Recording first = both;
  for (auto* column : {&first.u, &first.f, &first.position}) column->resize(5);
  first.press.resize(5);
  first.line.resize(5);
  first.t.resize(5);
  EXPECT_NE(lack("softening", first).find("pressed only once"), std::string::npos);
  EXPECT_NE(lack("friction", first).find("no press moves sideways"), std::string::npos);
  Recording in = first;
  for (auto* column : {&in.u, &in.f, &in.position}) column->resize(3);
  in.press.resize(3);
  in.line.resize(3);
  in.t.resize(3);
  EXPECT_NE(lack("backlash", in).find("way out"), std::string::npos);
  EXPECT_NE(lack("adhesion", in).find("way out"), std::string::npos);
  EXPECT_NE(lack("drag", in).find("way out"), std::string::npos);
  in.u[0].z() = 1e-4;  // above the surface is no way out
  EXPECT_NE(lack("drag", in).find("way out"), std::string::npos);
}

// One steady pace in: whatever a memory does, a law of the depth does.
TEST(Testable, AMemoryOfNoLawNeedsMoreThanOnePace) {
  const auto presses = [](double second_pace, int held) {
    Recording r = two_presses();
    for (auto* column : {&r.u, &r.f, &r.position}) column->clear();
    r.press.clear(), r.line.clear(), r.t.clear();
    for (int press = 0; press < 2; ++press)
      for (int i = 0; i < 20 + held; ++i) {
        r.line.push_back(static_cast<long>(r.line.size()) + 2);
        r.press.push_back(press);
        r.t.push_back(10 * press + 0.1 * i);
        r.position.emplace_back(0.01, 0.02, 0.04);
        r.u.emplace_back(0, 0, -1e-4 * std::min(i, 20) * (press == 0 ? 1 : second_pace));
        r.f.push_back(Vec3::Zero());
      }
    return r;
  };
  EXPECT_NE(lack("learned-kernel", presses(1, 0)).find("one steady pace"), std::string::npos);
  EXPECT_EQ(lack("learned-kernel", presses(0.3, 0)), "");
  EXPECT_EQ(lack("learned-kernel", presses(1, 20)), "");
  EXPECT_EQ(lack("learned-drift", presses(1, 0)), "");  // the second press comes later
  EXPECT_EQ(lack("viscoelastic", presses(1, 0)), "");   // its law is told by its form, or is not
}

// One press at a steady pace: what runs in time in the sensor is a curve of the depth, unless the
// air, a hold or another press has a time of its own.
TEST(Testable, WhatRunsInTheSensorNeedsATimeOfItsOwn) {
  const auto presses = [](int air, int held, int count) {
    Recording r = two_presses();
    for (auto* column : {&r.u, &r.f, &r.position}) column->clear();
    r.press.clear(), r.line.clear(), r.t.clear();
    for (int press = 0; press < count; ++press)
      for (int i = -air; i <= 20 + held; ++i) {
        r.line.push_back(static_cast<long>(r.line.size()) + 2);
        r.press.push_back(press);
        r.t.push_back(10 * press + 0.1 * (i + air));
        r.position.emplace_back(0.01, 0.02, 0.04);
        r.u.emplace_back(0, 0, -1e-4 * std::clamp(i, 0, 20));
        r.f.push_back(Vec3::Zero());
        r.contact.push_back(i >= 0);
      }
    return r;
  };
  for (const char* effect : {"sensor-drift", "sensor-lag", "filter"}) {
    EXPECT_NE(lack(effect, presses(0, 0, 1)).find("one steady pace"), std::string::npos) << effect;
    EXPECT_NE(lack(effect, presses(2, 0, 1)).find("one steady pace"), std::string::npos) << effect;
    EXPECT_EQ(lack(effect, presses(40, 0, 1)), "") << effect;
    EXPECT_EQ(lack(effect, presses(0, 20, 1)), "") << effect;
    EXPECT_EQ(lack(effect, presses(0, 0, 2)), "") << effect;
  }
}

TEST(Testable, AnEndOfTheSensorIsInTheReadings) {
  Recording r = two_presses();
  for (std::size_t i = 0; i < r.rows(); ++i) r.f[i] = {0, 0, 0.1 * static_cast<double>(i)};
  EXPECT_NE(lack("clipping", r).find("the sensor's end was not reached"), std::string::npos);
  EXPECT_TRUE(summarise(dataset_of(r), 1).ceiling.isZero());
  for (std::size_t i = 2; i < r.rows(); ++i) r.f[i].z() = 0.5;
  EXPECT_EQ(lack("clipping", r), "");
  EXPECT_EQ(summarise(dataset_of(r), 1).ceiling, Vec3(0, 0, 0.5));
}

TEST(Testable, ASessionHasOneClock) {
  Recording r = two_presses();
  EXPECT_EQ(lack("sensor-settling", r), "");
  r.t[5] = 0.1;
  r.t[6] = 0.2;
  EXPECT_NE(lack("sensor-settling", r).find("begins anew"), std::string::npos);
  EXPECT_NE(lack("clock", r).find("four places"), std::string::npos);  // has no part in that
}

TEST(Testable, ARadiusIsThatOfAFlatToolAtSeveralPlaces) {
  Recording r = two_presses();
  EXPECT_NE(lack("tool-radius", r).find("too few contact positions"), std::string::npos);
  for (std::size_t i = 0; i < r.rows(); ++i) {
    r.press[i] = static_cast<int>(i / 2);
    r.position[i].x() = 0.01 * r.press[i];
  }
  EXPECT_EQ(lack("tool-radius", r), "");
  r.metadata.set("tool", "sphere");
  EXPECT_NE(lack("tool-radius", r).find("with a flat tool"), std::string::npos);
}

TEST(Testable, TemperatureMustVaryBetweenPresses) {
  Recording r = two_presses();
  r.temp.assign(r.rows(), 20.0);
  r.temp[1] = 22;  // a spike within a press is no warming
  EXPECT_NE(lack("temperature", r).find("changes by"), std::string::npos);
  r.temp[5] = r.temp[6] = 30;
  EXPECT_EQ(lack("temperature", r), "");
  EXPECT_NEAR(summarise(dataset_of(r), 1).temperature, 162.0 / 7, 1e-12);
  r.metadata.set("temp_ref", "22");
  EXPECT_EQ(summarise(dataset_of(r), 1).temperature, 22);
}

}  // namespace
}  // namespace hapsim
