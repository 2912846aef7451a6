// The full simulation against the condensed path, and what it does with tools, forces and failure.
#include "simulate/full_simulation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "effects/catalogue.h"
#include "expect_error.h"
#include "experiment/experiment.h"
#include "experiment/forces.h"
#include "simulate/own_mesh.h"
#include "support/block_mesh.h"

namespace hapsim {
namespace {

constexpr double kRadius = 0.004;
const Vec3 kSize(0.06, 0.05, 0.03);

using Rows = std::vector<std::pair<std::string, std::vector<double>>>;
Model model_of(const Rows& effects) {
  Model model;
  for (const auto& [name, values] : effects) {
    const Effect& effect = *find_effect(name);
    const int terms = static_cast<int>(values.size() / effect.card().parameters.size());
    for (Parameter p : effect_rows(effect, terms, values)) {
      p.state = ParameterState::kFixed;
      model.parameters.push_back(p);
    }
  }
  return model;
}

Recording motion(const std::vector<Vec3>& way, double step, const Vec3& at = {0.033, 0.024, 0.03}) {
  Recording r;
  r.name = "motion.csv";
  r.metadata.set("tool_radius", std::to_string(kRadius));
  for (std::size_t i = 0; i < way.size(); ++i) {
    r.line.push_back(static_cast<long>(i) + 2);
    r.press.push_back(1);
    if (step > 0) r.t.push_back(step * static_cast<double>(i));
    r.position.push_back(at);
    r.u.push_back(way[i]);
  }
  return r;
}

const TetMesh& block() {
  static const TetMesh mesh = test::block_mesh(kSize, 6, 6, 4, 1);
  return mesh;
}

std::vector<Vec3> condensed(const Model& model, const Recording& r) {
  ExperimentOptions options;
  set_poisson_range(model, options);
  options.noise = 1e-3;
  const Experiment w = make_experiment(block(), r, options);
  const Eigen::VectorXd f = solved_forces(model, w, all_episodes(w.dataset), false).f;
  std::vector<Vec3> forces;
  for (Eigen::Index i = 0; i < f.size(); i += 3) forces.push_back(f.segment<3>(i));
  return forces;
}

double difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double worst = 0, largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    worst = std::max(worst, (a[i] - b[i]).norm());
    largest = std::max(largest, b[i].norm());
  }
  return worst / largest;
}

FullOptions coarse() {
  FullOptions options;
  options.rim_edge = 1.0 / 3;
  return options;
}

// The same mesh, so the same forces: relaxation, a support that gives, a direction. A layer's too,
// but for the elements that its boundary cuts: laminates there (element_mixture.h), of one mean
// modulus here.
TEST(FullSimulation, LinearModelsAreTheCondensedOnes) {
  struct Case {
    Rows rows;
    double most;
  };
  const Case cases[] = {
      {{{"elastic", {2e4, 0.4}}, {"viscoelastic", {1e4, 0.3, 5e3, 4}}}, 1e-6},
      {{{"elastic", {2e4, 0.4}}, {"base", {0.004, 0.3, 0.002}}}, 1e-6},
      {{{"elastic", {2e4, 0.4}}, {"base", {0.004, 0.3, 0.002}}, {"layer", {0.003, 2}}}, 3e-3},
      {{{"elastic", {2e4, 0.4}}, {"anisotropic", {1.8, 0.8, 0.6, 0.5}}}, 1e-6}};
  const Recording r = motion({{0, 0, 0}, {0, 0, -1e-3}, {2e-4, 0, -1e-3}, {2e-4, 0, -5e-4}}, 0.2);
  for (const auto& [rows, most] : cases) {
    const Model model = model_of(rows);
    const FullResult full = simulate_full(block(), model, r, {});
    const double off = difference(full.force, condensed(model, r));
    std::printf("full and condensed, %s: %.1e apart\n", rows.back().first.c_str(), off);
    EXPECT_LT(off, most) << rows.back().first;
  }
}

