// A body whose surface does not pass through the contact points is not taken for an effect.
#include "experiment/shape_error.h"

#include <gtest/gtest.h>

#include "diagnose/diagnose.h"
#include "fit/fit.h"
#include "support/synthetic.h"

namespace hapsim {
namespace {

constexpr double kBump = 0.006;  // [m]

TetMesh bumpy_block() {
  TetMesh mesh = test::block_mesh({0.08, 0.08, 0.04}, 12, 12, 4, 1);
  for (Vec3& v : mesh.nodes) {
    const double off = (Vec3(v.x(), v.y(), 0) - Vec3(0.04, 0.04, 0)).squaredNorm();
    v.z() += v.z() / 0.04 * kBump * std::exp(-off / (2 * 0.015 * 0.015));
  }
  return mesh;
}

Experiment experiment_of(const TetMesh& body, const Recording& recording, double rim_edge = 0.3) {
  ExperimentOptions options;
  options.rim_edge = rim_edge;
  options.noise = 0.01;
  return make_experiment(body, recording, options);
}

TEST(ShapeError, TellsHowFarContactPointsLieOffAndWhatAMoveLeaves) {
  Recording moved = test::presses();
  for (Vec3& p : moved.position) p.z() += 0.002;
  const Experiment flat = experiment_of(test::block_mesh({0.08, 0.08, 0.04}, 6, 6, 4, 1), moved);
  EXPECT_NEAR(flat.shape.before, 0.002, 1e-6);
  EXPECT_LT(flat.shape.after, 2e-5);  // all of them alike: the body has moved
  EXPECT_TRUE(flat.shape.plain());
  EXPECT_LT(flat.floor, flat.doubted_floor);

  const Experiment bump = experiment_of(bumpy_block(), test::presses());
  EXPECT_NEAR(bump.shape.farthest, kBump * std::exp(-0.5 * 0.01 * 0.01 / (0.015 * 0.015)), 1e-3);
  EXPECT_GT(bump.shape.after, 5e-4);
  EXPECT_GT(bump.floor, 0.011);
}

TEST(ShapeError, NoEffectThatLooksLikeItIsNamedAlone) {
  Experiment truth =
      experiment_of(test::block_mesh({0.08, 0.08, 0.04}, 9, 9, 5, 1), test::presses(), 0.15);
  const Model elastic = test::elastic(3e4, 0.42);
  test::measure(truth, elastic, 0.01, 5);
  const Experiment w = experiment_of(bumpy_block(), truth.dataset.recording);
  const Diagnosis d = diagnose(elastic, w, w.allowance(), {});
  EXPECT_GT(d.rmse.told(), 2 * d.noise) << "the bump is not seen";
  for (const Finding& f : d.findings)
    EXPECT_NE(f.verdict, Verdict::kMissing) << f.effect << ": " << f.evidence;
  EXPECT_NE(d.verdict, ModelVerdict::kIncomplete) << d.explanation;
  EXPECT_TRUE(d.shape_in_doubt);
  // Asked again, the shape is in doubt again.
  const Diagnosis again = diagnose(elastic, w, w.allowance(), {});
  EXPECT_TRUE(again.shape_in_doubt);
  EXPECT_EQ(again.explanation, d.explanation);
}

}  // namespace
}  // namespace hapsim
