// The flat tool of the full simulation, held and slipping.
#include <gtest/gtest.h>

#include <cmath>

#include "effects/catalogue.h"
#include "simulate/full_simulation.h"
#include "support/block_mesh.h"

namespace hapsim {
namespace {

// Force along the normal of a press by 0.1 mm with a radius of 4 mm.
double pressed(double nu, double mu, double edge) {
  const TetMesh body = test::block_mesh({0.08, 0.08, 0.06}, 6, 6, 5, 1);
  Model model;
  model.parameters = effect_rows(*find_effect("elastic"), 1, {2e4, nu});
  if (std::isfinite(mu))
    for (const Parameter& p : effect_rows(*find_effect("friction"), 1, {mu}))
      model.parameters.push_back(p);
  Recording r;
  r.metadata.set("tool_radius", "0.004");
  for (int i = 0; i < 2; ++i) {
    r.line.push_back(i + 2);
    r.press.push_back(0);
    r.position.emplace_back(0.04, 0.04, 0.06);
    r.u.emplace_back(0, 0, -1e-4 * i);
    r.f.emplace_back(Vec3::Zero());
  }
  FullOptions options;
  options.rim_edge = edge;
  return simulate_full(body, model, r, options).force.back().z();
}

// A half-space under a flat punch that holds takes 4 G a d ln(3 - 4 nu) / (1 - 2 nu), without
// friction 4 G a d / (1 - nu) (Spence, Proc. R. Soc. A 305, 1968; Johnson, Contact
// Mechanics, 3.36); the block's bottom changes both by as much. With friction it is between them,
// and at a coefficient that nothing overcomes it holds, but for the tractions that are linear on
// the faces.
TEST(FullPunch, SlipsBetweenWhatHoldsAndWhatHasNoFriction) {
  for (const double nu : {0.3, 0.45}) {
    const double holds = pressed(nu, std::numeric_limits<double>::infinity(), 1.0 / 6),
                 rough = pressed(nu, 100, 1.0 / 6), some = pressed(nu, 0.2, 1.0 / 6),
                 smooth = pressed(nu, 1e-3, 1.0 / 6);
    const double known = (1 - 2 * nu) / ((1 - nu) * std::log(3 - 4 * nu));
    std::printf("nu %.2f: of the force that holds: rough %.4f, 0.2 %.4f, smooth %.4f (%.4f)\n", nu,
                rough / holds, some / holds, smooth / holds, known);
    EXPECT_NEAR(rough / holds, 1, 0.01) << nu;
    EXPECT_NEAR(smooth / holds, known, 0.01) << nu;
    EXPECT_GT(some, smooth) << nu;
    EXPECT_LE(some, rough) << nu;
  }
}

// A block that stiffens, pressed straight down by so many steps with elements of half a radius at
// the rim: force along the normal at a depth of 1.1 radii.
double pressed_far(double mu, int steps) {
  const TetMesh body = test::block_mesh({0.08, 0.06, 0.03}, 6, 5, 3, 1);
  Model model;
  model.parameters = effect_rows(*find_effect("elastic"), 1, {2e4, 0.4});
  for (const Parameter& p : effect_rows(*find_effect("hyperelastic"), 1, {0.2, 1}))
    model.parameters.push_back(p);
  if (std::isfinite(mu))
    for (const Parameter& p : effect_rows(*find_effect("friction"), 1, {mu}))
      model.parameters.push_back(p);
  FullOptions options;
  options.rim_edge = 0.5;
  options.growth = 0.6;
  options.quarter_points = false;
  FullPress press(body, model, {0.04, 0.034, 0.03}, 0.004, options);
  Vec3 f = Vec3::Zero();
  for (int i = 1; i <= steps; ++i) f = press.step({0, 0, -0.0044 * i / steps}, 0);
  return f.z();
}

// Under dead tractions the surface is not stable any more from 0.9 radii on; under the tool it is.
// However many steps it takes, the force is that of the place, and friction bears it between
// nothing that slips and less.
TEST(FullPunch, PressesOnWhereTheSurfaceAloneIsNotStable) {
  const double holds = pressed_far(std::numeric_limits<double>::infinity(), 11),
               rough = pressed_far(100, 11), slips = pressed_far(0.4, 11),
               few = pressed_far(0.4, 4);
  std::printf("held %.4f N, rough %.4f, slipping %.4f, in four steps %.4f\n", holds, rough, slips,
              few);
  EXPECT_NEAR(rough / holds, 1, 0.08);  // tractions are linear on faces of half a radius
  EXPECT_LT(slips, 0.95 * rough);
  EXPECT_NEAR(few / slips, 1, 0.002);
}

}  // namespace
}  // namespace hapsim
