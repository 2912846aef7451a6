// The analytical model: its step against the closed form, interpolation, its file, its fit.
#include "acfm/acfm.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "acfm/acfm_fit.h"
#include "acfm/acfm_loop.h"
#include "acfm/acfm_record.h"
#include "base/error.h"
#include "base/random.h"
#include "expect_error.h"
#include "support/block_mesh.h"

namespace hapsim {
namespace {

Acfm one_element(const std::vector<Vec3>& places, double ks = 300, double k = 200,
                 double tau = 0.1) {
  Acfm model;
  model.terms = 1;
  for (const Vec3& p : places) {
    SubModel sub;
    sub.point = p;
    for (AcfmAxis& axis : sub.axis) {
      axis.value[0] = ks;
      axis.value[1] = k;
      axis.value[2] = tau;
    }
    model.positions.push_back(sub);
  }
  return model;
}

// A ramp of rate v: f = ks v t + k tau v (1 - exp(-t / tau)); then held, the memory decays. By hand
// from (4.37) with d = k tau.
TEST(AcfmLoop, IsTheClosedFormOfARampAndAHoldForAnySteps) {
  const Acfm model = one_element({{0, 0, 0}});
  const double v = 0.02, ramp = 0.15, tau = 0.1;
  for (const int steps : {1, 7, 1000}) {
    AcfmLoop loop(model);
    loop.begin({0, 0, 0});
    loop.press(0, Vec3::Zero());
    double f = 0;
    for (int i = 1; i <= steps; ++i) {
      const double t = ramp * i / steps;
      f = loop.press(t, {0, 0, -v * t}).z();
      EXPECT_NEAR(f, 300 * v * t + 200 * tau * v * (1 - std::exp(-t / tau)), 1e-12);
    }
    // 3 tau later in one step: twice the explicit step's limit of stability and more.
    const double end = loop.press(ramp + 0.3, {0, 0, -v * ramp}).z();
    EXPECT_NEAR(end - 300 * v * ramp, (f - 300 * v * ramp) * std::exp(-3.0), 1e-12);
  }
}

TEST(Acfm, IsExactAtPositionsAndWeighsTheNearMore) {
  Acfm model = one_element({{0, 0, 0}, {0.1, 0, 0}});
  for (AcfmAxis& axis : model.positions[1].axis) axis.value = {600, 400, 0.4};
  EXPECT_EQ(model.at({0.1, 0, 0}).axis[2].spring(), 600);
  EXPECT_NEAR(model.at({0.05, 0.03, 0}).axis[2].spring(), 450, 1e-9);
  EXPECT_NEAR(model.at({0.05, 0, 0}).axis[2].tau(0), 0.2, 1e-12);
  const double near = model.at({0.02, 0, 0}).axis[2].spring();
  EXPECT_NEAR(near, 300 + 300.0 / 17, 1e-9);  // weights 1/0.02^2 and 1/0.08^2: 16 to 1
}

TEST(Acfm, IsContinuousWherePositionsDropOut) {
  Acfm model;
  Random random(3);
  for (int i = 0; i < 25; ++i) {
    Acfm one = one_element({{0.02 * (i % 5), 0.02 * (i / 5), 0}}, 200 + 200 * random.uniform());
    model.positions.push_back(one.positions[0]);
  }
  model.terms = 1;
  double last = model.at({0, 0.001, 0}).axis[2].spring(), largest = 0;
  for (double s = 0; s < 0.08; s += 1e-5) {
    const double now = model.at({s, 0.001 + 0.9 * s, 0}).axis[2].spring();
    largest = std::max(largest, std::abs(now - last));
    last = now;
  }
  EXPECT_LT(largest, 1.5);  // of 200 N/m, over a hundredth of a millimetre
}

TEST(Acfm, ReadsWhatItWritesAndSaysWhatIsWrong) {
  const Acfm model = one_element({{0, 0, 0.06}, {0.1, 0, 0.06}});
  std::ostringstream out;
  write_acfm(out, model);
  EXPECT_TRUE(is_acfm(out.str()));
  EXPECT_FALSE(is_acfm("effect,region,parameter,value,unit\n"));
  Input input = Input::from_bytes(out.str(), "acfm.csv");
  const Acfm back = read_acfm(input);
  ASSERT_EQ(back.positions.size(), 2u);
  EXPECT_EQ(back.terms, 1);
  EXPECT_EQ(back.positions[1].axis[0].value, model.positions[1].axis[0].value);
  const auto refused = [&](const std::string& from, const std::string& to,
                           const std::string& text) {
    std::string bytes = out.str();
    bytes.replace(bytes.find(from), from.size(), to);
    Input bad = Input::from_bytes(bytes, "acfm.csv");
    try {
      read_acfm(bad);
      ADD_FAILURE() << "nothing was thrown for " << to;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput);
      EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
    }
  };
  refused("t1,ks,300", "t1,ks,-3", "acfm.csv:2: ks = -3 is not positive");
  refused("t1,k1,200", "t1,ks,200", "ks is given twice");
  refused("t1,tau1", "t1,tau9", "'tau9' is not known");
  refused("t1,k1", "t4,k1", "'t4' is not known");
  refused("t1,k1,200", "t1,k2,200", "position 1 has no k1 for axis t1");
}

// Presses on a side wall whose axes are not the global ones, with noise.
Dataset presses(const Acfm& truth, double noise, std::uint64_t seed) {
  Recording r;
  r.name = "synthetic";
  r.metadata.set("tool_radius", "0.004");
  int press = 0;
  for (const SubModel& sub : truth.positions)
    for (int kind = 0; kind < 3; ++kind, ++press)
      for (int i = 0; i <= 400; ++i) {
        const double t = 0.005 * i, share = std::min(1.0, t / (kind == 1 ? 1.0 : 0.1));
        r.line.push_back(static_cast<long>(r.line.size()) + 2);
        r.press.push_back(press);
        r.t.push_back(t);
        r.position.push_back(sub.point);
        const Vec3 local = 0.003 * share * (kind == 2 ? Vec3(0.6, -0.5, -1) : Vec3(0, 0, -1));
        r.u.push_back(acfm_frame(sub.normal) * local);
        r.f.push_back(Vec3::Zero());
      }
  Dataset dataset = make_dataset(std::move(r));
  const std::vector<Vec3> f = acfm_forces(truth, dataset);
  Random random(seed);
  for (std::size_t i = 0; i < f.size(); ++i)
    for (int k = 0; k < 3; ++k) dataset.recording.f[i][k] = f[i][k] + noise * random.normal();
  return dataset;
}

TEST(AcfmFit, RecoversTheTruthWithinItsStandardErrors) {
  Acfm truth = one_element({{0, 0, 0.06}, {0.12, 0.1, 0.03}});
  truth.terms = 2;
  truth.positions[1].normal = Vec3(1, 0, 0);
  for (SubModel& sub : truth.positions)
    for (std::size_t a = 0; a < 3; ++a)
      sub.axis[a].value = {300.0 + 50 * static_cast<double>(a), 200, 0.03, 120, 0.4};
  int inside = 0, all = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Dataset dataset = presses(truth, 0.01, seed);
    AcfmFitOptions options;
    options.terms = 2;
    options.noise = 0.01;
    options.folds = 0;
    const AcfmFit fit =
        fit_acfm(dataset, {truth.positions[0].normal, truth.positions[1].normal}, options);
    EXPECT_EQ(fit.derived_axes, 0);
    EXPECT_NEAR(fit.rmse, 0.01, 3e-4);
    for (std::size_t p = 0; p < 2; ++p)
      for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t k = 0; k < 5; ++k) {
          const AcfmAxis& found = fit.model.positions[p].axis[a];
          const double off = std::abs(found.value[k] - truth.positions[p].axis[a].value[k]);
          ASSERT_GT(found.error[k], 0);
          inside += off < 2 * found.error[k] ? 1 : 0;
          ++all;
        }
  }
  EXPECT_GT(inside, 0.88 * all);  // 95 % of 180, less three standard deviations
}

