// What stresses of one state do at another: of one and the same state the force that holds the
// handle; their changes, and the work they do, by differences of solved states.
#include "nonlinear/stress_response.h"

#include <gtest/gtest.h>

#include "material/hyperelastic_law.h"
#include "nonlinear/nonlinear_body.h"
#include "solid/elastic_body.h"
#include "support/block_mesh.h"

namespace hapsim {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// A block held at its bottom whose top moves as one.
struct StretchedBlock {
  explicit StretchedBlock(int order, Dilatation dilatation)
      : mesh(test::block_mesh({0.03, 0.02, 0.02}, 3, 2, 2, order, 0.2)) {
    std::vector<int> handle;
    for (const Vec3& p : mesh.nodes)
      handle.push_back(p.z() < 1e-9 ? kHeldNode : p.z() > 0.02 - 1e-9 ? 0 : kFreeNode);
    BodyModel model;
    model.mesh = &mesh;
    model.laws = {exponential_law(4e3, 2, 4e4)};
    model.law_of_tet.assign(mesh.tets.size(), 0);
    model.dilatation = dilatation;
    body = std::make_unique<NonlinearBody>(model, handle);
  }
  StressResponse at(const Vec3& u) {
    EXPECT_TRUE(body->solve(u).ok());
    return body->stress_response(body->linearise().fields, MatrixXd());
  }
  TetMesh mesh;
  std::unique_ptr<NonlinearBody> body;
};

TEST(StressResponse, IsOfTheForceAndItsStateAlike) {
  for (const auto& [order, dilatation] :
       {std::pair{1, Dilatation::kPatch}, {2, Dilatation::kElement}, {2, Dilatation::kPointwise}}) {
    StretchedBlock block(order, dilatation);
    const Vec3 u(0.002, -0.001, -0.005), v(-0.001, 0.0005, -0.002);
    const StressResponse other = block.at(v), here = block.at(u);
    const VectorXd force = block.body->reaction();
    EXPECT_LT((here.work.transpose() * here.stress - force).norm(), 1e-7 * force.norm()) << order;
    // By the difference of states solved beside it.
    const double h = 1e-7;
    for (int k = 0; k < 3; ++k) {
      const StressResponse more = block.at(u + h * Vec3::Unit(k)),
                           less = block.at(u - h * Vec3::Unit(k));
      EXPECT_LT(((more.stress - less.stress) / (2 * h) - here.changes.col(k)).norm(),
                1e-5 * here.changes.col(k).norm());
      const VectorXd strain = (more.strain - less.strain) / (2 * h);
      EXPECT_LT((strain - here.work.col(k)).norm(), 1e-5 * here.work.col(k).norm());
      // W(u; v) = integral of S(v) : E(u), whose gradient is the force by the stresses of v.
      EXPECT_NEAR(other.stress.dot(strain), other.stress.dot(here.work.col(k)),
                  1e-5 * force.norm());
    }
  }
}

}  // namespace
}  // namespace hapsim
