// Bodies that are not homogeneous: derivatives about a solution, fits by rounds of finite elements,
// objects that moved.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "experiment/registration.h"
#include "fit/fit.h"
#include "fit/move_limits.h"
#include "support/model_derivatives.h"
#include "support/objects.h"
#include "support/synthetic.h"

namespace hapsim {
namespace {

class FeaturedModel : public ::testing::Test {
 protected:
  static Experiment& w() {
    static Experiment experiment = test::experiment();
    return experiment;
  }
  static FitOptions options() { return {0.01, 0, true}; }
};

TEST_F(FeaturedModel, DerivativesAboutTheSolutionAreDifferences) {
  const Model model = test::with(test::with(test::elastic(1.5e4, 0.42), "layer", {0.003, 2}),
                                 "viscoelastic", {6e3, 0.4});
  const Selection selection{0, 2, 7, 8};
  test::expect_derivatives(w(), model, selection);
}

// The prediction for another Poisson's ratio and another modulus against the solution there.
TEST_F(FeaturedModel, ExtrapolationIsRightToTheSecondOrder) {
  const Selection selection{0, 2, 7, 8};
  const Model about = test::with(test::elastic(1.5e4, 0.42), "layer", {0.003, 2});
  const auto error = [&](double size) {
    Model model = about;
    model.parameters[0].value *= 1.7;             // exact, whatever its size
    model.parameters[1].value += 0.02 * size;     // nu
    model.parameters[3].value *= 1 + 0.2 * size;  // ratio
    const Linearisation known = w().places.solve(material_of(about));
    const Eigen::VectorXd predicted = model_forces(model, w(), known, selection, false).f;
    const Eigen::VectorXd solved = solved_forces(model, w(), selection, false).f;
    return (predicted - solved).norm() / solved.norm();
  };
  const double far = error(1), near = error(0.5);
  std::printf("extrapolated: error %.2g, half as far %.2g\n", far, near);
  EXPECT_LT(far, 0.01);
  EXPECT_LT(near, 0.35 * far);
}

// These presses hardly tell a thicker layer from a stiffer one (1.2 and 1.5 mm fit as well as 2),
// so what is asked is that intervals hold, of eight draws of the noise; a thin layer is a long way
// from a thick one in standard errors of its own.
TEST_F(FeaturedModel, ALayerIsFoundFromFarAway) {
  const Model truth = test::with(test::elastic(1.5e4, 0.42), "layer", {0.002, 3});
  const Selection all = all_episodes(w().dataset);
  constexpr int kDraws = 8;
  int inside = 0;
  for (int draw = 1; draw <= kDraws; ++draw) {
    test::measure(w(), truth, 0.005, static_cast<std::uint64_t>(draw));
    const Fit plain = fit(test::elastic(2e4, 0.4), w(), all, options());
    const Fit found =
        fit_best(with_effect(plain, "layer", w(), all, {}), w(), all, options(), plain.about);
    ASSERT_TRUE(found.converged) << found.message;
    EXPECT_LT(found.error.pooled, 1.05 * 0.005);
    for (const char* name : {"thickness", "ratio"}) {
      const Parameter& p = *found.model.find("layer", 0, name);
      const double off = p.value - truth.find("layer", 0, name)->value;
      std::printf("%s %.4g, off by %.2f standard errors\n", name, p.value, off / p.std_error);
      inside += std::abs(off) < 1.96 * p.std_error;
    }
  }
  EXPECT_GE(inside, 2 * kDraws - 2);
}

// A layer that trades its thickness for its stiffness: at the end of the interval's longer side,
// here the lower one, the least sum of squares, solved by a fit of its own, has risen as chi
// squared's 95 % ask (Venzon and Moolgavkar, 1988). The parabola's end is far from there.
TEST_F(FeaturedModel, TheIntervalOfALayerIsThatOfItsProfile) {
  const Model truth = test::with(test::elastic(1.5e4, 0.42), "layer", {0.002, 3});
  const Selection all = all_episodes(w().dataset);
  test::measure(w(), truth, 0.005, 2);
  FitOptions o{0.005, 0, true};
  const Fit plain = fit(truth, w(), all, o);
  o.ridges = true;
  const Fit found = fit(plain.model, w(), all, o, plain.about);
  ASSERT_TRUE(found.converged) << found.message;
  const Parameter& t = *found.model.find("layer", 0, "thickness");
  const double factor = std::exp(1.96 * t.std_error / t.value);
  Model held = found.model;
  held.find("layer", 0, "thickness")->value /= factor;
  held.find("layer", 0, "thickness")->state = ParameterState::kFixed;
  o.ridges = false;
  const Fit beside = fit(held, w(), all, o);
  EXPECT_TRUE(beside.converged) << beside.message;
  const auto sum = [&](const Fit& f) {
    return static_cast<double>(f.residuals) * std::pow(f.error.pooled / o.noise, 2);
  };
  const double rise = sum(beside) - sum(found);
  const double parabola =
      std::exp(1.96 * plain.model.find("layer", 0, "thickness")->std_error / t.value);
  std::printf("thickness %.3g over %.3g: rise %.3g; by the curvature over %.3g\n", t.value, factor,
              rise, parabola);
  EXPECT_NEAR(rise, 3.84, 0.6);
  EXPECT_GT(factor, 1.2 * parabola);
  EXPECT_TRUE(std::any_of(found.blind.begin(), found.blind.end(), [](const std::string& s) {
    return s.find("layer thickness and ratio trade for each other") != std::string::npos;
  }));
}

TEST(MoveLimits, HoldOnlyWhatTheBodyIsLinearIn) {
  Model model = test::with(test::with(test::elastic(1e4, 0.4), "layer", {0.002, 2}), "damper", {1});
  std::vector<Unknown> unknowns;
  for (const int i : model.free_parameters())
    unknowns.push_back({model.parameters[i].value, -1e300, 1e300, 0.1, false});
  const std::vector<Unknown> held = within_reach(unknowns, model, 1);
  EXPECT_EQ(held[0].upper, 1e300);         // E scales all
  EXPECT_NEAR(held[1].upper, 0.5, 1e-12);  // nu
  EXPECT_NEAR(held[2].upper, 0.102, 1e-12);
  EXPECT_EQ(held[4].upper, 1e300);  // the damper
}

// Points touched on an uneven lump that has moved: what is left off its surface vanishes, and the
// directions that the points see come back.
TEST(Registration, BringsPointsBackToTheSurface) {
  const Surface lump = test::lump();
  std::vector<Vec3> points;
  for (std::size_t f = 0; f < lump.faces.size(); f += 37) {
    const Triangle& t = lump.faces[f];
    const Vec3 p = (lump.vertices[t[0]] + lump.vertices[t[1]] + lump.vertices[t[2]]) / 3;
    if (p.z() > 0.005) points.push_back(p);
  }
  ASSERT_GT(points.size(), 12u);
  const Vec3 shift(0.003, -0.002, 0.001), rotation(0.01, -0.02, 0.03), middle = middle_of(points);
  std::vector<Vec3> moved;
  for (const Vec3& p : points)
    moved.push_back(rotation_matrix(rotation) * (p - middle) + middle + shift);
  const RigidMove move = register_points(moved, lump);
  std::printf("off the surface %.3g mm before, %.3g mm after\n", 1e3 * move.before,
              1e3 * move.after);
  EXPECT_TRUE(move.significant());
  EXPECT_GT(move.before, 1e-3);
  EXPECT_LT(move.after, 1e-4);
  EXPECT_LT((move.shift - shift).norm(), 5e-4);
  EXPECT_LT((move.rotation - rotation).norm(), 1e-2);
  EXPECT_FALSE(register_points(points, lump).significant());
}

}  // namespace
}  // namespace hapsim