TEST(AcfmFit, FindsTheStiffening) {
  Acfm truth = one_element({{0, 0, 0.06}});
  for (AcfmAxis& axis : truth.positions[0].axis) axis.value[AcfmAxis::kStiffening] = 250;
  // By hand: e^(250 * 0.004) - 1 over 250 m^-1.
  AcfmLoop loop(truth);
  loop.begin({0, 0, 0.06});
  EXPECT_NEAR(loop.press(0, {0, 0, -0.004}).z(), 500 * (std::exp(1.0) - 1) / 250, 1e-12);
  const Dataset dataset = presses(truth, 0.005, 8);
  AcfmFitOptions options;
  options.stiffening = true;
  options.noise = 0.005;
  const AcfmFit fit = fit_acfm(dataset, {Vec3::UnitZ()}, options);
  const AcfmAxis& axis = fit.model.positions[0].axis[2];
  EXPECT_NEAR(axis.stiffening(), 250, 3 * axis.error[AcfmAxis::kStiffening]);
  EXPECT_LT(axis.error[AcfmAxis::kStiffening], 5);
  EXPECT_NEAR(fit.rmse, 0.005, 3e-4);
}

TEST(Acfm, StiffensSmoothlyAboutZero) {
  for (const double s : {1e-4 / 0.003 * 0.999, 1e-4 / 0.003 * 1.001, 300.0, -200.0}) {
    const double step = 1e-4 * std::abs(s) + 1e-6;
    const double by_difference =
        (stiffening_at(s + step, 0.003).factor - stiffening_at(s - step, 0.003).factor) /
        (2 * step);
    EXPECT_NEAR(stiffening_at(s, 0.003).slope, by_difference, 1e-6 * by_difference) << s;
  }
}

