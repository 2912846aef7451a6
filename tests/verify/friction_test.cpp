// A spherical tip that sticks or slips on a half-space.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "material/hooke_law.h"
#include "material/hyperelastic_law.h"
#include "nonlinear/nonlinear_body.h"
#include "nonlinear/sphere_contact.h"
#include "solid/elastic_body.h"
#include "support/graded_block.h"
#include "support/half_space.h"
#include "tetmesh/contact_mesh.h"

namespace hapsim {
namespace {

using Eigen::VectorXd;

constexpr double kRadius = 20;  // of the tip; contact radius 1

class Pressed {
 public:
  Pressed(const TetMesh& mesh, const LawPointer& law, double friction, double radius = kRadius,
          double reach = 1.7, Dilatation dilatation = Dilatation::kElement)
      : body_(model(mesh, law, dilatation), held(mesh)) {
    body_.add_tip({Vec3::Zero(), Vec3::UnitZ(), radius, reach, friction});
  }
  void to(const Vec3& motion) {
    body_.move_tip(0, motion);
    const SolveReport report = body_.solve(VectorXd());
    ASSERT_TRUE(report.ok()) << report.message;
  }
  Vec3 force() const { return body_.tip_force(0); }
  NonlinearBody& body() { return body_; }

 private:
  static BodyModel model(const TetMesh& mesh, const LawPointer& law, Dilatation dilatation) {
    BodyModel m{&mesh, {law}};
    m.dilatation = dilatation;
    return m;
  }
  static std::vector<int> held(const TetMesh& mesh) {
    std::vector<int> handle(mesh.nodes.size(), kFreeNode);
    for (std::size_t i = 0; i < handle.size(); ++i)
      if (mesh.fixed[i]) handle[i] = kHeldNode;
    return handle;
  }
  NonlinearBody body_;
};
const TetMesh& coarse() {
  static const TetMesh mesh = test::half_space(1.0 / 4).mesh;
  return mesh;
}
const TetMesh& fine() {
  static const TetMesh mesh = test::half_space(1.0 / 6).mesh;
  return mesh;
}

// The same discrete problem as SphereContact's, by another way.
TEST(TipFriction, WithoutFrictionItIsTheSphereContact) {
  const LawPointer law = isotropic_law(1, 0.3);
  Pressed p(coarse(), law, 0);
  BodyModel model{&coarse(), {law}};
  model.dilatation = Dilatation::kElement;
  SphereContact sphere(model, coarse().fixed, Vec3::Zero(), Vec3::UnitZ(), 1.7);
  for (const double depth : {0.02, 0.05, 0.03, -0.01}) {
    p.to({0.01, 0, -depth});
    const double expected = sphere.press(kRadius, depth).force;
    EXPECT_NEAR(-p.force().z(), expected, 1e-9 * (expected + 1e-6));
    EXPECT_LT(p.force().head<2>().norm(), 1e-12);
  }
}

// Cattaneo (1938) and Mindlin (J. Appl. Mech. 16, 1949); Johnson, Contact Mechanics, 1985, 7.42: a
// tip pressed with P, then moved sideways by d, on a half-space of modulus G:
//   d = 3 mu P (2 - nu)/(16 G a) (1 - (1 - Q/(mu P))^(2/3)),
// from 8 G a d/(2 - nu) at first to sliding with Q = mu P. It neglects the coupling of pressure and
// slip, which vanishes for nu = 0.5, and the tractions across the motion.
TEST(TipFriction, IsCattaneosAndMindlinsSideways) {
  const double nu = 0.49, mu = 0.3, depth = 1 / kRadius, G = 1 / (2 * (1 + nu));
  double worst[2] = {0, 0};
  for (const int level : {0, 1}) {
    const TetMesh& mesh = level == 0 ? coarse() : fine();
    Pressed p(mesh, isotropic_law(1, nu), mu);
    p.to({0, 0, -depth});
    const double P = -p.force().z(), a = std::sqrt(kRadius * depth);
    const double slides = 3 * mu * P * (2 - nu) / (16 * G * a);
    for (const double share : {0.05, 0.2, 0.4, 0.6, 0.8, 0.95, 1.3}) {
      p.to({share * slides, 0, -depth});
      const double Q = p.force().x(), normal = -p.force().z();
      const double known = mu * P * (share < 1 ? 1 - std::pow(1 - share, 1.5) : 1);
      EXPECT_LE(p.force().head<2>().norm(), mu * normal * (1 + 1e-9));
      worst[level] = std::max(worst[level], std::abs(Q - known) / (mu * P));
      EXPECT_NEAR(normal, P, 0.01 * P);
      if (share > 1) {
        EXPECT_NEAR(Q, mu * normal, 0.002 * mu * normal);
      }
    }
  }
  std::printf("Cattaneo-Mindlin: worst %.4f of mu P (coarser %.4f)\n", worst[1], worst[0]);
  EXPECT_LT(worst[1], 0.02);
  EXPECT_LT(worst[1], worst[0]);
}

// To and fro between +D and -D (Mindlin and Deresiewicz, J. Appl. Mech. 20, 1953): after the turn
// the force is the first branch's, doubled: Q = Q* - 2 Q_first((d* - d)/2).
TEST(TipFriction, TurnsAsMindlinAndDeresiewicz) {
  const double nu = 0.49, mu = 0.3, depth = 1 / kRadius, G = 1 / (2 * (1 + nu));
  Pressed p(fine(), isotropic_law(1, nu), mu), first(fine(), isotropic_law(1, nu), mu);
  p.to({0, 0, -depth});
  first.to({0, 0, -depth});
  const double P = -p.force().z(), slides = 3 * mu * P * (2 - nu) / (16 * G), turn = 0.7 * slides;
  for (int k = 1; k <= 7; ++k) p.to({0.1 * k * slides, 0, -depth});
  const double at_turn = p.force().x();
  for (const double back : {0.3, 0.8, 1.4}) {
    p.to({turn - back * slides, 0, -depth});
    first.to({back * slides / 2, 0, -depth});
    EXPECT_NEAR(p.force().x(), at_turn - 2 * first.force().x(), 0.02 * mu * P);
  }
}

// Normal force of a sticking sphere over Hertz's at the same depth d. Every increment is that of a
// bonded disc of the present radius a (Mossakovskii, J. Appl. Math. Mech. 27, 1963; Spence, Proc.
// R. Soc. Lond. A 305, 1968), dP/dd = 2 C E/(1 - nu^2) a, C = (1 - nu) log(3 - 4 nu)/(1 - 2 nu). A
// point at r has been lowered by all smaller discs when the contact reaches it, w(r/a) outside a
// disc of unit depth, so d = A a^2 with 1/(2 R) = A X, X = 1 - 2 int_0^1 w(1/s) s ds. With
//   w(r) = 2/pi cosh(pi k) int_0^1 cos(k log((1 + t)/(1 - t))) / sqrt(r^2 - t^2) dt,
// k = log(3 - 4 nu)/(2 pi) (1 at the rim; far away the force above), t = tanh x and the integral
// over s done, the ratio is C sqrt(2 X).
double sticking_ratio(double nu) {
  const double q = 3 - 4 * nu, k = std::log(q) / (2 * M_PI);
  constexpr int kPoints = 20000;
  constexpr double kEnd = 20;
  double sum = 0;
  for (int i = 0; i < kPoints; ++i) {
    const double x = (i + 0.5) * kEnd / kPoints, t = std::tanh(x), root = 1 / std::cosh(x);
    const double inner = t < 1e-2 ? 2.0 / 3 + t * t / 5 : (std::asin(t) - t * root) / (t * t * t);
    sum += std::cos(2 * k * x) * inner * root * root * kEnd / kPoints;
  }
  const double X = 1 - 2 * std::cosh(M_PI * k) / M_PI * sum;
  return (1 - nu) * std::log(q) / (1 - 2 * nu) * std::sqrt(2 * X);
}

TEST(TipFriction, StickingIsMossakovskiisForce) {
  const double depth = 1 / kRadius;
  for (const double nu : {0.0, 0.3}) {
    double found[2];
    for (const int level : {0, 1}) {
      const TetMesh& mesh = level == 0 ? coarse() : fine();
      Pressed sticks(mesh, isotropic_law(1, nu), kSticks), slides(mesh, isotropic_law(1, nu), 0);
      const int steps = 12 << level;
      for (int k = 1; k <= steps; ++k)
        sticks.to({0, 0, -depth * std::pow(static_cast<double>(k) / steps, 2)});
      slides.to({0, 0, -depth});
      found[level] = sticks.force().z() / slides.force().z();
    }
    const double known = sticking_ratio(nu);
    std::printf("sticking, nu %.1f: %.4f of the frictionless force (coarser %.4f), known %.4f\n",
                nu, found[1], found[0], known);
    EXPECT_NEAR(found[1], known, 0.015);
    EXPECT_LT(std::abs(found[1] - known), std::abs(found[0] - known));
  }
}

// Mindlin (1949): a contact of radius a that sticks resists small sideways motion with 8 G a/(2 -
// nu), here of a flat border that the pressure fixes.
TEST(TipFriction, StickingIsMindlinsStiffness) {
  const double nu = 0.49, depth = 1 / kRadius, G = 1 / (2 * (1 + nu));
  double found[2];
  for (const int level : {0, 1}) {
    Pressed p(level == 0 ? coarse() : fine(), isotropic_law(1, nu), kSticks);
    p.to({0, 0, -depth});
    const Vec3 before = p.force();
    p.to({1e-4, 0, -depth});
    found[level] = (p.force() - before).x() / 1e-4 / (8 * G / (2 - nu));
  }
  std::printf("Mindlin: stiffness %.4f of 8 G a/(2 - nu) (coarser %.4f)\n", found[1], found[0]);
  EXPECT_NEAR(found[1], 1, 0.05);
  EXPECT_LT(std::abs(found[1] - 1), std::abs(found[0] - 1));
}

// What rises lets go without pull, and the body is as before.
TEST(TipFriction, LetsGo) {
  for (const double friction : {0.0, 0.4, kSticks}) {
    Pressed p(coarse(), isotropic_law(1, 0.4), friction);
    for (const double depth : {0.02, 0.05}) p.to({0, 0, -depth});
    p.to({0.01, 0.004, -0.05});
    EXPECT_GT(p.force().norm(), 0);
    for (const double depth : {0.03, 0.01, -0.002}) {
      p.to({0.01, 0.004, -depth});
      EXPECT_LE(p.force().z(), 0);
    }
    EXPECT_EQ(p.force().norm(), 0);
    EXPECT_LT(p.body().field().norm(), 1e-12);
  }
}

// At finite strain the same contact at small depth is the linear one; pressed deep it has an
// energy: the work of the tip is what the body stores, with friction at most that much less.
TEST(TipFriction, FiniteStrainStartsLinearAndKeepsTheEnergy) {
  const Moduli m = moduli(1, 0.4);
  const LawPointer finite = neo_hookean_law(m.mu, m.bulk), small = isotropic_law(1, 0.4);
  const TetMesh mesh = test::graded_block(5, 5, 0.5, 8, 4);
  for (const double friction : {0.0, 0.3, kSticks}) {
    // Depth over radius 1e-4: what is left is of that order.
    // One mean dilatation an element would average K in one law and lambda in the other.
    Pressed a(mesh, finite, friction, 1e4, 2.5, Dilatation::kPointwise),
        b(mesh, small, friction, 1e4, 2.5, Dilatation::kPointwise);
    for (const Vec3& motion : {Vec3(0, 0, -1e-4), Vec3(2e-6, 1e-6, -1e-4)}) {
      a.to(motion);
      b.to(motion);
    }
    EXPECT_LT((a.force() - b.force()).norm(), 2e-3 * b.force().norm()) << friction;
  }
  for (const double friction : {0.0, kSticks}) {
    double error[2];
    for (const int fine_steps : {0, 1}) {
      const int steps = 5 << fine_steps;
      Pressed p(mesh, finite, friction, 2, 2.6);
      double work = 0;
      Vec3 before = Vec3::Zero();
      const Vec3 way = Vec3(0, 0, -0.6) / steps;
      for (int k = 1; k <= steps; ++k) {
        p.to(k * way);
        work += 0.5 * (p.force() + before).dot(way);
        before = p.force();
      }
      error[fine_steps] = work / p.body().energy() - 1;
    }
    std::printf("finite strain, friction %g: work over energy - 1: %.2e, half the steps %.2e\n",
                friction, error[1], error[0]);
    EXPECT_LT(std::abs(error[1]), 0.01);
    EXPECT_LT(std::abs(error[1]), 0.5 * std::abs(error[0]));
  }
}

}  // namespace
}  // namespace hapsim
