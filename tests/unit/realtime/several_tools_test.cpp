// Several tools on one body against finite elements of both, against one tool, and in time.
#include "realtime/several_tools.h"

#include <gtest/gtest.h>

#include <cmath>

#include "effects/catalogue.h"
#include "realtime/device_link.h"
#include "simulate/full_contact.h"
#include "simulate/full_simulation.h"
#include "support/block_mesh.h"
#include "support/shapes.h"
#include "tetmesh/body_mesh.h"

namespace hapsim {
namespace {

constexpr double kToolRadius = 0.004;

Model model_of(double nu, std::vector<double> terms = {}) {
  Model model;
  const auto add = [&](const char* name, std::size_t count, const std::vector<double>& values) {
    for (const Effect* effect : catalogue())
      if (effect->card().name == name)
        for (const Parameter& p : effect_rows(*effect, count, values))
          model.parameters.push_back(p);
  };
  add("elastic", 1, {2e4, nu});
  if (!terms.empty()) add("viscoelastic", terms.size() / 2, terms);
  return model;
}

TetMesh coarse_block() {
  return test::block_mesh({0.08, 0.08, 0.04}, 7, 7, 4, 1);
}

struct Prepared {
  explicit Prepared(const Model& model, const std::vector<KnownStiffness>& known = {})
      : mesh(coarse_block()),
        body(mesh, model, options(known)),
        coupling(mesh, model, kToolRadius) {}
  static PreparedBodyOptions options(const std::vector<KnownStiffness>& known) {
    PreparedBodyOptions options;
    options.tool_radius = kToolRadius;
    options.most_samples = 16;
    options.rim_edge = 0.5;  // no test of it: quick
    if (!known.empty()) options.contacts = [known](const MaterialSpec&) { return known; };
    return options;
  }
  TetMesh mesh;
  PreparedBody body;
  ToolCoupling coupling;
};

Vec3 way_of(int i) {
  const double t = 0.01 * i;
  return {0.04 + 1e-3 * std::sin(3 * t), 0.042, 0.0405 - 0.002 * std::sin(4 * t)};
}

TEST(SeveralTools, OneIsTheLoop) {
  const Model model = model_of(0.4, {8e3, 0.1, 4e3, 0.7});
  const Prepared p(model);
  SeveralTools tools(p.body, nullptr, 1);
  ForceLoop loop(p.body);
  double most = 0;
  for (int i = 0; i < 400; ++i) {
    const ToolPose pose{.point = way_of(i)};
    const Vec3 f = loop.step(0.01 * i, pose.point);
    const ToolFeel& feel = tools.step(0.01 * i, {&pose, 1})[0];
    ASSERT_LT((feel.force - f).norm(), 1e-12);
    ASSERT_EQ(feel.in_air, !loop.tool().touching());
    if (!feel.in_air) {
      ASSERT_LT((feel.point + feel.u - pose.point).norm(), 1e-15);
    }
    most = std::max(most, f.norm());
  }
  EXPECT_GT(most, 0.1);
}

// Both tools on one mesh that is fine under each, as hs-simulate --full takes a recording with
// tool_id; each tool by itself is known from that mesh, so the difference is what they do to each
// other.
TEST(SeveralTools, PressOnEachOtherAsElementsOfBothDo) {
  for (const double apart : {2.5, 6.0}) {
    const std::vector<Vec3> places{{0.04 - 0.5 * apart * kToolRadius, 0.042, 0.04},
                                   {0.04 + 0.5 * apart * kToolRadius, 0.038, 0.04}};
    BodyOptions fine_options;
    fine_options.edge = 0.012;
    fine_options.contacts = places;
    fine_options.tool_radius = kToolRadius;
    fine_options.contact_size = kToolRadius / 3;
    fine_options.order = 2;
    const TetMesh fine = make_body_mesh(test::box({0.08, 0.08, 0.04}, 4), fine_options);
    const Model model = model_of(0.45);
    const std::vector<Lame> constants(fine.tets.size(), lame(2e4, 0.45));
    std::vector<KnownStiffness> known;
    std::vector<RigidPatch> patches;
    for (const Vec3& place : places) {
      const FullContact c = full_contact(fine, place, kToolRadius);
      patches.push_back({c.nodes, c.point});
      known.push_back({c.point, c.normal,
                       rigid_stiffness(fine, {patches.back()}, constants).topLeftCorner<3, 3>()});
    }
    const Prepared p(model, known);
    Recording r;
    r.name = "two.csv";
    r.metadata.set("tool_radius", "0.004");
    r.extra_header = {"tool_id"};
    r.extra = {{"left", "right"}};
    const Vec3 u[] = {{2e-4, 0, -1e-3}, {0, -3e-4, -6e-4}};
    std::vector<ToolPose> poses(2);
    for (std::size_t k = 0; k < 2; ++k) {
      r.line.push_back(1);
      r.press.push_back(1);
      r.position.push_back(places[k]);
      r.u.push_back(u[k]);
      poses[k].point = places[k];
      poses[k].u = u[k];
    }
    const std::vector<Vec3> full = simulate_full(fine, model, r, {.own_mesh = true}).force;
    SeveralTools tools(p.body, &p.coupling, 2);
    const auto both = tools.press(0, poses);
    // Forces and torques of the nodal tractions.
    Eigen::Matrix<double, 12, 1> d;
    for (int k = 0; k < 2; ++k) d.segment<6>(6 * k) << u[k], Vec3::Zero();
    const Eigen::VectorXd exact = -rigid_stiffness(fine, patches, constants) * d;
    const double norm = full[0].norm();
    for (int k = 0; k < 2; ++k) {
      const Vec3 alone = -known[k].K * u[k];
      const Vec3 torque = exact.segment<3>(6 * k + 3);
      std::printf(
          "%g radii apart, tool %d: force off by %.2f %% of the larger one, by %.1f %% alone; "
          "torque by %.2f %% of the radius times it, it is %.1f %%\n",
          apart, k, 100 * (both[k].force - full[k]).norm() / norm,
          100 * (alone - full[k]).norm() / norm,
          100 * (both[k].torque - torque).norm() / (kToolRadius * norm),
          100 * torque.norm() / (kToolRadius * norm));
      EXPECT_LT((Vec3(exact.segment<3>(6 * k)) - full[k]).norm(), 1e-6 * norm);
      // Nearer than this the other's patch, which does not yield, stiffens the surface about it.
      EXPECT_LT((both[k].force - full[k]).norm(), (apart < 3 ? 0.03 : 0.005) * norm);
      EXPECT_LT((both[k].force - full[k]).norm(), 0.25 * (alone - full[k]).norm());
      EXPECT_LT((both[k].torque - torque).norm(), 0.04 * kToolRadius * norm);
    }
  }
}

// Reciprocity: what one does to the other does not ask which.
TEST(SeveralTools, CouplingIsReciprocal) {
  const Prepared p(model_of(0.4));
  const auto a = p.coupling.patch({0.03, 0.04, 0.04}, {0, 0, 1}, 2e4);
  const auto b = p.coupling.patch({0.08, 0.04, 0.025}, {1, 0, 0}, 2e4);
  const Matrix6 there = p.coupling.between(a, b), back = p.coupling.between(b, a);
  EXPECT_LT((there - back.transpose()).norm(), 1e-12 * there.norm());
}

TEST(SeveralTools, TorqueOfATwistIsReissnersAndRelaxes) {
  const Prepared p(model_of(0.45, {2e4, 0.5}));
  SeveralTools tools(p.body, nullptr, 1);
  ToolPose pose;
  pose.point = {0.04, 0.04, 0.04};
  const double angle = 0.05, shear = 2e4 / 2.9;
  pose.turn = {0, 0, angle};
  const double relaxed = 16.0 / 3 * shear * std::pow(kToolRadius, 3) * angle;
  EXPECT_NEAR(tools.press(0, {&pose, 1})[0].torque.z(), -2 * relaxed, 1e-9 * relaxed);
  EXPECT_NEAR(tools.press(0.5, {&pose, 1})[0].torque.z(), -(1 + std::exp(-1)) * relaxed,
              1e-9 * relaxed);
  pose.turn = Vec3::Zero();
  pose.u = {0, 0, -1e-3};
  const ToolFeel feel = tools.press(1e3, {&pose, 1})[0];
  EXPECT_EQ(feel.torque_about(feel.point + feel.u), feel.torque);
  EXPECT_LT(feel.torque.norm(), 1e-3 * relaxed);  // tau over the time in which it turned back
  const Vec3 lever(0.01, 0, 0.1);
  EXPECT_LT((feel.torque_about(feel.point + feel.u + lever) - feel.torque + lever.cross(feel.force))
                .norm(),
            1e-12);
}

TEST(SeveralTools, TurnsCountFromTheTouch) {
  const Prepared p(model_of(0.4));
  SeveralTools tools(p.body, nullptr, 1);
  ToolPose pose;
  pose.point = {0.04, 0.04, 0.041};
  pose.turn = {3, 0, 0};
  for (int i = 0; i < 10; ++i) {
    const ToolFeel feel = tools.step(1e-3 * i, {&pose, 1})[0];
    EXPECT_LT(feel.torque.norm(), 1e-12);
    pose.point.z() -= 2e-4;
  }
  pose.turn = {3.01, 0, 0};
  EXPECT_NEAR(tools.step(0.01, {&pose, 1})[0].turn.x(), 0.01, 1e-12);
}

TEST(DeviceLink, AnswersWithoutLocksOrSaysHowOldItsForceIs) {
  const Prepared p(model_of(0.4));
  SeveralTools tools(p.body, nullptr, 1);
  ForceLoop loop(p.body);
  DeviceLink link(tools);
  ToolFeel feel;
  for (int i = 0; i < 200; ++i) {
    const ToolPose pose{.point = way_of(i)};
    const auto age = link.exchange(0.01 * i, {&pose, 1}, {&feel, 1}, 10'000'000'000);
    ASSERT_EQ(age, 0U);
    ASSERT_LT((feel.force - loop.step(0.01 * i, pose.point)).norm(), 1e-12);
  }
  // Without a wait the answer is one of before, which it says, or already there.
  const ToolPose pose{.point = way_of(0)};
  EXPECT_LE(link.exchange(21, {&pose, 1}, {&feel, 1}, 0), 1U);
}

}  // namespace
}  // namespace hapsim
