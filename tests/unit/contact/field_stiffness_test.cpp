// A modulus that is a field: exact derivatives, and the homogeneous body as its special case.
#include "contact/field_stiffness.h"

#include <gtest/gtest.h>

#include <cmath>

#include "contact/contact_stiffness.h"
#include "support/block_mesh.h"

namespace hapsim {
namespace {

constexpr double kFieldRadius = 0.004, kFieldNu = 0.45;

FieldGrid grid() {
  FieldGrid g;
  g.low = {0, 0, 0};
  g.step = 0.02;
  g.count = {4, 4, 3};
  return g;
}

TEST(FieldStiffness, WeightsOfAPointAreOneAndFollowIt) {
  const FieldGrid g = grid();
  Eigen::VectorXd x(static_cast<Eigen::Index>(g.size()));
  for (std::size_t n = 0; n < g.size(); ++n) x[static_cast<Eigen::Index>(n)] = g.node(n).sum();
  EXPECT_NEAR(g.value(x, {0.013, 0.041, 0.027}), 0.081, 1e-12);
  EXPECT_NEAR(g.value(x, {-1, 0.03, 0.03}), 0.06, 1e-12);  // constant outside
}

TEST(FieldStiffness, DerivativesAreDifferencesAndSumToTheStiffness) {
  const TetMesh body = test::block_mesh({0.06, 0.06, 0.04}, 5, 5, 4, 1);
  FieldBody field(make_contact_base(body), {0.03, 0.03, 0.04}, kFieldRadius, 0.3 * kFieldRadius,
                  0.6, grid());
  Eigen::VectorXd m(static_cast<Eigen::Index>(grid().size()));
  for (Eigen::Index i = 0; i < m.size(); ++i) m[i] = 0.4 * std::sin(1.7 * static_cast<double>(i));
  const FieldBody::Solution s = field.solve(kFieldNu, m, true);
  const Eigen::MatrixXd by_node = field.by_node(s);
  // A common factor on the modulus is one on the stiffness.
  EXPECT_NEAR(by_node.row(2).sum(), s.K(2, 2), 1e-6 * s.K(2, 2));
  for (const Eigen::Index node : {21, 26, 42}) {
    constexpr double kStep = 1e-3;
    Eigen::VectorXd more = m, less = m;
    more[node] += kStep;
    less[node] -= kStep;
    const Eigen::Matrix3d d =
        (field.solve(kFieldNu, more, false).K - field.solve(kFieldNu, less, false).K) / (2 * kStep);
    EXPECT_NEAR(by_node(2, node), d(2, 2), 1e-5 * s.K(2, 2)) << node;
    EXPECT_NEAR(by_node(5, node), d(0, 2), 1e-5 * s.K(2, 2)) << node;
  }
}

}  // namespace
}  // namespace hapsim
