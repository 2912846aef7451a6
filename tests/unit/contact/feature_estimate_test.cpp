// What features are estimated to do, against solutions: right to first order, derivatives, and
// still near far from the identity.
#include "contact/feature_estimate.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "contact/featured_body.h"
#include "support/block_mesh.h"

namespace hapsim {
namespace {

constexpr double kEstimateRadius = 0.004, kEstimateNu = 0.42;

class Estimate : public ::testing::Test {
 protected:
  static const ContactBase& base() {
    static const ContactBase base =
        make_contact_base(test::block_mesh({0.06, 0.05, 0.03}, 6, 6, 4, 1));
    return base;
  }
  static const std::shared_ptr<const ContactMesh>& contact() {
    static const auto mesh = std::make_shared<const ContactMesh>(
        make_contact_mesh(base(), {0.033, 0.024, 0.03}, kEstimateRadius, kEstimateRadius / 3, 0.6));
    return mesh;
  }
  static const FeatureEstimate& estimate() {
    static const FeatureEstimate estimate(contact(), *free_surface(base()), kEstimateNu);
    return estimate;
  }
  static Eigen::Matrix3d solved(const std::vector<BodyFeature>& features) {
    static FeaturedBody body(*contact(), free_surface(base()));
    return body.solve({kEstimateNu, {1.0}, nullptr, features}).K;
  }
  // Relative error of the estimated change.
  static double error(const BodyFeature& feature) {
    const Eigen::Matrix3d plain = solved({}), K = solved({feature});
    const Eigen::Matrix3d L = plain.llt().matrixL();
    const Eigen::Matrix3d estimated = L * estimate().at(feature).G * L.transpose();
    return (estimated - K).norm() / (K - plain).norm();
  }
};

TEST_F(Estimate, IsRightForSmallChanges) {
  // Half the change, half the relative error: the estimate's error is of second order.
  const auto expect_first_order = [](const char* what, const BodyFeature& whole,
                                     const BodyFeature& half, double coarse) {
    const double far = error(whole), near = error(half);
    std::printf("%s: error of the change %.3f, half as large %.3f\n", what, far, near);
    EXPECT_LT(near, 0.65 * far + coarse) << what;
    EXPECT_LT(near, 0.2) << what;
  };
  expect_first_order("layer", {Feature::kLayer, {0.003, 1.4}}, {Feature::kLayer, {0.003, 1.2}},
                     0.03);
  expect_first_order("inclusion", {Feature::kInclusion, {0.034, 0.024, 0.022, 0.006, 1.4}},
                     {Feature::kInclusion, {0.034, 0.024, 0.022, 0.006, 1.2}}, 0.01);
  expect_first_order("transverse", {Feature::kTransverse, {1.4, 1, 0.6, 0.3}},
                     {Feature::kTransverse, {1.2, 1, 0.6, 0.3}}, 0.01);
  expect_first_order("support", {Feature::kSupport, {4e-3, 0, -10}},
                     {Feature::kSupport, {2e-3, 0, -10}}, 0.15);
}

TEST_F(Estimate, StaysNearWhereChangesAreLarge) {
  const auto expect_near = [](const char* what, const BodyFeature& feature) {
    const double e = error(feature);
    std::printf("%s: error of the change %.3f\n", what, e);
    EXPECT_LT(e, 0.6) << what;
  };
  expect_near("layer three times as stiff", {Feature::kLayer, {0.003, 3}});
  expect_near("inclusion five times as stiff",
              {Feature::kInclusion, {0.034, 0.024, 0.022, 0.006, 5}});
  expect_near("twice as stiff along", {Feature::kTransverse, {2, 1, 0.6, 0.3}});
  expect_near("half of the bottom free", {Feature::kSupport, {1, 0.5, 0}});
}

TEST_F(Estimate, DoesNothingAtTheIdentity) {
  for (const BodyFeature& f : {BodyFeature{Feature::kLayer, {0.003, 1}},
                               BodyFeature{Feature::kInclusion, {0.034, 0.024, 0.022, 0.006, 1}},
                               BodyFeature{Feature::kTransverse, {1, 1, 0.6, 0.3}},
                               BodyFeature{Feature::kSupport, {0, 0.5, 0}}})
    EXPECT_LT((estimate().at(f).G - Eigen::Matrix3d::Identity()).norm(), 1e-9);
}

TEST_F(Estimate, DerivativesAreDifferences) {
  for (const BodyFeature& f : {BodyFeature{Feature::kLayer, {0.0031, 2.5}},
                               BodyFeature{Feature::kInclusion, {0.034, 0.025, 0.022, 0.006, 4}},
                               BodyFeature{Feature::kTransverse, {1.7, 1.2, 0.6, 0.3}},
                               BodyFeature{Feature::kSupport, {0.02, 0.5, 0.003}}}) {
    const FeatureEstimate::Change change = estimate().at(f);
    for (std::size_t v = 0; v < f.value.size(); ++v) {
      BodyFeature up = f, down = f;
      const double h = 1e-6 * std::max(std::abs(f.value[v]), 1e-3);
      up.value[v] += h;
      down.value[v] -= h;
      const Eigen::Matrix3d difference = (estimate().at(up).G - estimate().at(down).G) / (2 * h);
      EXPECT_LT((change.by_value[v] - difference).norm(), 1e-5 * (difference.norm() + 1))
          << static_cast<int>(f.kind) << " value " << v;
    }
  }
}

}  // namespace
}  // namespace hapsim
