// What new material values cost on bodies that are prepared, counted in analyses and
// factorisations.
#include <gtest/gtest.h>

#include "experiment/places.h"
#include "linalg/counts.h"
#include "support/synthetic.h"

namespace hapsim {
namespace {

MaterialSpec homogeneous(double modulus, double nu) {
  MaterialSpec material;
  material.nu = nu;
  material.modulus = {modulus};
  material.modulus_column = {-1};
  return material;
}

TEST(SolverCounts, AHomogeneousBodyIsFactorisedForNoNewValue) {
  const Experiment w = test::experiment();
  const long analyses = solver_counts.analyses, factorisations = solver_counts.factorisations;
  EXPECT_GT(factorisations, 0);
  const auto stiffness = [&](double modulus, double nu) {
    const MaterialSpec material = homogeneous(modulus, nu);
    return w.places.solve(material).at(0, material).K;
  };
  const Eigen::Matrix3d soft = stiffness(1e4, 0.4);
  for (const double modulus : {1e3, 2.5e4, 8e5}) {
    const Eigen::Matrix3d K = stiffness(modulus, 0.4);
    EXPECT_LT((K - modulus / 1e4 * soft).norm(), 1e-12 * K.norm());
  }
  // Nor for another Poisson's ratio within the prepared range.
  for (const double nu : {0.2, 0.45, 0.49}) stiffness(1e4, nu);
  EXPECT_EQ(solver_counts.analyses, analyses);
  EXPECT_EQ(solver_counts.factorisations, factorisations);
}

TEST(SolverCounts, RegionsAreFactorisedAgainButNotAnalysed) {
  const Experiment w = test::experiment();
  MaterialSpec material = homogeneous(1e4, 0.4);
  material.modulus = {1e4, 2e4};
  material.modulus_column = {-1, -1};
  material.key_point = {Vec3(0.02, 0.04, 0), Vec3(0.06, 0.04, 0)};
  material.key_region = {0, 1};
  w.places.solve(material);  // prepares what regions need
  const long analyses = solver_counts.analyses, factorisations = solver_counts.factorisations;
  for (const double modulus : {3e4, 5e4}) {
    material.modulus[1] = modulus;
    w.places.solve(material);
  }
  EXPECT_EQ(solver_counts.analyses, analyses);
  EXPECT_GT(solver_counts.factorisations, factorisations);
}

}  // namespace
}  // namespace hapsim
