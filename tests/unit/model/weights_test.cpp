#include "model/weights.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "support/synthetic.h"

namespace hapsim {
namespace {

TEST(Weights, WhitenTheirOwnCovariance) {
  Workspace w = test::workspace();
  const Selection selection{0, 1, 4};  // two positions
  const Eigen::VectorXd f =
      model_forces(test::elastic(1e4, 0.4), w.dataset, selection, *w.body, false).f;
  const double noise = 0.02, floor = 0.05;
  const Eigen::MatrixXd Z = gain_directions(w.dataset, selection, f);
  const Eigen::MatrixXd V = noise * noise * Eigen::MatrixXd::Identity(f.size(), f.size()) +
                            floor * floor * Z * Z.transpose();
  const Weights weights(w.dataset, selection, f, noise, floor);
  Eigen::MatrixXd half = Eigen::MatrixXd::Identity(f.size(), f.size());
  weights.whiten(half);
  EXPECT_LT((half * V * half.transpose() - Eigen::MatrixXd::Identity(f.size(), f.size())).norm(),
            1e-9);
}

}  // namespace
}  // namespace hapsim