TEST(AcfmFit, DerivesWhatDidNotMoveAndHoldsOut) {
  const Acfm truth = one_element({{0, 0, 0.06}, {0.05, 0, 0.06}, {0.1, 0, 0.06}});
  Dataset dataset = presses(truth, 0.002, 7);
  for (Episode& e : dataset.episodes)
    for (Vec3& u : e.view.u) u.x() = u.y() = 0;
  AcfmFitOptions options;
  options.noise = 0.002;
  const AcfmFit fit = fit_acfm(dataset, std::vector<Vec3>(3, Vec3::UnitZ()), options);
  EXPECT_EQ(fit.derived_axes, 6);
  EXPECT_TRUE(fit.model.positions[0].axis[0].derived);
  // (1 - 2 nu) / (4 ln(3 - 4 nu)) over (2 - nu) / 8 at nu = 0.4
  EXPECT_NEAR(fit.model.positions[0].axis[0].spring() / fit.model.positions[0].axis[2].spring(),
              0.2 / (4 * std::log(1.4)) / (1.6 / 8), 1e-9);
  EXPECT_LT(fit.held_out_positions, 1.2 * fit.rmse);
  EXPECT_LT(fit.held_out_presses, 1.2 * fit.rmse);
}

// A unit cube pressed on its top; a contact 5 mm off it is one of a slack, 20 mm off one of another
// frame.
TEST(AcfmFit, ContactsLieOnTheSurface) {
  Recording r;
  r.metadata.set("tool_radius", "0.004");
  for (const double z : {1.0, 1.005}) {
    r.press.push_back(static_cast<int>(r.press.size()));
    r.line.push_back(static_cast<long>(r.line.size()) + 2);
    r.position.emplace_back(0.5, 0.4 + 0.1 * r.press.back(), z);
    r.u.emplace_back(0, 0, -0.001);
    r.f.emplace_back(0, 0, 1);
  }
  const SignedDistance cube(boundary_surface(test::block_mesh({1, 1, 1}, 2, 2, 2, 1)));
  for (const Vec3& n : contact_normals(make_dataset(r), cube))
    EXPECT_NEAR((n - Vec3::UnitZ()).norm(), 0, 1e-12);
  r.position[1].z() = 1.02;
  EXPECT_NE(
      error_of([&] { contact_normals(make_dataset(r), cube); }).find("0.02 m off the surface"),
      std::string::npos);
}

TEST(AcfmRecord, TellsErrorsAgainstForceAndNoise) {
  AcfmFit fit;
  fit.model.terms = 2;
  fit.rmse = 0.02;
  fit.held_out_presses = 0.03;
  fit.remarks = {"a", "b", "c", "d", "e"};
  Dataset dataset;
  dataset.positions = {Vec3::Zero()};
  dataset.recording.metadata.set("tool_radius", "0.004");
  dataset.recording.press = {1, 1};
  dataset.recording.f = {Vec3(1, 1, 1), Vec3(1, -1, 1)};  // rms 1 N
  const std::vector<std::string> lines =
      fit_lines(fit, dataset, {0.01, true, "measured from the data"});
  EXPECT_EQ(
      lines,
      (std::vector<std::string>{
          "1 sub-models of 2 Maxwell elements a direction from 2 samples; noise 0.01 N "
          "(measured from the data)",
          "a", "b", "c", "d", "... and 1 more", "error 0.02 N = 2 % of the force's rms, 2 x noise",
          "on presses not seen by the fit 0.03 N = 3 % of the force's rms, 3 x noise"}));
  record_fit(fit, dataset, {0.01, true});
  EXPECT_EQ(fit.model.metadata.find("heldout_presses"), "0.03");
  EXPECT_FALSE(fit.model.metadata.find("heldout_positions"));
}

}  // namespace
}  // namespace hapsim