// Two halves with Maxwell elements of their own, condensed: exact for any step, where the whole
// body integrated in time converges to it with the square of the step.
TEST(FullSimulation, RegionsThatRelaxApartAreTheLimitOfItsSteps) {
  Model model = model_of({{"elastic", {2e4, 0.4}}, {"viscoelastic", {1e4, 0.1}}});
  const auto add = [&](const char* effect, const char* name, int region, double value) {
    Parameter p = *model.find(effect, 0, name);
    p.region = region;
    p.value = value;
    model.parameters.push_back(p);
  };
  add("elastic", "E", 1, 1e4);
  add("viscoelastic", "E1", 1, 2e4);
  add("viscoelastic", "tau1", 1, 0.5);
  for (const int region : {0, 1})
    for (Parameter p :
         effect_rows(*find_effect("regions"), 1, {region == 0 ? 0.018 : 0.042, 0.025, 0})) {
      if (p.name == "local" && region > 0) continue;
      if (p.name != "local") {
        p.name = p.name.substr(0, 1) + "1";
        p.region = region;
      }
      p.state = ParameterState::kFixed;
      model.parameters.push_back(p);
    }
  double error[2];
  for (const int finer : {0, 1}) {
    const int steps = finer == 1 ? 40 : 20;  // a ramp of 0.1 s and a hold of as long
    std::vector<Vec3> way;
    for (int i = 0; i <= 2 * steps; ++i)
      way.push_back(std::min(1.0, static_cast<double>(i) / steps) * Vec3(2e-4, 0, -1e-3));
    Recording r = motion(way, 0.1 / steps, {0.03, 0.025, 0.03});
    r.metadata.set("tool_radius", "0.009");
    const Dataset dataset = make_dataset(r);
    const OwnMesh body(block(), model, dataset.positions, 0.009, SolverKind::kDirect);
    EXPECT_TRUE(body.is_regional());
    const Eigen::VectorXd f =
        model_forces(
            model, dataset, [&](std::size_t p) { return body.at(p); }, all_episodes(dataset), false)
            .f;
    FullOptions options;
    options.own_mesh = true;
    options.averaged = false;
    const std::vector<Vec3> full = simulate_full(block(), model, r, options).force;
    std::vector<Vec3> condensed;
    for (Eigen::Index i = 0; i < f.size(); i += 3) condensed.push_back(f.segment<3>(i));
    error[finer] = difference(full, condensed);
    std::printf("regions that relax apart, %d steps: %.1e from the condensed forces\n", 2 * steps,
                error[finer]);
  }
  EXPECT_LT(error[1], 1e-6);
  EXPECT_NEAR(std::log2(error[0] / error[1]), 2, 0.3);
}

// Finite strain starts as the linear body, with what the elements of both laws differ by.
TEST(FullSimulation, SmallPressesOfFiniteStrainAreLinear) {
  const Recording r = motion({{0, 0, -1e-6}, {1e-6, 0, -1e-6}}, 0);
  FullOptions options = coarse();
  options.averaged = false;
  const auto linear = simulate_full(block(), model_of({{"elastic", {2e4, 0.4}}}), r, options);
  const auto finite = simulate_full(
      block(), model_of({{"elastic", {2e4, 0.4}}, {"hyperelastic", {0.15, 1}}}), r, options);
  EXPECT_LT(difference(finite.force, linear.force), 2e-3);
}

TEST(FullSimulation, GivenForcesFindTheDisplacements) {
  const Model model = model_of(
      {{"elastic", {2e4, 0.4}}, {"viscoelastic", {1e4, 0.3}}, {"hyperelastic", {0.15, 1}}});
  Recording r = motion({{0, 0, -5e-4}, {2e-4, 0, -1e-3}}, 0.1);
  FullOptions options = coarse();
  r.f = simulate_full(block(), model, r, options).force;
  options.force_control = true;
  const FullResult found = simulate_full(block(), model, r, options);
  EXPECT_LT(difference(found.motion, r.u), 1e-6);
  EXPECT_LT(difference(found.force, r.f), 1e-6);
}

// Two tools at once on the body's own mesh: what each feels is the sum of what both do.
TEST(FullSimulation, SeveralToolsSuperpose) {
  const Model model = model_of({{"elastic", {2e4, 0.4}}});
  const Vec3 places[2] = {{0.02, 0.025, 0.03}, {0.04, 0.025, 0.03}};
  const auto pressed = [&](const Vec3& a, const Vec3& b) {
    Recording r = motion({a, b}, 0);
    r.metadata.set("tool_radius", "0.009");
    for (int k = 0; k < 2; ++k) r.position[static_cast<std::size_t>(k)] = places[k];
    r.extra_header = {"tool_id"};
    r.extra = {{"left", "right"}};
    return simulate_full(block(), model, r, {}).force;
  };
  const Vec3 u(0, 1e-4, -1e-3), v(3e-4, 0, -5e-4), none = Vec3::Zero();
  const auto a = pressed(u, none), b = pressed(none, v), both = pressed(u, v);
  for (std::size_t k = 0; k < 2; ++k)
    EXPECT_LT((both[k] - a[k] - b[k]).norm(), 1e-8 * both[k].norm());
  EXPECT_NEAR(a[1].dot(v), b[0].dot(u), 1e-8 * std::abs(a[0].dot(u)));
}

