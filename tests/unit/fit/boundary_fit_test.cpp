// Boundaries that move: which side is which, and the derivatives of what they do.
#include <gtest/gtest.h>

#include <cmath>

#include "fit/boundary_error.h"
#include "fit/boundary_graph.h"
#include "imaging/field_contacts.h"
#include "support/synthetic.h"

namespace hapsim {
namespace {

using Plan = Eigen::Vector2d;

// Three regions: below a slanting line, above it, and a disc within the upper one.
int region_of(const Plan& p) {
  if ((p - Plan(0.06, 0.15)).norm() < 0.025) return 2;
  return p.y() > 0.08 + 0.2 * (p.x() - 0.06) ? 1 : 0;
}

BoundaryGraph graph(int keys = 8) {
  const Plan low(0, 0), high(0.12, 0.21);
  return {class_boundaries(region_of, low, high, 20000), region_of, keys, 0.01};
}

TEST(BoundaryGraph, KnowsItsSides) {
  const BoundaryGraph g = graph(16);
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(g.size()));
  EXPECT_EQ(g.size(), 16u + 15u) << "the disc's line is closed";
  Random random(1);
  int wrong = 0;
  for (int i = 0; i < 2000; ++i) {
    const Plan p(0.12 * random.uniform(), 0.21 * random.uniform());
    wrong += g.region(p, still) != region_of(p);
  }
  EXPECT_LE(wrong, 10) << "of 2000, where straight pieces cut the disc";
}

TEST(BoundaryGraph, MovesByWhatItIsTold) {
  const BoundaryGraph g = graph();
  Eigen::VectorXd shift = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(g.size()));
  std::vector<BoundaryLine> lines = g.lines(shift);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_LT(distance_to(lines, {0.06, 0.08}), 1e-3);
  shift.head(8).setConstant(0.01);
  lines = g.lines(shift);
  // Wholly to one side of where it was.
  const Plan normal = Plan(-0.2, 1).normalized();
  for (const Plan& p : lines[0].points)
    EXPECT_NEAR(std::abs((p - Plan(0.06, 0.08)).dot(normal)), 0.01, 1e-3);
  const double side = (lines[0].points[4] - Plan(0.06, 0.08)).dot(normal) > 0 ? 1 : -1;
  const Plan between = Plan(0.06, 0.08) + 0.005 * side * normal;
  EXPECT_NE(g.region(between, shift), region_of(between));
  EXPECT_LT(std::abs((lines[1].points[0] - Plan(0.06, 0.15)).norm() - 0.025), 1e-3)
      << "the other stays";
}

TEST(BoundaryGraph, ItsDerivativesAreDifferences) {
  const BoundaryGraph g = graph();
  Random random(2);
  Eigen::VectorXd shift(static_cast<Eigen::Index>(g.size()));
  for (double& s : shift) s = 0.004 * (random.uniform() - 0.5);
  const double width = 0.008, h = 1e-7;
  int within = 0;
  for (int i = 0; i < 3000; ++i) {
    const Plan p(0.12 * random.uniform(), 0.21 * random.uniform());
    const BoundaryGraph::Blend blend = g.at(p, shift, width);
    if (blend.share < 0.01 || blend.share > 0.99) continue;
    ++within;
    for (int k = 0; k < 2; ++k) {
      Eigen::VectorXd more = shift, less = shift;
      more[static_cast<Eigen::Index>(blend.key[k])] += h;
      less[static_cast<Eigen::Index>(blend.key[k])] -= h;
      EXPECT_NEAR(blend.by_shift[k],
                  (g.at(p, more, width).share - g.at(p, less, width).share) / (2 * h), 1e-4);
    }
  }
  EXPECT_GT(within, 50);
}

TEST(FieldContacts, AHomogeneousFieldIsTheModelsOwnBody) {
  const Experiment w = test::experiment();
  const TetMesh body = test::block_mesh({0.08, 0.08, 0.04}, 6, 6, 4, 1);
  FieldGrid grid;
  grid.step = 0.004;
  grid.count = {21, 21, 1};
  FieldContacts contacts(body, w.places, 0.004, 0.4, grid, 1);
  const auto nodes = static_cast<Eigen::Index>(grid.size());
  Eigen::Matrix3d fine, by_nu;
  w.places.contact(1).stiffness.evaluate(0.4, fine, by_nu);
  const auto plain = contacts.at(1, Eigen::VectorXd::Constant(nodes, std::log(3.0)));
  EXPECT_LT((plain.K() - 3 * fine).norm(), 1e-6 * fine.norm());

  // Stiffer towards +x: derivative in one direction of the field against a difference.
  Eigen::VectorXd field(nodes), direction(nodes);
  for (Eigen::Index n = 0; n < nodes; ++n) {
    const Vec3 p = grid.node(static_cast<std::size_t>(n));
    field[n] = p.x() > 0.045 ? 0.9 : 0;
    direction[n] = std::sin(60 * p.x()) + std::cos(50 * p.y());
  }
  const auto here = contacts.at(1, field);
  const double h = 1e-4;
  const Eigen::Matrix3d difference =
      (contacts.at(1, field + h * direction).K() - contacts.at(1, field - h * direction).K()) /
      (2 * h);
  EXPECT_LT((here.change_of(here.by_node * direction) - difference).norm(),
            1e-5 * difference.norm());
}

