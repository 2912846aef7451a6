// A bonded punch pressed to finite strain: to what force elements of either order, with and without
// a mean dilatation, converge, and how far off they are before. Without one they are CalculiX's
// (calculix_test.cpp: the same reactions to 5e-6).
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "material/hyperelastic_law.h"
#include "nonlinear/nonlinear_body.h"
#include "solid/elastic_body.h"
#include "support/block_mesh.h"

namespace hapsim {
namespace {

constexpr double kNu = 0.45, kShear = 6e3;  // [Pa]
constexpr double kDepth = 0.2;              // of the height

// Force [N] on a square of 20 mm in the middle of a block of 40 x 40 x 30 mm, neo-Hookean, held
// below; n elements along each edge, a multiple of four, so that all meshes have the square's
// edges.
double punch(int order, Dilatation dilatation, int n) {
  const Vec3 size(0.04, 0.04, 0.03);
  const TetMesh mesh = test::block_mesh(size, n, n, n, order);
  std::vector<int> handle(mesh.nodes.size(), kFreeNode);
  for (std::size_t i = 0; i < handle.size(); ++i) {
    const Vec3& p = mesh.nodes[i];
    if (mesh.fixed[i]) handle[i] = kHeldNode;
    const double aside = std::max(std::abs(p.x() - 0.02), std::abs(p.y() - 0.02));
    if (p.z() > size.z() - 1e-9 && aside < 0.01 + 1e-9) handle[i] = 0;
  }
  const double bulk = 2 * kShear * (1 + kNu) / (3 * (1 - 2 * kNu));
  BodyModel model{&mesh, {neo_hookean_law(kShear, bulk)}};
  model.dilatation = dilatation;
  NonlinearBody body(model, handle);
  const SolveReport report = body.solve(Vec3(0, 0, -kDepth * size.z()));
  EXPECT_TRUE(report.ok()) << report.message;
  return -body.reaction()[2];
}

// F(n) = F + c n^-p through three meshes of n, 2 n and 3 n elements.
struct Limit {
  double force = 0, rate = 0;
};
Limit limit_of(double f1, double f2, double f3) {
  double low = 0.2, high = 6;  // of p: (f1 - f2)/(f2 - f3) grows with it
  const double ratio = (f1 - f2) / (f2 - f3);
  const auto of = [](double p) {
    return (1 - std::pow(2, -p)) / (std::pow(2, -p) - std::pow(3, -p));
  };
  for (int k = 0; k < 60; ++k) (of((low + high) / 2) < ratio ? low : high) = (low + high) / 2;
  const double c = (f1 - f2) / (1 - std::pow(2, -low));
  return {f1 - c, low};
}

struct Series {
  double coarse = 0, fine = 0;
  Limit limit;
};
Series series(const char* name, int order, Dilatation dilatation) {
  const int n = order == 1 ? 8 : 4;
  const double f[] = {punch(order, dilatation, n), punch(order, dilatation, 2 * n),
                      punch(order, dilatation, 3 * n)};
  const Limit limit = limit_of(f[0], f[1], f[2]);
  std::printf("%-11s n = %d, %d, %d: %.4f %.4f %.4f N, limit %.4f, rate %.2f\n", name, n, 2 * n,
              3 * n, f[0], f[1], f[2], limit.force, limit.rate);
  return {f[0], f[2], limit};
}

// With as many nodes as first-order meshes of twice the n. A program without a mean dilatation is 6
// to 14 % stiffer than one with it on usual meshes: that is its own error, for both go to one
// force.
TEST(FinitePress, AllElementsConvergeToOneForceAndPlainOnesFromFarAbove) {
  const Series mean = series("P2-P0", 2, Dilatation::kElement);
  const Series plain2 = series("P2", 2, Dilatation::kPointwise);
  const Series plain1 = series("P1", 1, Dilatation::kPointwise);
  const Series patch1 = series("P1 patches", 1, Dilatation::kPatch);
  const double F = mean.limit.force;
  EXPECT_NEAR(plain2.limit.force, F, 0.01 * F);
  EXPECT_NEAR(plain1.limit.force, F, 0.01 * F);
  EXPECT_NEAR(patch1.limit.force, F, 0.06 * F);  // its first mesh has two patches under the punch
  // Stiffer than the limit: 42 and 20 % (first order), 17 and 6 % (second).
  EXPECT_GT(plain1.coarse, 1.3 * F);
  EXPECT_LT(patch1.coarse, 1.25 * F);
  EXPECT_GT(plain2.coarse, 1.1 * F);
  EXPECT_LT(mean.coarse, 1.07 * F);
  EXPECT_LT(mean.fine, plain2.fine);
  EXPECT_GT(mean.fine, F);
}

}  // namespace
}  // namespace hapsim
