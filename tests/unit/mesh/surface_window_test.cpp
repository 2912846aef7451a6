#include "mesh/surface_window.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mesh/tetmesh.h"
#include "support/block_mesh.h"

namespace hapsim {
namespace {

SurfaceWindow window(double width) {
  const Surface box = boundary_surface(test::block_mesh({1, 1, 1}, 3, 3, 3, 1));
  std::vector<std::uint8_t> marked;
  for (std::size_t f = 0; f < box.faces.size(); ++f)
    marked.push_back(face_normal(box, static_cast<int>(f)).normalized().z() < -0.5);
  return {box, marked, width};
}

TEST(SurfaceWindow, SeesThePlaneTheEdgeAndTheCorner) {
  const SurfaceWindow w = window(0.05);
  const SurfaceView face = w.at({0.5, 0.5, 1});
  EXPECT_LT((face.normal - Vec3::UnitZ()).norm(), 0.01);
  EXPECT_LT(face.shape.norm(), 0.01);
  EXPECT_EQ(face.marked, 0);
  EXPECT_LT((w.at({1, 0.5, 1}).normal - Vec3(0.5, 0, 0.5)).norm(), 0.02);
  EXPECT_LT((w.at({1, 1, 1}).normal - Vec3(0.25, 0.25, 0.25)).norm(), 0.02);
  EXPECT_NEAR(w.at({0.5, 0.5, 0}).marked, 1, 0.01);
  EXPECT_NEAR(w.at({1, 0.5, 0}).marked, 0.5, 0.02);
}

TEST(SurfaceWindow, SeesTheFarSideOfAThinBody) {
  // Both faces of a plate of thickness t, far from its edges: the window's integral over a plane at
  // the distance t is (1 - t^2 / 16 w^2)^9.
  const Surface plate = boundary_surface(test::block_mesh({1, 1, 0.06}, 4, 4, 1, 1));
  const SurfaceWindow w(plate, std::vector<std::uint8_t>(plate.faces.size(), 0), 0.06);
  EXPECT_NEAR(w.at({0.5, 0.5, 0.06}).normal.z(), 1 - std::pow(15.0 / 16, 9), 0.005);
}

}  // namespace
}  // namespace hapsim