// Presses of two tools that lie between each other's are one body: the same as one press whose
// tools are away where they have no row.
TEST(FullSimulation, PressesAtOnceAreOneBody) {
  const Model model = model_of({{"elastic", {2e4, 0.4}}, {"viscoelastic", {1e4, 0.3}}});
  struct Row {
    int press;
    double t;
    bool left, touches;
    Vec3 u;
  };
  const auto felt = [&](const std::vector<Row>& rows) {
    Recording r;
    r.name = "motion.csv";
    r.metadata.set("tool_radius", "0.009");
    r.extra_header = {"tool_id"};
    r.extra.resize(1);
    for (const Row& row : rows) {
      r.line.push_back(static_cast<long>(r.line.size()) + 2);
      r.press.push_back(row.press);
      r.t.push_back(row.t);
      r.position.emplace_back(row.left ? 0.02 : 0.04, 0.025, 0.03);
      r.u.push_back(row.u);
      r.contact.push_back(row.touches ? 1 : 0);
      r.extra[0].push_back(row.left ? "left" : "right");
    }
    return simulate_full(block(), model, r, {}).force;
  };
  const Vec3 u(0, 1e-4, -1e-3), v(3e-4, 0, -5e-4), none = Vec3::Zero();
  const auto apart = felt({{1, 0, true, true, u},
                           {1, 0.1, true, true, u},
                           {2, 0.1, false, true, v},
                           {1, 0.2, true, false, none},
                           {2, 0.2, false, true, v}});
  const auto common = felt({{1, 0, true, true, u},
                            {1, 0, false, false, none},
                            {1, 0.1, true, true, u},
                            {1, 0.1, false, true, v},
                            {1, 0.2, true, false, none},
                            {1, 0.2, false, true, v}});
  const std::size_t same[] = {0, 2, 3, 4, 5};
  for (std::size_t k = 0; k < 5; ++k)
    EXPECT_LT((apart[k] - common[same[k]]).norm(), 1e-9 * apart[0].norm()) << k;
  EXPECT_LT(apart[3].norm(), 1e-9 * apart[0].norm());  // away
  EXPECT_GT(apart[4].norm(), 0.3 * apart[0].norm());
}

TEST(FullSimulation, SaysWhereItFails) {
  const Model finite = model_of({{"elastic", {2e4, 0.4}}, {"hyperelastic", {0, 1}}});
  const auto fails = [](const Model& model, const Recording& r, const FullOptions& options,
                        ExitCode code) {
    return error_of([&] { simulate_full(block(), model, r, options); }, code);
  };
  EXPECT_NE(
      fails(finite, motion({{0, 0, -1e-3}, {0, 0, -0.028}}, 0), coarse(), ExitCode::kNoConvergence)
          .find("motion.csv:3: the body was deformed to"),
      std::string::npos);
  const Model soft = model_of({{"elastic", {2e4, 0.4}}, {"softening", {0.2, 2, 0.9, 2, 0}}});
  EXPECT_NE(
      fails(soft, motion({{0, 0, -1e-3}}, 0), coarse(), ExitCode::kBadInput).find("softening"),
      std::string::npos);
  FullOptions own;
  own.own_mesh = true;
  EXPECT_NE(fails(finite, motion({{0, 0, -1e-3}}, 0, {0.01, 0.01, 0.2}), own, ExitCode::kBadInput)
                .find("motion.csv:2"),
            std::string::npos);
  Recording near = motion({{0, 0, -1e-3}, {0, 0, -1e-3}}, 0);
  near.metadata.set("tool_radius", "0.009");
  near.position = {Vec3(0.02, 0.025, 0.03), Vec3(0.021, 0.025, 0.03)};
  near.extra_header = {"tool_id"};
  near.extra = {{"left", "right"}};
  EXPECT_NE(fails(model_of({{"elastic", {2e4, 0.4}}}), near, {}, ExitCode::kBadInput)
                .find("motion.csv:3: this place overlaps that of motion.csv:2"),
            std::string::npos);
}

}  // namespace
}  // namespace hapsim
