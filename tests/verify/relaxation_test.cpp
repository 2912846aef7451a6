// Bodies that relax, pressed with displacements and with forces, by one tool and by several.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>

#include "material/hooke_law.h"
#include "material/hyperelastic_law.h"
#include "nonlinear/tool_body.h"
#include "support/block_mesh.h"

namespace hapsim {
namespace {

const std::vector<Relaxation> kTerms{{0.6, 0.3}, {0.2, 5}, {0.4, 0.02}, {0.1, 60}};

std::vector<int> nodes_about(const TetMesh& mesh, const Vec3& point, double radius) {
  std::vector<int> nodes;
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
    if ((mesh.nodes[n] - point).norm() < radius && !mesh.fixed[n])
      nodes.push_back(static_cast<int>(n));
  return nodes;
}

const Vec3 kSize(0.04, 0.05, 0.03);
BodyTool tool_at(const TetMesh& mesh, double x, double y) {
  return {nodes_about(mesh, {x, y, kSize.z()}, 0.012), {}};
}

// Convolution of the relaxation function with a way that is straight between its corners: each ramp
// of rate v from t0 gives v (s + sum g tau (1 - exp(-s/tau))), s = t - t0.
double relaxed(const std::vector<std::array<double, 2>>& corners,
               const std::vector<Relaxation>& terms, double t) {
  double sum = 0, rate = 0;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const double next = k + 1 < corners.size() ? (corners[k + 1][1] - corners[k][1]) /
                                                     (corners[k + 1][0] - corners[k][0])
                                               : 0;
    const double s = t - corners[k][0];
    if (s <= 0) break;
    double ramp = s;
    for (const Relaxation& r : terms) ramp += r.share * r.tau * (1 - std::exp(-s / r.tau));
    sum += (next - rate) * ramp;
    rate = next;
  }
  return sum;
}

// One to four terms: ramp and hold, cycles, steps that change: as exact as the elastic solution,
// for elements of both orders.
TEST(Relaxation, RampHoldAndCyclesAreTheClosedForms) {
  const std::vector<std::array<double, 2>> way{{0, 0},     {0.25, 1},  {3, 1},     {3.5, 0.2},
                                               {3.9, 0.8}, {4.3, 0.2}, {4.7, 0.8}, {5.1, 0.2},
                                               {5.5, 0.8}, {100, 0.8}};
  double worst = 0;
  for (const int order : {1, 2})
    for (std::size_t count = 1; count <= 4; ++count) {
      const TetMesh mesh = test::block_mesh(kSize, 3, 3, 2, order, 0.15);
      const std::vector<Relaxation> terms(kTerms.begin(), kTerms.begin() + count);
      BodyModel model{&mesh, {isotropic_law(1e4, 0.4)}};
      const BodyTool tool = tool_at(mesh, 0.02, 0.025);
      ToolBody elastic(model, {tool}), body(model, {tool}, {terms});
      const Vec3 unit(0.3e-3, 0, -1e-3);
      ASSERT_TRUE(elastic.step({{unit, false}}, 0).ok());
      const Vec3 k = elastic.force(0);
      double t = 0;
      for (std::size_t c = 1; c < way.size(); ++c) {
        const int steps = c == way.size() - 1 ? 3 : 1 + static_cast<int>(c % 4);
        const double begin = way[c - 1][0], from = way[c - 1][1];
        for (int i = 1; i <= steps; ++i) {
          const double share = std::pow(static_cast<double>(i) / steps, 1.7);
          const double next = begin + share * (way[c][0] - begin);
          const double depth = from + share * (way[c][1] - from);
          ASSERT_TRUE(body.step({{depth * unit, false}}, next - t).ok());
          t = next;
          const double error = (body.force(0) - relaxed(way, terms, t) * k).norm() / k.norm();
          worst = std::max(worst, error);
        }
      }
    }
  std::printf("relaxation, ramps, holds and cycles: worst error %.1e of the elastic force\n",
              worst);
  EXPECT_LT(worst, 1e-8);
}

// A force that jumps and stays: the displacement creeps as J(t) = (1 - g/(1 + g) exp(-t/tau_c))/k,
// tau_c = (1 + g) tau. The way is curved within a step, so the error falls with the step squared;
// two steps extrapolate.
TEST(Relaxation, CreepIsTheClosedForm) {
  const double g = 0.6, tau = 0.3;
  const TetMesh mesh = test::block_mesh(kSize, 1, 1, 1, 1);
  BodyModel model{&mesh, {isotropic_law(1e4, 0.4)}};
  const BodyTool tool = tool_at(mesh, 0, 0);
  ASSERT_FALSE(tool.nodes.empty());
  ToolBody elastic(model, {tool});
  const Vec3 force(0.001, 0, 0.02);
  ASSERT_TRUE(elastic.step({{force, true}}, 0).ok());
  EXPECT_LT((elastic.force(0) - force).norm(), 1e-8 * force.norm());
  const Vec3 unit = elastic.motion(0);
  const auto creep = [&](int steps) {
    ToolBody body(model, {tool}, {{{g, tau}}});
    EXPECT_TRUE(body.step({{force, true}}, 0).ok());
    for (int k = 0; k < steps; ++k) EXPECT_TRUE(body.step({{force, true}}, 0.9 / steps).ok());
    return body.motion(0);
  };
  const Vec3 known = (1 - g / (1 + g) * std::exp(-0.9 / ((1 + g) * tau))) * unit;
  const Vec3 a = creep(100), b = creep(200), c = creep(400);
  const double ea = (a - known).norm(), eb = (b - known).norm(), ec = (c - known).norm();
  const double extrapolated = ((4 * c - b) / 3 - known).norm() / known.norm();
  std::printf("creep: error %.1e, %.1e, %.1e, rate %.3f, extrapolated %.1e\n", ea / known.norm(),
              eb / known.norm(), ec / known.norm(), std::log2(eb / ec), extrapolated);
  EXPECT_NEAR(std::log2(ea / eb), 2, 0.05);
  EXPECT_NEAR(std::log2(eb / ec), 2, 0.05);
  EXPECT_LT(extrapolated, 1e-8);
}

// A column of two layers with different terms, nu = 0: two Maxwell solids in series, integrated by
// Runge and Kutta's method with steps a thousand times finer.
class Series {
 public:
  std::array<double, 2> modulus, length;
  std::array<std::vector<Relaxation>, 2> terms;
  // Force a unit area while the end moves as u(t).
  template <class Way>
  double force(const Way& u, double end, int steps) const {
    std::vector<double> q(terms[0].size() + terms[1].size(), 0.0);  // viscous strains
    const double h = end / steps;
    const auto shifted = [&](const std::vector<double>& k, double by) {
      std::vector<double> result = q;
      for (std::size_t i = 0; i < q.size(); ++i) result[i] += by * k[i];
      return result;
    };
    for (int i = 0; i < steps; ++i) {
      const double t = i * h;
      const auto k1 = rates(q, u(t));
      const auto k2 = rates(shifted(k1, h / 2), u(t + h / 2));
      const auto k3 = rates(shifted(k2, h / 2), u(t + h / 2));
      const auto k4 = rates(shifted(k3, h), u(t + h));
      for (std::size_t j = 0; j < q.size(); ++j)
        q[j] += h / 6 * (k1[j] + 2 * k2[j] + 2 * k3[j] + k4[j]);
    }
    return stress(q, u(end));
  }

