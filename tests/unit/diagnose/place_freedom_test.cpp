// What differs by place is named where it is learned, and no sensor for what each place may do.
#include "diagnose/place_freedom.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "diagnose/diagnose.h"
#include "fit/fit.h"
#include "model/body_parameters.h"
#include "support/synthetic.h"

namespace hapsim {
namespace {

constexpr double kPlaceNoise = 2e-3, kDepth = 2e-3;
constexpr int kSteps = 6;

// Where nothing of the approach is recorded, each press begins loaded.
Recording presses_by_place(bool approach, int along) {
  Recording r;
  r.name = "places";
  r.metadata.set("tool_radius", "0.003");
  int press = 0;
  for (int i = 0; i < along; ++i)
    for (int j = 0; j < 4; ++j, ++press)
      for (int k = approach ? -2 : 1; k <= kSteps; ++k) {
        r.line.push_back(static_cast<long>(r.line.size()) + 2);
        r.press.push_back(press);
        r.position.emplace_back(0.0125 + 0.00875 * i, 0.0125 + 0.012 * j, 0.03);
        r.u.emplace_back(0, 0, -kDepth * k / kSteps);
        r.contact.push_back(k > 0 ? 1 : 0);
        r.f.push_back(Vec3::Zero());
      }
  return r;
}

Model elastic_of(double modulus) {
  Model model = test::elastic(modulus, 0.4);
  poissons_ratio_of(model)->state = ParameterState::kFixed;
  return model;
}

// A stiffness that changes by a factor of four, with a power of the depth that changes too and
// differs from one; the tool stands `late` deeper than is recorded, and the sensor has a zero.
Experiment places(bool approach, double late, const Vec3& zero, int along = 5) {
  const auto on_block = [&](double rim_edge, int across, int down) {
    ExperimentOptions options;
    options.rim_edge = rim_edge;
    options.noise = kPlaceNoise;
    options.floor = 0.02;
    options.nu_low = options.nu_high = 0.4;
    return make_experiment(test::block_mesh({0.06, 0.06, 0.03}, across, across, down, 1),
                           presses_by_place(approach, along), options);
  };
  Experiment w = on_block(0.5, 4, 3);
  const Eigen::VectorXd f =
      solved_forces(elastic_of(1e4), on_block(0.35, 6, 4), all_episodes(w.dataset), false).f;
  Random random(7);
  Recording& r = w.dataset.recording;
  for (std::size_t row = 0; row < w.dataset.rows(); ++row) {
    const Vec3& p = r.position[row];
    const double d = std::max(0.0, -r.u[row].z());
    const double power = 0.3 + 0.2 * std::cos(50 * p.x() + 20 * p.y());
    const double factor = d > 0 ? std::exp(0.7 * std::sin(70 * p.x()) * std::cos(60 * p.y())) *
                                      std::pow((d + late) / kDepth, power) * (d + late) / d
                                : 0;
    for (int k = 0; k < 3; ++k)
      r.f[row][k] = factor * f[3 * static_cast<Eigen::Index>(row) + k] + zero[k] +
                    kPlaceNoise * random.normal();
  }
  return w;
}

Diagnosis diagnosed(const Experiment& w) {
  const Diagnosis d = diagnose(elastic_of(1e4), w, w.allowance(), {});
  std::printf("%s: %s\n", verdict_name(d.verdict).c_str(), d.explanation.c_str());
  for (const Finding& f : d.findings)
    if (f.verdict != Verdict::kAbsent)
      std::printf("  %s %s: %s; %s\n", f.effect.c_str(), verdict_name(f.verdict).c_str(),
                  f.evidence.c_str(), f.fitted.c_str());
  return d;
}

bool is_named(const Diagnosis& d, const std::string& effect) {
  return std::any_of(d.findings.begin(), d.findings.end(), [&](const Finding& f) {
    return f.effect == effect &&
           (f.verdict == Verdict::kMissing || f.verdict == Verdict::kIndistinguishable);
  });
}

TEST(PlaceFreedom, APlaceMayHaveItsOwnLawAndFirstTouch) {
  const Experiment w = places(false, 2e-4, Vec3::Zero());
  const Diagnosis d = diagnosed(w);
  EXPECT_EQ(d.verdict, ModelVerdict::kIncomplete);
  ASSERT_EQ(d.findings.front().effect, "learned-place");
  EXPECT_EQ(d.findings.front().verdict, Verdict::kMissing);
  EXPECT_NE(d.findings.front().fitted.find("power"), std::string::npos);
  for (const Finding& f : d.findings)
    EXPECT_EQ(is_named(d, f.effect), f.effect == "learned-place") << f.effect;
  EXPECT_LT(d.held_out_end.pooled, 0.5 * d.held_out.pooled);
}

// Sixteen places do not tell how they differ, but nothing that they share is to blame.
TEST(PlaceFreedom, FewPlacesAreNotTheSensor) {
  const Diagnosis d = diagnosed(places(false, 2e-4, Vec3::Zero(), 4));
  for (const char* sensor :
       {"sensor-bias", "sensor-curve", "sensor-gain", "sensor-rotation", "tare"})
    EXPECT_FALSE(is_named(d, sensor)) << sensor;
  EXPECT_TRUE(is_named(d, "regions"));
  EXPECT_FALSE(d.left.noise_alone());
}

TEST(PlaceFreedom, WhatTheAirShowsIsNamedBesideIt) {
  const Diagnosis d = diagnosed(places(true, 0, {0.01, 0, 0.02}));
  EXPECT_TRUE(is_named(d, "learned-place"));
  EXPECT_TRUE(is_named(d, "sensor-bias"));
}

}  // namespace
}  // namespace hapsim
