// A tool on the body's own mesh: alone or with others, factorised or iterated, it is one stiffness.
#include "solid/mesh_press.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>

#include "base/error.h"
#include "linalg/counts.h"
#include "solid/surface_compliance.h"
#include "support/block_mesh.h"

namespace hapsim {
namespace {

const Vec3 kPressSize(0.06, 0.05, 0.04);
const Vec3 kMiddle(0.03, 0.025, 0.04);

std::vector<Lame> uneven(const TetMesh& mesh) {
  std::vector<Lame> constants;
  for (const auto& t : mesh.tets)
    constants.push_back(lame(mesh.nodes[t[0]].x() < 0.03 ? 1e4 : 3e4, 0.4));
  return constants;
}

TEST(MeshPatch, HoldsTheNodesUnderTheTool) {
  const TetMesh first = test::block_mesh(kPressSize, 12, 10, 8, 1), second = to_second_order(first);
  for (const TetMesh* mesh : {&first, &second}) {
    const MeshPatch patch = patch_under_tool(*mesh, kMiddle + Vec3(0, 0, 0.001), 0.011);
    EXPECT_LT((patch.normal - Vec3::UnitZ()).norm(), 1e-12);
    EXPECT_LT((patch.point - kMiddle).norm(), 1e-12);
    std::vector<int> corners;
    for (const int n : patch.nodes) {
      const Vec3& x = mesh->nodes[n];
      EXPECT_EQ(x.z(), kPressSize.z());
      EXPECT_LE((x - kMiddle).norm(), 0.011 + 1e-12);
      if (n < static_cast<int>(first.nodes.size())) corners.push_back(n);
    }
    // Within 2.2 cells of a point of the grid: 13 corners, and middles half-way between them.
    EXPECT_EQ(corners.size(), 13u);
    EXPECT_EQ(patch.nodes.size() > corners.size(), mesh == &second);
  }
  // A tool smaller than the mesh has one node; one far off has none.
  EXPECT_EQ(patch_under_tool(first, kMiddle + Vec3(0.002, 0, 0), 0.001).nodes.size(), 1u);
  EXPECT_THROW(patch_under_tool(first, kMiddle + Vec3(0, 0, 0.05), 0.004), Error);
}

TEST(MeshPress, IsTheSameTogetherApartAndIterated) {
  for (const int order : {1, 2}) {
    const TetMesh mesh = test::block_mesh(kPressSize, 6, 5, 4, order, 0.15);
    std::vector<MeshPatch> patches;
    for (const double x : {0.01, 0.03, 0.05})
      patches.push_back(patch_under_tool(mesh, {x, 0.02, 0.04}, 0.011));
    MeshPress together(mesh, patches, SolverKind::kDirect);
    const auto all = together.solve(uneven(mesh));
    for (std::size_t p = 0; p < patches.size(); ++p)
      for (const SolverKind kind : {SolverKind::kDirect, SolverKind::kIterative}) {
        MeshPress apart(mesh, {patches[p]}, kind);
        EXPECT_EQ(apart.solver().kind, kind);
        const auto one = apart.solve(uneven(mesh));
        const double tolerance = kind == SolverKind::kDirect ? 1e-10 : 1e-8;
        EXPECT_LT((one[0].K - all[p].K).norm(), tolerance * one[0].K.norm()) << "order " << order;
        EXPECT_LT((one[0].field - all[p].field).norm(), 10 * tolerance * one[0].field.norm());
        for (const int n : patches[p].nodes)
          EXPECT_LT((one[0].field.middleRows<3>(3 * n) - Eigen::Matrix3d::Identity()).norm(), 1e-9);
      }
  }
}

// By another way: the dense inverse condensed to the surface.
TEST(MeshPress, IsTheStiffnessOfTheCondensedSurface) {
  const TetMesh mesh = test::block_mesh(kPressSize, 6, 5, 4, 1, 0.15);
  SurfaceCompliance surface(mesh);
  surface.factorise(uneven(mesh));
  MeshPress press(mesh, {patch_under_tool(mesh, kMiddle, 0.011)});
  std::vector<int> places;
  for (const int n : press.patches()[0].nodes) places.push_back(surface.index_of(n));
  const Eigen::Matrix3d K = press.solve(uneven(mesh))[0].K;
  EXPECT_LT((K - surface.patch_stiffness(places)).norm(), 1e-8 * K.norm());
}

TEST(MeshPress, NewValuesNeedNoNewAnalysis) {
  const TetMesh mesh = test::block_mesh(kPressSize, 6, 5, 4, 2);
  const std::vector<MeshPatch> patches{patch_under_tool(mesh, {0.02, 0.02, 0.04}, 0.008),
                                       patch_under_tool(mesh, {0.04, 0.03, 0.04}, 0.008)};
  MeshPress press(mesh, patches, SolverKind::kDirect);
  press.solve(uneven(mesh));
  const long analyses = solver_counts.analyses, factorisations = solver_counts.factorisations;
  press.solve(std::vector<Lame>(mesh.tets.size(), lame(2e4, 0.3)));
  press.solve(std::vector<Lame>(mesh.tets.size(), lame(3e4, 0.45)));
  EXPECT_EQ(solver_counts.analyses, analyses);
  EXPECT_EQ(solver_counts.factorisations, factorisations + 2);  // one for both positions
}

TEST(MeshPress, IteratesOnSecondOrderInFewStepsHoweverFine) {
  int coarser = 0;
  for (const int n : {5, 10}) {
    const TetMesh mesh = test::block_mesh(kPressSize, n, n, n, 2, 0.15);
    const MeshPatch patch = patch_under_tool(mesh, kMiddle, 0.011);
    MeshPress direct(mesh, {patch}, SolverKind::kDirect);
    MeshPress iterated(mesh, {patch}, SolverKind::kIterative);
    // The matrix is given back while the factor is made, and made anew.
    for (const double nu : {0.3, 0.45}) {
      const std::vector<Lame> moduli(mesh.tets.size(), lame(1e4, nu));
      const Eigen::Matrix3d K = direct.solve(moduli)[0].K;
      EXPECT_LT((iterated.solve(moduli)[0].K - K).norm(), 1e-8 * K.norm());
    }
    std::printf("%zu tetrahedra: %d steps\n", mesh.tets.size(), iterated.iterations());
    if (n == 5) coarser = iterated.iterations();
    // Without a coarse grid twice as many where the edges are half as long.
    if (n == 10) {
      EXPECT_LE(iterated.iterations(), 1.3 * coarser);
    }
  }
  EXPECT_LE(coarser, 50);
}

TEST(SolverChoice, TurnsToIterationWithSizeAndBackWithColumns) {
  const auto kind = [](int unknowns, int columns) {
    return choose_solver(SolverKind::kBySize, unknowns, 21 * static_cast<std::size_t>(unknowns),
                         columns)
        .kind;
  };
  EXPECT_EQ(kind(500, 3), SolverKind::kDirect);
  EXPECT_EQ(kind(500000, 3), SolverKind::kIterative);
  EXPECT_EQ(kind(50000, 300), SolverKind::kDirect);
  const SolverChoice asked = choose_solver(SolverKind::kDirect, 500000, 10500000, 3);
  EXPECT_EQ(asked.kind, SolverKind::kDirect);
  EXPECT_NE(asked.why.find("as asked"), std::string::npos);
}

}  // namespace
}  // namespace hapsim