 private:
  // stress = stiff_i e_i - held_i in both, e_1 L_1 + e_2 L_2 = u.
  void parts(const std::vector<double>& q, std::array<double, 2>& stiff,
             std::array<double, 2>& held) const {
    std::size_t at = 0;
    for (std::size_t i = 0; i < 2; ++i) {
      stiff[i] = modulus[i];
      held[i] = 0;
      for (const Relaxation& r : terms[i]) {
        stiff[i] += modulus[i] * r.share;
        held[i] += modulus[i] * r.share * q[at++];
      }
    }
  }
  double stress(const std::vector<double>& q, double u) const {
    std::array<double, 2> s, h;
    parts(q, s, h);
    return (u - length[0] * h[0] / s[0] - length[1] * h[1] / s[1]) /
           (length[0] / s[0] + length[1] / s[1]);
  }
  std::vector<double> rates(const std::vector<double>& q, double u) const {
    std::array<double, 2> s, h;
    parts(q, s, h);
    const double sigma = stress(q, u);
    std::vector<double> result;
    std::size_t at = 0;
    for (std::size_t i = 0; i < 2; ++i)
      for (const Relaxation& r : terms[i])
        result.push_back(((sigma + h[i]) / s[i] - q[at++]) / r.tau);
    return result;
  }
};

TEST(Relaxation, TwoRegionsWithDifferentTermsAreTheFineSteps) {
  const TetMesh plain = test::block_mesh({1, 1, 2}, 1, 1, 4, 2);
  TetMesh mesh = plain;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    double z = 0;
    for (int a = 0; a < 4; ++a) z += mesh.nodes[mesh.tets[t][a]].z() / 4;
    mesh.region[t] = z > 0.5;
  }
  const Series series{{1e4, 3e4}, {0.5, 1.5}, {{{{0.8, 0.2}, {0.3, 2}}, {{0.5, 0.7}}}}};
  BodyModel model{&mesh, {isotropic_law(1e4, 0), isotropic_law(3e4, 0)}};
  BodyTool top;
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
    if (mesh.nodes[n].z() > 2 - 1e-9) top.nodes.push_back(static_cast<int>(n));
  const auto way = [](double t) { return 1e-3 * (t + 0.3 * std::sin(3 * t)); };
  const double end = 1.5, known = series.force(way, end, 200000);
  const auto found = [&](int steps) {
    ToolBody body(model, {top}, {series.terms[0], series.terms[1]});
    for (int k = 1; k <= steps; ++k)
      EXPECT_TRUE(body.step({{{0, 0, way(end * k / steps)}, false}}, end / steps).ok());
    return -body.force(0).z();
  };
  const double a = found(50), b = found(100), c = found(200);
  const double extrapolated = (4 * c - b) / 3;
  std::printf("two regions: error %.1e, %.1e, %.1e, rate %.3f, extrapolated %.1e\n", a / known - 1,
              b / known - 1, c / known - 1, std::log2((b - known) / (c - known)),
              extrapolated / known - 1);
  EXPECT_NEAR(std::log2((a - known) / (b - known)), 2, 0.05);
  EXPECT_NEAR(std::log2((b - known) / (c - known)), 2, 0.05);
  EXPECT_NEAR(extrapolated / known, 1, 1e-8);
}

