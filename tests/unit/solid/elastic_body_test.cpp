// Patch tests, exact solutions and convergence rates of the elements.
#include "solid/elastic_body.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <functional>

#include "support/block_mesh.h"

namespace hapsim {
namespace {

using Field = std::function<Vec3(const Vec3&)>;

bool on_boundary(const Vec3& p, const Vec3& size) {
  for (int c = 0; c < 3; ++c)
    if (p[c] < 1e-12 || p[c] > size[c] - 1e-12) return true;
  return false;
}

struct Solved {
  TetMesh mesh;
  Eigen::VectorXd field;
  double energy = 0;  // a(u, u)
};

// Prescribes `exact` on the boundary, each boundary node by a handle of its own, and solves inside.
Solved solve_with_boundary(int n, int order, const Field& exact, double modulus, double nu,
                           double jitter) {
  const Vec3 size(1, 1, 1);
  Solved s{test::block_mesh(size, n, n, n, order, jitter), {}, 0};
  std::vector<int> handle(s.mesh.nodes.size(), kFreeNode);
  int handles = 0;
  for (std::size_t i = 0; i < handle.size(); ++i)
    if (on_boundary(s.mesh.nodes[i], size)) handle[i] = handles++;
  Eigen::MatrixXd prescribed(3 * handles, 1);
  for (std::size_t i = 0; i < handle.size(); ++i)
    if (handle[i] >= 0) prescribed.block<3, 1>(3 * handle[i], 0) = exact(s.mesh.nodes[i]);
  ElasticBody body(s.mesh, handle);
  body.factorise(std::vector<Lame>(s.mesh.tets.size(), lame(modulus, nu)));
  const auto response = body.solve(prescribed);
  s.field = response.field.col(0);
  s.energy = prescribed.col(0).dot(response.reaction.col(0));
  return s;
}

// Over the nodes inside: those on the boundary are prescribed.
double rms_error(const Solved& s, const Field& exact) {
  double squares = 0;
  int inside = 0;
  for (std::size_t i = 0; i < s.mesh.nodes.size(); ++i) {
    if (on_boundary(s.mesh.nodes[i], {1, 1, 1})) continue;
    ++inside;
    squares += (s.field.segment<3>(3 * static_cast<Eigen::Index>(i)) - exact(s.mesh.nodes[i]))
                   .squaredNorm();
  }
  return std::sqrt(squares / inside);
}

TEST(ElasticBody, PassesThePatchTest) {
  Eigen::Matrix3d gradient;
  gradient << 0.01, 0.02, -0.005, 0.003, -0.02, 0.01, 0.004, 0.006, 0.015;
  const Field linear = [&](const Vec3& p) -> Vec3 { return gradient * p; };
  for (const int order : {1, 2}) {
    const Solved s = solve_with_boundary(3, order, linear, 2e4, 0.3, 0.2);
    EXPECT_LT(rms_error(s, linear), 1e-10) << "order " << order;
  }
}

TEST(ElasticBody, SecondOrderReproducesPureBending) {
  const double nu = 0.3;
  const Field bending = [&](const Vec3& p) -> Vec3 {
    const double x = p.x(), y = p.y(), z = p.z();
    return 1e-2 * Vec3(x * z, -nu * y * z, -0.5 * (x * x + nu * (z * z - y * y)));
  };
  EXPECT_LT(rms_error(solve_with_boundary(2, 2, bending, 1e4, nu, 0.2), bending), 1e-12);
  EXPECT_GT(rms_error(solve_with_boundary(2, 1, bending, 1e4, nu, 0.2), bending), 1e-6);
}

// Timoshenko's cantilever with end load for nu = 0, E = 1: cubic, so no element holds it exactly.
// Its energy a(u, u) = integral of ((L - x) z)^2 + 2 tau^2 = 1/36 + 1/60; the discrete energy
// converges with twice the element's order (Strang and Fix, ch. 2).
TEST(ElasticBody, EnergyConvergesAtTheElementsRate) {
  const Field cantilever = [](const Vec3& p) -> Vec3 {
    const double x = p.x(), z = p.z() - 0.5;
    return {(x - x * x / 2) * z + z * z * z / 3, 0, -x * x / 2 + x * x * x / 6 - x / 4};
  };
  for (const int order : {1, 2}) {
    const auto error = [&](int n) {
      return std::abs(solve_with_boundary(n, order, cantilever, 1, 0, 0.2).energy - 2.0 / 45);
    };
    const double coarse = error(4), fine = error(8), rate = std::log2(coarse / fine);
    std::printf("order %d: energy error %.3g at 4 cells, %.3g at 8, rate %.2f\n", order, coarse,
                fine, rate);
    EXPECT_GT(rate, 2 * order - 0.4);
  }
}

TEST(ElasticBody, ReactionsOfAColumnAreHookesLaw) {
  // nu = 0: a column under a moved top is uniaxial, F = E A u / L.
  const TetMesh mesh = test::block_mesh({0.02, 0.03, 0.05}, 2, 2, 3, 2);
  std::vector<int> handle(mesh.nodes.size(), kFreeNode);
  for (std::size_t i = 0; i < handle.size(); ++i) {
    if (mesh.nodes[i].z() < 1e-12) handle[i] = kHeldNode;
    if (mesh.nodes[i].z() > 0.05 - 1e-12) handle[i] = 0;
  }
  ElasticBody body(mesh, handle);
  body.factorise(std::vector<Lame>(mesh.tets.size(), lame(1e4, 0)));
  const auto response = body.solve(Eigen::Matrix3d::Identity());
  EXPECT_NEAR(response.reaction(2, 2), 1e4 * 0.02 * 0.03 / 0.05, 1e-8);
  EXPECT_LT((response.reaction - response.reaction.transpose()).norm(), 1e-8);
}

TEST(ElasticBody, RefusesABodyThatNothingHolds) {
  const TetMesh mesh = test::block_mesh({1, 1, 1}, 2, 2, 2, 1);
  ElasticBody body(mesh, std::vector<int>(mesh.nodes.size(), kFreeNode));
  EXPECT_ANY_THROW(body.factorise(std::vector<Lame>(mesh.tets.size(), lame(1, 0.6))));
}

}  // namespace
}  // namespace hapsim
