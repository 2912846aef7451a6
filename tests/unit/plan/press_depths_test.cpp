// How deep planned presses go: by what went into the surface before, and by how thick the body is.
#include "plan/press_depths.h"

#include <gtest/gtest.h>

#include "expect_error.h"
#include "mesh/tetmesh.h"
#include "support/block_mesh.h"

namespace hapsim {
namespace {

SignedDistance block(double height) {
  return SignedDistance(boundary_surface(test::block_mesh({0.08, 0.08, height}, 4, 4, 2, 1)));
}

Recording rows(const std::vector<Vec3>& u, double height, std::vector<char> contact = {}) {
  Recording r;
  r.name = "data.csv";
  r.metadata.set("tool_radius", "0.004");
  for (const Vec3& own : u) {
    r.line.push_back(static_cast<long>(r.rows()) + 2);
    r.press.push_back(1);
    r.position.emplace_back(0.04, 0.04, height);
    r.u.push_back(own);
  }
  r.contact = std::move(contact);
  return r;
}

TEST(PressDepths, SidewaysAndAirAreNoDepth) {
  const SignedDistance surface = block(0.04);
  const std::vector<Vec3> path{{0, 0, 0.01}, {0, 0, -0.002}, {0.009, 0, -0.003}, {0, 0, -0.008}};
  EXPECT_NEAR(PressDepths(surface, rows(path, 0.04, {0, 1, 1, 0}), 0).deepest(), 0.003, 1e-12);
  // Without a column that says so, what goes up is in the air.
  EXPECT_NEAR(PressDepths(surface, rows(path, 0.04), 0).deepest(), 0.008, 1e-12);
  // Nothing went in: as if nothing was pressed.
  EXPECT_NEAR(PressDepths(surface, rows({{0.009, 0, 0.02}}, 0.04), 0).deepest(),
              PressDepths(surface, rows({}, 0.04), 0).deepest(), 1e-12);
}

TEST(PressDepths, NoPathGoesThroughTheBody) {
  const SignedDistance thin = block(0.003);
  const Vec3 top(0.04, 0.04, 0.003);
  const PressDepths unknown(thin, rows({{0, 0, -0.002}}, 0.003), 0);
  EXPECT_NEAR(unknown.deepest_at(top, Vec3::UnitZ()), 0.001, 2e-5);
  EXPECT_NEAR(unknown.full_at(top, Vec3::UnitZ()), 0.001 / 1.5, 2e-5);
  // One that was asked for: half of the way, and not beyond.
  const PressDepths asked(thin, rows({}, 0.003), 0.01);
  EXPECT_NEAR(asked.deepest_at(top, Vec3::UnitZ()), 0.0015, 3e-5);
  EXPECT_NEAR(PressDepths(thin, rows({}, 0.003), 0.0012).deepest_at(top, Vec3::UnitZ()), 0.0012,
              1e-12);
}

TEST(PressDepths, AContactFarOffTheSurfaceIsRefused) {
  const SignedDistance surface = block(0.04);
  require_on_body(surface, rows({{0, 0, 0}}, 0.045));
  const std::string said = error_of([&] { require_on_body(surface, rows({{0, 0, 0}}, 0.07)); });
  EXPECT_EQ(said.rfind("data.csv:2: the contact lies 0.03 m off", 0), 0u) << said;
  require_on_body(surface, rows({}, 0.07));
}

}  // namespace
}  // namespace hapsim