TEST(Relaxation, GoesOnFromAStoredState) {
  const TetMesh mesh = test::block_mesh(kSize, 3, 3, 2, 1, 0.15);
  for (const LawPointer& law : {isotropic_law(1e4, 0.4), exponential_law(4e3, 2, 2e4)}) {
    BodyModel model{&mesh, {law}};
    model.dilatation = Dilatation::kPatch;
    const std::vector<BodyTool> tools{tool_at(mesh, 0.02, 0.025)};
    ToolBody body(model, tools, {{kTerms[0], kTerms[1]}}),
        again(model, tools, {{kTerms[0], kTerms[1]}});
    const auto at = [](int k) { return Vec3(1e-4 * k, 0, -5e-4 * k); };
    for (int k = 1; k <= 4; ++k) ASSERT_TRUE(body.step({{at(k), false}}, 0.1 * k).ok());
    again.restore(body.state());
    for (int k = 3; k >= 1; --k) {
      ASSERT_TRUE(body.step({{at(k), false}}, 0.2).ok());
      ASSERT_TRUE(again.step({{at(k), false}}, 0.2).ok());
      EXPECT_LT((body.force(0) - again.force(0)).norm(), 1e-12 * body.force(0).norm());
    }
  }
}

// At finite strain: what is left after long is the elastic force, at once it is that of all terms,
// the same body turned gives the turned force, and a closed cycle costs work.
TEST(Relaxation, FiniteStrainHasItsLimitsAndDissipates) {
  const TetMesh mesh = test::block_mesh(kSize, 3, 3, 2, 1, 0.15);
  const LawPointer law = exponential_law(4e3, 2, 2e4);
  const std::vector<Relaxation> terms{{0.6, 0.3}, {0.2, 5}};
  const auto make = [&](const TetMesh& m, bool relaxes) {
    BodyModel model{&m, {law}};
    std::vector<std::vector<Relaxation>> r;
    if (relaxes) r.push_back(terms);
    BodyTool tool;
    tool.nodes = tool_at(mesh, 0.02, 0.025).nodes;
    return ToolBody(model, {tool}, r);
  };
  const Vec3 deep(0.002, 0, -0.007);
  ToolBody elastic = make(mesh, false), body = make(mesh, true);
  ASSERT_TRUE(elastic.step({{deep, false}}, 0).ok());
  ASSERT_TRUE(body.step({{deep, false}}, 0).ok());
  const double at_once = 1.8;
  EXPECT_LT((body.force(0) - at_once * elastic.force(0)).norm(), 1e-7 * elastic.force(0).norm());
  ASSERT_TRUE(body.step({{deep, false}}, 1e4).ok());
  ASSERT_TRUE(body.step({{deep, false}}, 1e4).ok());
  EXPECT_LT((body.force(0) - elastic.force(0)).norm(), 1e-3 * elastic.force(0).norm());

  const Eigen::Matrix3d R(Eigen::AngleAxisd(1.1, Vec3(1, -2, 0.5).normalized()));
  TetMesh turned = mesh;
  for (Vec3& p : turned.nodes) p = R * p;
  ToolBody cycle = make(mesh, true), other = make(turned, true);
  double work = 0;
  Vec3 place = Vec3::Zero(), force = Vec3::Zero();
  for (int k = 1; k <= 40; ++k) {
    const Vec3 next = 0.5 * (1 - std::cos(2 * M_PI * k / 40)) * deep;
    ASSERT_TRUE(cycle.step({{next, false}}, 0.05).ok());
    ASSERT_TRUE(other.step({{R * next, false}}, 0.05).ok());
    work -= 0.5 * (cycle.force(0) + force).dot(next - place);
    place = next;
    force = cycle.force(0);
    EXPECT_LT((other.force(0) - R * force).norm(), 1e-7 * elastic.force(0).norm());
  }
  EXPECT_GT(work, 0.05 * 0.5 * elastic.force(0).dot(-deep));
}