// What lumps of 6 mm change, at 5 to 20 mm below the tool and aside, by an image's coarse meshes:
// as by much finer ones.
TEST(FieldContacts, CoarseMeshesSenseWhatFineOnesDo) {
  const Experiment w = test::experiment();
  const TetMesh body = test::block_mesh({0.08, 0.08, 0.04}, 6, 6, 4, 1);
  FieldGrid grid;
  grid.step = 0.0028;
  grid.count = {29, 29, 15};
  const auto nodes = static_cast<Eigen::Index>(grid.size());
  const Eigen::VectorXd homogeneous = Eigen::VectorXd::Zero(nodes);
  FieldContacts coarse(body, w.places, 0.004, 0.4, grid, 1, kSensedRim),
      fine(body, w.places, 0.004, 0.4, grid, 1, 0.125);
  const auto by_coarse = coarse.at(1, homogeneous), by_fine = fine.at(1, homogeneous);
  const Vec3 tool = w.places.position(1);
  for (const Vec3& off :
       {Vec3(0, 0, -0.005), Vec3(0.004, 0, -0.01), Vec3(0, 0.01, -0.01), Vec3(0, 0, -0.02)}) {
    Eigen::VectorXd lump(nodes);
    for (Eigen::Index n = 0; n < nodes; ++n)
      lump[n] = std::exp(-(grid.node(static_cast<std::size_t>(n)) - tool - off).squaredNorm() /
                         (0.006 * 0.006));
    const Eigen::Matrix3d changed = by_coarse.change_of(by_coarse.by_node * lump),
                          known = by_fine.change_of(by_fine.by_node * lump);
    std::printf("%.0f mm deep, %.0f aside: %.2f %% off\n", -1e3 * off.z(),
                1e3 * off.head<2>().norm(), 100 * (changed - known).norm() / known.norm());
    EXPECT_LT((changed - known).norm(), 0.03 * known.norm());
  }
}

// A shift that acts as a change of E by `c` a metre, known to sigma, adds (c sigma)^2 to E's
// variance and leaves nu's, to which it is nothing.
TEST(BoundaryError, GoesThroughToTheModuli) {
  Experiment w = test::experiment();
  test::measure(w, test::elastic(1.2e4, 0.4), 0.01, 3);
  const Selection all = all_episodes(w.dataset);
  Fit fitted = fit(test::elastic(1e4, 0.3), w, all, {0.01, 0.01, true});
  const Fit before = fitted;
  constexpr double c = 3e5, sigma = 2e-3;
  const Eigen::MatrixXd by_shift = c * solved_forces(fitted.model, w, all, true).df.leftCols(1);
  add_boundary_error(fitted, w, by_shift, Eigen::MatrixXd::Constant(1, 1, sigma * sigma));
  const double alone = before.model.find("elastic", 0, "E")->std_error;
  EXPECT_NEAR(fitted.model.find("elastic", 0, "E")->std_error, std::hypot(alone, c * sigma),
              1e-6 * alone);
  const double nu = before.model.find("elastic", 0, "nu")->std_error;
  EXPECT_NEAR(fitted.model.find("elastic", 0, "nu")->std_error, nu, 1e-6 * nu);
}

TEST(BoundaryError, KeyPointsHaveThatOfTheirPointAcrossTheBoundary) {
  Model model = test::elastic(1e4, 0.4);
  for (const auto& [region, x] : {std::pair(0, 0.038), std::pair(1, 0.042)})
    for (int k = 1; k <= 2; ++k)
      for (const auto& [name, value] : {std::pair("x", x), std::pair("y", 0.02 * k)}) {
        Parameter p = model.parameters.front();
        p.effect = "regions";
        p.region = region;
        p.name = name + std::to_string(k);
        p.value = value;
        model.parameters.push_back(p);
      }
  tell_key_point_errors(model, {{0, 1, {{0.04, 0.02}, {0.04, 0.04}}}}, {1e-3, 3e-3});
  for (const int region : {0, 1}) {
    EXPECT_NEAR(model.find("regions", region, "x1")->std_error, 1e-3, 1e-12);
    EXPECT_NEAR(model.find("regions", region, "x2")->std_error, 3e-3, 1e-12);
    EXPECT_NEAR(model.find("regions", region, "y2")->std_error, 0, 1e-12);
  }
}

}  // namespace
}  // namespace hapsim
