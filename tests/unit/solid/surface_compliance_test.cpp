// The condensed surface against solutions with handles, and what holds for any body.
#include "solid/surface_compliance.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "linalg/counts.h"
#include "solid/elastic_body.h"
#include "support/block_mesh.h"

namespace hapsim {
namespace {

TetMesh block(int order) {
  return test::block_mesh({0.12, 0.21, 0.06}, 4, 5, 3, order, 0.2);
}

std::vector<Lame> uniform(const TetMesh& mesh, double modulus, double nu) {
  return std::vector<Lame>(mesh.tets.size(), lame(modulus, nu));
}

// One handle a chosen node: its reaction matrix is the inverse of the chosen block of compliances.
Eigen::MatrixXd handle_stiffness(const TetMesh& mesh, const std::vector<Lame>& constants,
                                 const std::vector<int>& nodes, bool together,
                                 Dilatation dilatation = Dilatation::kPointwise) {
  std::vector<int> handle(mesh.nodes.size(), kFreeNode);
  for (std::size_t n = 0; n < handle.size(); ++n)
    if (mesh.fixed[n]) handle[n] = kHeldNode;
  int handles = 0;
  for (const int n : nodes) handle[n] = together ? 0 : handles++;
  ElasticBody body(mesh, handle, dilatation);
  body.factorise(constants);
  return body.solve(Eigen::MatrixXd::Identity(3 * body.handles(), 3 * body.handles())).reaction;
}

TEST(SurfaceCompliance, IsWhatSolutionsWithHandlesGive) {
  for (const int order : {1, 2})
    for (const Dilatation dilatation : {Dilatation::kPointwise, Dilatation::kElement}) {
      const TetMesh mesh = block(order);
      std::vector<Lame> constants = uniform(mesh, 2e4, 0.4);
      for (std::size_t t = 0; t < constants.size(); t += 3) constants[t] = lame(7e4, 0.2);
      SurfaceCompliance surface(mesh, dilatation);
      surface.factorise(constants);
      const int count = static_cast<int>(surface.nodes().size());
      const std::vector<int> chosen{0, 7, count / 2, count - 9, count - 1};
      std::vector<int> nodes;
      Eigen::MatrixXd c(3 * chosen.size(), 3 * chosen.size());
      for (std::size_t a = 0; a < chosen.size(); ++a) {
        nodes.push_back(surface.nodes()[chosen[a]]);
        for (std::size_t b = 0; b < chosen.size(); ++b)
          c.block<3, 3>(3 * a, 3 * b) = surface.block(chosen[a], chosen[b]);
      }
      const Eigen::MatrixXd expected =
          handle_stiffness(mesh, constants, nodes, false, dilatation).inverse();
      EXPECT_LT((c - expected).norm(), 1e-9 * expected.norm()) << "order " << order;
      const Eigen::MatrixXd tool = handle_stiffness(mesh, constants, nodes, true, dilatation);
      EXPECT_LT((surface.patch_stiffness(chosen) - tool).norm(), 1e-9 * tool.norm());
    }
}

TEST(SurfaceCompliance, HasTheFreeNodesOfTheBoundary) {
  for (const int order : {1, 2}) {
    const TetMesh mesh = block(order);
    const SurfaceCompliance surface(mesh);
    std::vector<int> expected;
    for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
      const Vec3& p = mesh.nodes[n];
      const bool boundary = std::min({p.x(), p.y(), p.z()}) < 1e-12 || p.x() > 0.12 - 1e-12 ||
                            p.y() > 0.21 - 1e-12 || p.z() > 0.06 - 1e-12;
      if (boundary && !mesh.fixed[n]) expected.push_back(static_cast<int>(n));
      EXPECT_EQ(surface.index_of(static_cast<int>(n)) >= 0, boundary && !mesh.fixed[n]);
    }
    EXPECT_EQ(surface.nodes(), expected);
  }
}

TEST(SurfaceCompliance, IsReciprocalAndPassive) {
  const TetMesh mesh = block(1);
  SurfaceCompliance surface(mesh);
  surface.factorise(uniform(mesh, 1e4, 0.45));
  const Eigen::MatrixXd& c = surface.matrix();
  EXPECT_EQ((c - c.transpose()).norm(), 0);                          // Maxwell and Betti
  EXPECT_EQ(Eigen::LLT<Eigen::MatrixXd>(c).info(), Eigen::Success);  // every load does work
}

TEST(SurfaceCompliance, TurnsWithTheBody) {
  const TetMesh mesh = block(1);
  TetMesh turned = mesh;
  const Eigen::Matrix3d r =
      Eigen::AngleAxisd(0.8, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  for (Vec3& p : turned.nodes) p = r * p + Vec3(0.3, -0.1, 2);
  SurfaceCompliance a(mesh), b(turned);
  a.factorise(uniform(mesh, 1e4, 0.3));
  b.factorise(uniform(mesh, 1e4, 0.3));
  const int count = static_cast<int>(a.nodes().size());
  for (const int i : {3, count / 3, count - 4})
    for (const int k : {0, count / 2})
      EXPECT_LT((r * a.block(i, k) * r.transpose() - b.block(i, k)).norm(),
                1e-9 * a.block(i, i).norm());
}

TEST(SurfaceCompliance, NumberingOfNodesDoesNotMatter) {
  const TetMesh mesh = block(1);
  std::vector<int> to(mesh.nodes.size());
  for (std::size_t n = 0; n < to.size(); ++n) to[n] = static_cast<int>(n);
  std::shuffle(to.begin(), to.end(), std::mt19937(4));
  TetMesh other = mesh;
  for (std::size_t n = 0; n < to.size(); ++n) {
    other.nodes[to[n]] = mesh.nodes[n];
    other.fixed[to[n]] = mesh.fixed[n];
  }
  for (auto& tet : other.tets)
    for (int k = 0; k < 4; ++k) tet[k] = to[tet[k]];
  for (Triangle& f : other.faces)
    for (int& n : f) n = to[n];
  SurfaceCompliance a(mesh), b(other);
  a.factorise(uniform(mesh, 1e4, 0.3));
  b.factorise(uniform(mesh, 1e4, 0.3));
  for (const int n : a.nodes())
    for (const int m : {a.nodes().front(), a.nodes().back()})
      EXPECT_LT(
          (a.block(a.index_of(n), a.index_of(m)) - b.block(b.index_of(to[n]), b.index_of(to[m])))
              .norm(),
          1e-9 * a.block(a.index_of(n), a.index_of(n)).norm());
}

TEST(SurfaceCompliance, NewValuesNeedNoNewAnalysis) {
  const TetMesh mesh = block(1);
  SurfaceCompliance a(mesh);
  const long analyses = solver_counts.analyses, factorisations = solver_counts.factorisations;
  a.factorise(uniform(mesh, 1e4, 0.3));
  const Eigen::MatrixXd first = a.matrix();
  a.scale_modulus(2.5);
  const Eigen::MatrixXd scaled = a.matrix();
  EXPECT_EQ(solver_counts.factorisations, factorisations + 1);
  a.factorise(uniform(mesh, 2.5e4, 0.3));
  EXPECT_LT((scaled - a.matrix()).norm(), 1e-10 * scaled.norm());
  a.factorise(uniform(mesh, 1e4, 0.3));
  EXPECT_EQ((first - a.matrix()).norm(), 0);
  EXPECT_EQ(solver_counts.factorisations, factorisations + 3);
  EXPECT_EQ(solver_counts.analyses, analyses);
}

TEST(SurfaceCompliance, RefusesABodyThatNothingHolds) {
  TetMesh mesh = block(1);
  SurfaceCompliance held(mesh);
  EXPECT_ANY_THROW(held.factorise(uniform(mesh, 1e4, 0.6)));
  mesh.fixed.assign(mesh.nodes.size(), 1);
  EXPECT_ANY_THROW(SurfaceCompliance{mesh});
}

}  // namespace
}  // namespace hapsim