// Two bonded tools and a tip on one body: forces add up, work is reciprocal (Betti, 1872), and what
// is pressed with the force that a place costs comes to lie there.
TEST(Tools, SuperposeAndAreReciprocal) {
  const TetMesh mesh = test::block_mesh(kSize, 4, 5, 3, 2, 0.15);
  BodyModel model{&mesh, {isotropic_law(1e4, 0.4)}};
  const std::vector<BodyTool> tools{tool_at(mesh, 0.01, 0.0125), tool_at(mesh, 0.03, 0.0375)};
  const Vec3 f(0.01, -0.02, 0.05), g(-0.03, 0.01, 0.04);
  const auto pressed = [&](const Vec3& first, const Vec3& second) {
    ToolBody body(model, tools);
    EXPECT_TRUE(body.step({{first, true}, {second, true}}, 0).ok());
    return std::array<Vec3, 2>{body.motion(0), body.motion(1)};
  };
  const Vec3 none = Vec3::Zero();
  const auto a = pressed(f, none), b = pressed(none, g), both = pressed(f, g);
  EXPECT_NEAR(f.dot(b[0]), g.dot(a[1]), 1e-8 * std::abs(f.dot(a[0])));
  for (int k = 0; k < 2; ++k) EXPECT_LT((both[k] - a[k] - b[k]).norm(), 1e-7 * both[k].norm());
  ToolBody moved(model, tools);
  ASSERT_TRUE(moved.step({{both[0], false}, {g, true}}, 0).ok());
  EXPECT_LT((moved.force(0) - f).norm(), 1e-6 * f.norm());
  EXPECT_LT((moved.motion(1) - both[1]).norm(), 1e-6 * both[1].norm());
}

TEST(Tools, ATipFindsThePlaceOfItsForce) {
  const TetMesh mesh = test::block_mesh(kSize, 6, 7, 3, 2, 0);
  const Moduli m = moduli(1e4, 0.4);
  for (const LawPointer& law : {isotropic_law(1e4, 0.4), neo_hookean_law(m.mu, m.bulk)})
    for (const double friction : {0.0, 0.5}) {
      BodyModel model{&mesh, {law}};
      const SphericalTip tip{{0.02, 0.025, 0.03}, {0, 0, 1}, 0.012, 0.016, friction};
      const std::vector<BodyTool> tools{{{}, tip}, tool_at(mesh, 0.035, 0.045)};
      ToolBody given(model, tools), found(model, tools);
      const Vec3 place(0, 0, -0.002), beside(0, 0, -0.001);
      ASSERT_TRUE(given.step({{place, false}, {beside, false}}, 0).ok());
      const SolveReport report = found.step({{given.force(0), true}, {beside, false}}, 0);
      ASSERT_TRUE(report.ok()) << report.message << "; friction " << friction
                               << (law->small_strain() ? ", small" : ", finite");
      EXPECT_NEAR(found.motion(0).z(), place.z(), 1e-6 * 0.002);
      EXPECT_NEAR(found.force(0).z(), given.force(0).z(), 1e-7 * given.force(0).z());
    }
}

}  // namespace
}  // namespace hapsim
