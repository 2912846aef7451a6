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

// Fields inside: what they change and do work by, by differences of states that are moved along
// them; and what given stresses move inside, by solving with a little of them added.
TEST(StressResponse, KnowsFieldsInside) {
  for (const auto& [order, dilatation] :
       {std::pair{1, Dilatation::kPatch}, {2, Dilatation::kElement}, {2, Dilatation::kPointwise}}) {
    StretchedBlock block(order, dilatation);
    NonlinearBody& body = *block.body;
    const VectorXd other = block.at({-0.001, 0.0005, -0.002}).stress;
    const StressResponse here = block.at({0.002, -0.001, -0.005});
    const MatrixXd moved = body.moved_inside(other);
    const NonlinearBody::State state = body.state();
    PointStresses added = body.elastic_stresses();
    const double little = 1e-5;
    Eigen::Index at = 0;
    for (Voigt& S : added.S) {
      S = little * other.segment<6>(at);
      at += 6;
    }
    for (double& p : added.pressure) p = little * other[at++];
    body.set_added(added);
    ASSERT_TRUE(body.solve(state.prescribed).ok());
    EXPECT_LT(((body.field() - state.u) / little - moved.col(0)).norm(), 1e-3 * moved.norm());
    for (Voigt& S : added.S) S.setZero();
    for (double& p : added.pressure) p = 0;
    body.set_added(added);

    MatrixXd inside(moved.rows(), 2);  // as far as elements may be moved
    inside << 0.001 / moved.lpNorm<Eigen::Infinity>() * moved, moved.col(0).cwiseAbs2();
    inside.col(1) *= 0.001 / inside.col(1).lpNorm<Eigen::Infinity>();
    body.restore(state);
    const MatrixXd fields = body.linearise().fields;
    const StressResponse known = body.stress_response(fields, inside);
    EXPECT_LT((known.stress - here.stress).norm(), 1e-6 * here.stress.norm());
    EXPECT_LT((known.work - here.work).norm(), 1e-6 * here.work.norm());
    const double h = 1e-4;
    for (int k = 0; k < 2; ++k) {
      NonlinearBody::State there = state;
      there.u += h * inside.col(k);
      body.restore(there);
      const StressResponse more = body.stress_response(fields, inside);
      there.u -= 2 * h * inside.col(k);
      body.restore(there);
      const StressResponse less = body.stress_response(fields, inside);
      EXPECT_LT(((more.stress - less.stress) / (2 * h) - known.inside_changes.col(k)).norm(),
                1e-5 * known.inside_changes.norm());
      EXPECT_LT(((more.strain - less.strain) / (2 * h) - known.inside_work.col(k)).norm(),
                1e-5 * known.inside_work.norm());
      for (int j = 0; j < 2; ++j)
        EXPECT_NEAR(known.stress.dot(more.inside_work.col(j) - less.inside_work.col(j)) / (2 * h),
                    known.inside_stressed(j, k), 1e-5 * known.inside_stressed.norm());
    }

    // By parts: the same numbers one after the other.
    body.restore(state);
    Eigen::Index from = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const StressResponse part = body.stress_response(fields, inside, {i, 3});
      const Eigen::Index rows = part.stress.size();
      ASSERT_LE(from + rows, known.stress.size());
      EXPECT_EQ(part.stress, known.stress.segment(from, rows));
      EXPECT_EQ(part.strain, known.strain.segment(from, rows));
      EXPECT_EQ(part.changes, known.changes.middleRows(from, rows));
      EXPECT_EQ(part.work, known.work.middleRows(from, rows));
      EXPECT_EQ(part.inside_changes, known.inside_changes.middleRows(from, rows));
      EXPECT_EQ(part.inside_work, known.inside_work.middleRows(from, rows));
      if (i == 2)
        EXPECT_EQ(part.inside_stressed, known.inside_stressed);
      else
        EXPECT_EQ(part.inside_stressed.size(), 0);
      from += rows;
    }
    EXPECT_EQ(from, known.stress.size());
  }
}

}  // namespace
}  // namespace hapsim
