// What elements that end at a ball say of it, against elements that it cuts, half as large.
#include "imaging/lump_solver.h"

#include <gtest/gtest.h>

#include <cmath>

#include "contact/contact_stiffness.h"
#include "imaging/stiffness_image.h"
#include "support/synthetic.h"

namespace hapsim {
namespace {

constexpr double kPoisson = 0.45;

TEST(LumpSolver, IsWhatCutElementsConvergeTo) {
  const Experiment w = test::experiment();
  const ContactBase base = make_contact_base(test::block_mesh({0.08, 0.08, 0.04}, 7, 7, 4, 1));
  const double tool = w.dataset.recording.disc_radius();
  Eigen::Matrix3d K, by_nu;
  w.places.contact(0).stiffness.evaluate(kPoisson, K, by_nu);
  const Vec3 f = K * Vec3(0, 0, -1e-3);
  const std::vector<ImageView> views{{0, K.inverse() * f * f.transpose() / f.squaredNorm(), 1, 0}};
  const LumpSolver solver(base, w.places, tool, kPoisson, views, 1);
  const Vec3 centre = w.places.position(0) + Vec3(0.002, 0.001, -0.011);
  constexpr double kRadius = 6e-3;
  const std::vector<double> ratios{1, 5, 0.2};
  const Eigen::MatrixXd gains = solver(centre, kRadius, ratios, {0});
  EXPECT_NEAR(gains(0, 0), 0, 1e-9);

  ContactBodies cut(base, w.places.position(0), tool, 0.1);
  const auto stiffness = [&](double ratio) {
    Material material;
    material.nu = kPoisson;
    material.features.push_back(
        {Feature::kInclusion, {centre.x(), centre.y(), centre.z(), kRadius, ratio}});
    return (cut.solve_featured(material).K * views[0].B).trace();
  };
  const double bare = stiffness(1);
  for (const int r : {1, 2}) {
    const double is = std::log(stiffness(ratios[static_cast<std::size_t>(r)]) / bare);
    EXPECT_GT(std::abs(is), 0.03);
    EXPECT_NEAR(gains(0, r) / is, 1, 0.1) << ratios[static_cast<std::size_t>(r)];
  }
}

TEST(LumpSolver, SaysNothingOfPlacesThatWereNotAskedOrCannotBeMeshed) {
  const Experiment w = test::experiment();
  const ContactBase base = make_contact_base(test::block_mesh({0.08, 0.08, 0.04}, 7, 7, 4, 1));
  const std::vector<ImageView> views{{0, Eigen::Matrix3d::Identity(), 1, 0},
                                     {1, Eigen::Matrix3d::Identity(), 1, 0}};
  const LumpSolver solver(base, w.places, w.dataset.recording.disc_radius(), kPoisson, views, 1);
  const Vec3 centre = w.places.position(0) - Vec3(0, 0, 0.011);
  const Eigen::MatrixXd gains = solver(centre, 6e-3, {5}, {0});
  EXPECT_TRUE(std::isfinite(gains(0, 0)));
  EXPECT_TRUE(std::isnan(gains(1, 0)));
  EXPECT_TRUE(std::isnan(solver(centre, 12e-3, {5}, {0})(0, 0))) << "it reaches out of the body";
}

}  // namespace
}  // namespace hapsim
