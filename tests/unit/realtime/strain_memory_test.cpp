// What bodies of finite strain that relax remember: the polynomials, the work of the stresses of
// one state at another, and the force of the loop against its limits and against finite elements
// that step through the same motion.
#include "realtime/strain_memory.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "contact/contact_stiffness.h"
#include "realtime/force_loop.h"
#include "simulate/full_simulation.h"
#include "strained_body.h"

namespace hapsim {
namespace {

constexpr double kShare = 8e3 / 2e4;  // of strained_model(8e3)

const Vec3 kRelaxed(0.052, 0.047, 0.06);  // among the samples, at none of them

FullOptions sampling_options() {
  FullOptions options;
  options.rim_edge = 0.5;
  options.growth = 0.6;
  options.quarter_points = false;
  options.solve.past_instability = true;
  return options;
}

TEST(StrainMemory, MonomialsHaveTheirDerivatives) {
  const Vec3 v(0.7, 0.4, -0.6), rest(0.02, -0.01, 0.03);
  const MemoryPoint at = memory_point(v);
  EXPECT_EQ(at.m.head<3>(), v);
  for (int k = 0; k < 3; ++k) {
    const Vec3 h = 1e-5 * Vec3::Unit(k);
    EXPECT_LT(
        ((memory_point(v + h).m - memory_point(v - h).m) / 2e-5 - at.gradient.row(k).transpose())
            .norm(),
        1e-7);
  }
  // Along the tangent: both change as their own derivatives say.
  const MemoryPoint on = memory_point(v, rest);
  EXPECT_LT((on.m - at.m - at.gradient.transpose() * rest).norm(), 1e-12);
  const double h = 1e-5;
  EXPECT_LT((on.gradient - at.gradient -
             (memory_point(v + h * rest).gradient - memory_point(v - h * rest).gradient) / (2 * h))
                .norm(),
            1e-7);
}

TEST(StrainMemory, SetsAreOfDegreesAndWaysAcross) {
  const Vec3 v(0.7, 0.4, -0.6);
  const MemoryPoint at = memory_point(v);
  // 1; d, d^2; p, q, d p, d q: and no p^2.
  const MemorySet set = memory_set(0, 2, 1);
  ASSERT_EQ(set.size, 7);
  const MemoryPart<7> part(set, at);
  double sum = 0;
  for (const double m : {1.0, 0.7, 0.49, 0.4, -0.6, 0.28, -0.42}) sum += m;
  EXPECT_NEAR(part.m.sum(), sum, 1e-12);
  EXPECT_EQ(inside_ways().size, kInsideFields);
  EXPECT_EQ(inside_now().size, kInsideNow);
  EXPECT_EQ(inside_before().size, kInsideBefore);
}

TEST(StrainMemory, TurnedAxesAreTheSameWork) {
  StrainMemory of, turned;
  MemoryMatrix& C = of.C;
  for (int i = 0; i < C.size(); ++i) C.data()[i] = std::sin(1.3 * i + 0.2);
  InsideMemory& inside = of.inside;
  for (int i = 0; i < inside.g.size(); ++i) inside.g.data()[i] = std::sin(0.7 * i + 0.1);
  for (int i = 0; i < inside.w.size(); ++i) inside.w.data()[i] = std::cos(0.9 * i + 0.4);
  for (int n = 0; n < kInsideNow; ++n)  // symmetric, and for n = 0 positive definite
    for (int j = 0; j < kInsideFields; ++j)
      for (int k = 0; k < kInsideFields; ++k)
        inside.stiffness(j + kInsideFields * k, n) =
            n == 0 && j == k ? 500 : std::sin(0.3 * n + 0.1 * (j + k) + 0.5 * j * k);
  for (int m = 0; m < kInsideBefore; ++m)
    for (int j = 0; j < kInsideFields; ++j)
      for (int k = 0; k < kInsideFields; ++k)
        inside.stressed(j + kInsideFields * k, m) = std::cos(0.3 * m + 0.1 * (j + k) + 0.7 * j * k);
  const Eigen::Matrix3d Q =
      Eigen::AngleAxisd(0.7, Vec3::UnitX()).toRotationMatrix() * Vec3(1, -1, 1).asDiagonal();
  add_turned(of, Q, 2, turned);
  const Vec3 u(0.7, 0.4, -0.6), v(1.2, -0.3, 0.5);
  const double there = memory_point(Q * u).m.dot(C * memory_point(Q * v).m);
  EXPECT_NEAR(memory_point(u).m.dot(turned.C * memory_point(v).m), 2 * there,
              1e-9 * std::abs(there));
  // The same body and past in either axes: what the inside does is the same, too.
  InsideAmplitudes faded = InsideAmplitudes::Zero(), faded_there = faded;
  const MemoryPart<kInsideFields> x(inside_ways(), memory_point(v)),
      x_there(inside_ways(), memory_point(Q * v));
  const MemoryPart<kInsideNow> n(inside_now(), memory_point(0.5 * v)),
      n_there(inside_now(), memory_point(0.5 * Q * v));
  faded = 0.02 * x.m * n.m.transpose();
  faded_there = 0.02 * x_there.m * n_there.m.transpose();
  const InsideForce here =
                        inside_force(turned.inside, memory_point(u), memory_point(v).m, faded, 0.3),
                    other = inside_force(of.inside, memory_point(Q * u), memory_point(Q * v).m,
                                         faded_there, 0.3);
  ASSERT_TRUE(here.held && other.held);
  EXPECT_GT(here.f.norm(), 0.1);
  EXPECT_LT((Q * here.f - 2 * other.f).norm(), 1e-9 * here.f.norm());
}

// W by the fit against its integral, and both forces: those of one state are the static ones.
TEST(StrainMemory, IsTheIntegralOverTheElements) {
  const TetMesh mesh = test::block_mesh({0.05, 0.05, 0.03}, 2, 2, 2, 1);
  const Model model = static_part(test::strained_model());
  const double a = test::kStrainedRadius;
  const Vec3 place(0.026, 0.023, 0.03);
  FullPress press(mesh, model, place, a, sampling_options());
  std::string why;
  const auto sample =
      solve_strain_sample(mesh, make_contact_base(mesh), model, place, a, 1, true, why);
  ASSERT_TRUE(sample && sample->memory) << why;
  EXPECT_LT(sample->memory_fit, 0.02);
  const Eigen::Matrix3d inside = sample->frame * sample->K * sample->frame.transpose();
  MemoryMatrix C = sample->memory->C;
  C.topLeftCorner<3, 3>() += inside / inside(0, 0);
  std::vector<StressResponse> responses;
  std::vector<Vec3> v;
  for (const Vec3& at : {Vec3(0.4, 0.2, 0.1), Vec3(0.9, -0.4, 0.3), Vec3(0.7, 0.1, -0.5)}) {
    const Vec3 f = -press.step(a * sample->frame.transpose() * at, 0);
    const auto response = press.stress_response();
    ASSERT_TRUE(response);
    responses.push_back(*response);
    v.push_back(at);
    const MemoryPoint p = memory_point(at);
    const Vec3 by = inside(0, 0) * a * sample->frame.transpose() * (p.gradient * (C * p.m));
    EXPECT_LT((by - f).norm(), 0.02 * f.norm());
  }
  StressStates states(sample->frame, a, inside(0, 0) * a * a, v, 1);
  states.add([&](std::size_t i) { return responses[i]; });
  const Eigen::MatrixXd &W = states.works(), &F = states.forces();
  StressStates parts(sample->frame, a, inside(0, 0) * a * a, v, 1);
  const Eigen::Index numbers = responses[0].stress.size();
  for (const auto& [from, rows] :
       {std::pair{Eigen::Index{0}, numbers / 3}, {numbers / 3, numbers - numbers / 3}})
    parts.add([&, from = from, rows = rows](std::size_t i) {
      StressResponse part;
      part.stress = responses[i].stress.segment(from, rows);
      part.strain = responses[i].strain.segment(from, rows);
      part.changes = responses[i].changes.middleRows(from, rows);
      part.work = responses[i].work.middleRows(from, rows);
      return part;
    });
  EXPECT_LT((parts.works() - W).norm(), 1e-5 * W.norm());
  EXPECT_LT((parts.forces() - F).norm(), 1e-5 * F.norm());
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) {
      const MemoryPoint now = memory_point(v[static_cast<std::size_t>(j)]),
                        before = memory_point(v[static_cast<std::size_t>(i)]);
      EXPECT_NEAR(now.m.dot(C * before.m), W(j, i), 0.02 * W(j, i));
      const Vec3 f = F.block<3, 1>(3 * j, 4 * i);
      EXPECT_LT((now.gradient * (C * before.m) - f).norm(), 0.03 * f.norm());
    }
}

// A jump bears the static force and all of the Maxwell elements', an endless hold the static alone.
TEST(StrainMemory, FastAndSlowAreMultiplesOfTheStaticForce) {
  const PreparedBody& body = test::relaxing_body();
  const SurfaceSide side = body.distance().at(kRelaxed);
  const LargeStrain::Place place =
      body.large_strain()->at(body.facts().at(side.face, side.point, side.normal));
  for (const Vec3& u : {Vec3(0, 0, -0.012), Vec3(0.003, 0.002, -0.01), Vec3(-0.002, 0, -0.004)}) {
    const Vec3 still = -body.large_strain()->force(place, u).f;
    ForceLoop loop(body);
    loop.begin(kRelaxed);
    const Vec3 fast = loop.press(0, u);
    EXPECT_LT((fast - (1 + kShare) * still).norm(), 0.01 * fast.norm());
    const Vec3 slow = loop.press(50, u);
    EXPECT_LT((slow - still).norm(), 1e-9 * slow.norm());
  }
}

TEST(StrainMemory, AClosedWayTakesEnergy) {
  const PreparedBody& body = test::relaxing_body();
  const double a = test::kStrainedRadius;
  for (const double period : {0.05, 0.3, 1.3, 10.0}) {
    ForceLoop loop(body);
    loop.begin(kRelaxed);
    double work = 0, size = 0;
    const int steps = 2000;
    const auto way = [&](int i) {
      const double angle = 2 * std::numbers::pi * i / steps;
      return Vec3(0.4 * a * std::sin(angle), 0.3 * a * std::sin(2 * angle),
                  -0.7 * a * (1 - std::cos(angle)));
    };
    Vec3 before = loop.press(0, way(0));
    for (int i = 1; i <= steps; ++i) {
      const Vec3 f = loop.press(period * i / steps, way(i));
      const double done = -0.5 * (f + before).dot(way(i) - way(i - 1));
      work += done;
      size += std::abs(done);
      before = f;
    }
    EXPECT_GT(work, period > 5 ? -1e-4 * size : 0.01 * size) << period;
  }
}

// Two Maxwell elements, one fast and one slow against the press, a hold, a retreat, where the force
// passes through zero and is what the inside does otherwise, and a press from there.
TEST(StrainMemory, IsTheElementsAlongAPressAndItsRetreat) {
  Model model = test::strained_model(8e3);
  for (const auto& [name, value] : {std::pair{"E2", 6e3}, {"tau2", 2.0}}) {
    Parameter p = *model.find("viscoelastic", 0, "E1");
    p.name = name;
    p.value = value;
    model.parameters.push_back(p);
  }
  test::relaxing_body();  // has the samples made
  const PreparedBody body(test::strained_mesh(), model, test::strained_options());
  ASSERT_EQ(body.terms().size(), 2u);
  const TetMesh mesh = test::strained_mesh();
  FullPress press(mesh, model, kRelaxed, test::kStrainedRadius, sampling_options());
  const SurfaceSide side = body.distance().at(kRelaxed);
  const StepPlace at = body.facts().at(side.face, side.point, side.normal);
  const double ratio = at.contact.K(2, 2) / (*press.stiffness())(2, 2);
  ForceLoop loop(body);
  loop.begin(kRelaxed);
  double peak = 0, worst = 0, worst_back = 0;
  int covered = 0, steps = 0;
  for (int i = 0; i <= 50; ++i) {
    const double down = std::min(1.0, i / 15.0), back = std::clamp((i - 25) / 15.0, 0.0, 1.0),
                 again = std::max(0.0, (i - 40) / 15.0);
    const Vec3 u = test::kStrainedRadius * (down * (1 - back) + again) * Vec3(0.3, 0.1, -1.3);
    const Vec3 f = ratio * press.step(u, 0.02), got = loop.press(0.02 * i, u);
    peak = std::max(peak, f.norm());
    if (i == 0) continue;
    const double off = (got - f).norm();
    if (back > 0)
      worst_back = std::max(worst_back, off / peak);
    else
      worst = std::max(worst, off / std::max(f.norm(), 0.05 * peak));
    covered += off <= 1.96 * loop.uncertainty() * got.norm() ? 1 : 0;
    ++steps;
  }
  EXPECT_LT(worst, 0.04);
  EXPECT_LT(worst_back, 0.02);
  EXPECT_GE(covered, steps - 2);
}

TEST(StrainMemory, GoesOnFromAStoredState) {
  const PreparedBody& body = test::relaxing_body();
  ForceLoop loop(body), other(body);
  loop.begin(kRelaxed);
  for (int i = 0; i <= 10; ++i) loop.press(0.01 * i, Vec3(1e-4 * i, 0, -1e-3 * i));
  other.restore(loop.state());
  const Vec3 u(1e-3, 2e-3, -8e-3);
  EXPECT_EQ(loop.press(0.15, u), other.press(0.15, u));
}

}  // namespace
}  // namespace hapsim
