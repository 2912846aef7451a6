// What must hold for the forces of any body: numbering does not matter, a turned body gives the
// turned force, work is reciprocal, a path does not matter, more stiffness is more energy.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/random.h"
#include "material/hooke_law.h"
#include "material/hyperelastic_law.h"
#include "material/ogden_law.h"
#include "nonlinear/nonlinear_body.h"
#include "solid/elastic_body.h"
#include "support/block_mesh.h"

namespace hapsim {
namespace {

using Eigen::Matrix3d;
using Eigen::VectorXd;

struct Drawn {
  TetMesh mesh;
  std::vector<int> handle;
  LawPointer law;
  Dilatation dilatation;
  VectorXd press;  // two handles
};

// A block, material, element and press at random, within what materials bear.
Drawn draw(Random& random) {
  Drawn d;
  const Vec3 size(0.03 + 0.03 * random.uniform(), 0.03 + 0.03 * random.uniform(),
                  0.02 + 0.02 * random.uniform());
  const int order = random.coin() ? 1 : 2, n = order == 1 ? 4 : 2;
  d.mesh = test::block_mesh(size, n, n, n, order, 0.2);
  d.handle.assign(d.mesh.nodes.size(), kFreeNode);
  for (std::size_t i = 0; i < d.handle.size(); ++i) {
    const Vec3& p = d.mesh.nodes[i];
    if (d.mesh.fixed[i]) d.handle[i] = kHeldNode;
    if (p.z() < size.z() - 1e-9) continue;
    if (p.head<2>().norm() < 0.3 * size.x()) d.handle[i] = 0;
    if ((p - size).norm() < 0.3 * size.x()) d.handle[i] = 1;
  }
  const double mu = 1e3 * std::exp(2 * random.normal()), bulk = mu * (2 + 30 * random.uniform());
  switch (random.integer(4)) {
    case 0:
      d.law = neo_hookean_law(mu, bulk);
      break;
    case 1:
      d.law = yeoh_law(mu / 2, mu * random.uniform(), mu * random.uniform(), bulk);
      break;
    case 2:
      d.law = ogden_law({{0.6 * mu, 1 + 3 * random.uniform()}, {0.4 * mu, -2}}, bulk);
      break;
    default:
      d.law = exponential_law(mu, 5 * random.uniform(), bulk);
  }
  d.dilatation = random.coin() ? Dilatation::kPointwise
                 : order == 1  ? Dilatation::kPatch
                               : Dilatation::kElement;
  d.press = VectorXd(6);
  for (int k = 0; k < 6; ++k) d.press[k] = 0.06 * size.z() * random.normal();
  return d;
}

NonlinearBody make(const Drawn& d) {
  BodyModel model{&d.mesh, {d.law}};
  model.dilatation = d.dilatation;
  return NonlinearBody(model, d.handle);
}

constexpr SolveOptions kExact{1e-12};
constexpr int kDraws = 25;

TEST(FemProperty, TurnedBodyGivesTurnedForce) {
  Random random(11);
  for (int i = 0; i < kDraws; ++i) {
    Drawn d = draw(random);
    NonlinearBody body = make(d);
    if (!body.solve(d.press, kExact).ok()) continue;
    const Matrix3d R(Eigen::AngleAxisd(
        3 * random.normal(), Vec3(random.normal(), random.normal(), random.normal()).normalized()));
    Drawn turned = d;
    for (Vec3& p : turned.mesh.nodes) p = R * p + Vec3(1, -2, 0.5);
    for (int h = 0; h < 2; ++h) turned.press.segment<3>(3 * h) = R * d.press.segment<3>(3 * h);
    NonlinearBody other = make(turned);
    ASSERT_TRUE(other.solve(turned.press, kExact).ok());
    for (int h = 0; h < 2; ++h)
      EXPECT_LT((R * body.reaction().segment<3>(3 * h) - other.reaction().segment<3>(3 * h)).norm(),
                1e-8 * body.reaction().norm());
  }
}

// With plain elements and one mean an element: patches depend on the order of the elements.
TEST(FemProperty, NumberingDoesNotMatter) {
  Random random(12);
  for (int i = 0; i < kDraws; ++i) {
    const Drawn d = draw(random);
    if (d.dilatation == Dilatation::kPatch) continue;
    NonlinearBody body = make(d);
    if (!body.solve(d.press, kExact).ok()) continue;
    Drawn other = d;
    std::vector<int> place(d.mesh.nodes.size());
    std::iota(place.begin(), place.end(), 0);
    for (std::size_t k = place.size() - 1; k > 0; --k)
      std::swap(place[k], place[random.integer(k + 1)]);
    for (std::size_t n = 0; n < place.size(); ++n) {
      other.mesh.nodes[place[n]] = d.mesh.nodes[n];
      other.handle[place[n]] = d.handle[n];
    }
    for (auto& tet : other.mesh.tets)
      for (int& n : tet)
        if (n >= 0) n = place[n];
    std::reverse(other.mesh.tets.begin(), other.mesh.tets.end());
    NonlinearBody renumbered = make(other);
    ASSERT_TRUE(renumbered.solve(d.press, kExact).ok());
    EXPECT_LT((body.reaction() - renumbered.reaction()).norm(), 1e-8 * body.reaction().norm());
  }
}

TEST(FemProperty, PathDoesNotMatterAndWorkIsReciprocal) {
  Random random(13);
  int solved = 0;
  for (int i = 0; i < kDraws; ++i) {
    const Drawn d = draw(random);
    NonlinearBody direct = make(d), detour = make(d);
    if (!direct.solve(d.press, kExact).ok()) continue;
    ++solved;
    VectorXd half = 0.5 * d.press;
    half.tail<3>().setZero();
    if (!detour.solve(half, kExact).ok()) continue;
    ASSERT_TRUE(detour.solve(d.press, kExact).ok());
    EXPECT_LT((direct.reaction() - detour.reaction()).norm(), 1e-8 * direct.reaction().norm());
    // The two handles' tangent is symmetric and stable (Betti), in the deformed state too.
    const auto linear = direct.linearise();
    ASSERT_TRUE(linear.stable);
    EXPECT_LT((linear.K - linear.K.transpose()).norm(), 1e-9 * linear.K.norm());
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(linear.K).eigenvalues().minCoeff(), 0);
    // Force and stored energy belong together: dW = F du.
    const double h = 1e-5;
    const double before = direct.energy();
    const VectorXd force = direct.reaction();
    ASSERT_TRUE(direct.solve((1 + h) * d.press, kExact).ok());
    const double work = h * force.dot(d.press) + 0.5 * h * h * d.press.dot(linear.K * d.press);
    EXPECT_NEAR(direct.energy() - before, work, 1e-4 * std::abs(work) + 1e-9 * before);
  }
  EXPECT_GT(solved, kDraws / 2);
}

TEST(FemProperty, StifferElementsStoreMoreEnergy) {
  Random random(14);
  for (int i = 0; i < kDraws; ++i) {
    const Drawn d = draw(random);
    NonlinearBody body = make(d);
    if (!body.solve(d.press, kExact).ok()) continue;
    const double energy = body.energy();
    std::vector<double> factors;
    for (std::size_t t = 0; t < d.mesh.tets.size(); ++t) factors.push_back(1 + random.uniform());
    body.set_scale(factors);
    if (!body.solve(d.press, kExact).ok()) continue;
    EXPECT_GT(body.energy(), energy);
    EXPECT_LT(body.energy(), 2 * energy);
  }
}

}  // namespace
}  // namespace hapsim
