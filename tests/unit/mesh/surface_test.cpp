#include "mesh/surface.h"

#include <gtest/gtest.h>

#include <sstream>

#include "base/error.h"
#include "base/random.h"
#include "formats/surface_io.h"
#include "mesh/surface_tree.h"

namespace hapsim {
namespace {

Surface tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

TEST(Surface, VolumeAreaAndClosedness) {
  Surface s = tetrahedron();
  EXPECT_NEAR(signed_volume(s), 1.0 / 6, 1e-15);
  EXPECT_NEAR(surface_area(s), 1.5 + std::sqrt(3.0) / 2, 1e-15);
  EXPECT_TRUE(is_closed(s));
  for (Vec3& p : s.vertices) p += Vec3(1e3, 2e3, 3e3);
  EXPECT_NEAR(signed_volume(s), 1.0 / 6, 1e-9);
  std::swap(s.faces[0][0], s.faces[0][1]);
  EXPECT_FALSE(is_closed(s));
  s.faces.pop_back();
  EXPECT_FALSE(is_closed(s));
  EXPECT_FALSE(is_closed({}));
}

TEST(Surface, PlyRoundTripInBothFormats) {
  for (const bool ascii : {false, true}) {
    std::ostringstream out;
    write_surface_ply(out, tetrahedron(), ascii, {"a comment"});
    Input in = Input::from_bytes(out.str(), "s.ply");
    const Surface back = read_surface(in);
    ASSERT_EQ(back.vertices.size(), 4u);
    EXPECT_EQ(back.faces, tetrahedron().faces);
    EXPECT_EQ(back.vertices[3], Vec3(0, 0, 1));
  }
}

TEST(Surface, PolygonsBecomeFansAndUnusedVerticesGo) {
  Input in = Input::from_bytes(
      "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_index\nend_header\n"
      "9 9 9\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 1 2 3 4\n",
      "p.ply");
  const Surface s = read_surface(in);
  EXPECT_EQ(s.vertices.size(), 4u);
  EXPECT_EQ(s.faces.size(), 2u);
  EXPECT_NEAR(surface_area(s), 1, 1e-12);
}

TEST(Surface, FaceBeyondVerticesIsNamed) {
  Input in = Input::from_bytes(
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_index\nend_header\n"
      "0 0 0\n1 0 0\n1 1 0\n3 0 1 7\n",
      "p.ply");
  try {
    read_surface(in);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    EXPECT_NE(std::string(error.what()).find("face 0 names vertex 7"), std::string::npos);
  }
}

TEST(Surface, StlCornersAreMerged) {
  Input in = Input::from_bytes(
      "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
      "endfacet\nfacet normal 0 0 1\nouter loop\nvertex 1 0 -0\nvertex 1 1 0\nvertex 0 1 0\n"
      "endloop\nendfacet\nendsolid s\n",
      "s.stl");
  const Surface s = read_surface(in);
  EXPECT_EQ(s.vertices.size(), 4u);
  EXPECT_EQ(s.faces.size(), 2u);
}

TEST(Points, AnyColumnOrderAndPlainRows) {
  Input csv = Input::from_bytes("# a\nforce,z,x,y,nx,ny,nz\n1,3,1,2,0,0,1\n", "a.csv");
  const PointCloud a = read_points(csv);
  ASSERT_EQ(a.points.size(), 1u);
  EXPECT_EQ(a.points[0], Vec3(1, 2, 3));
  EXPECT_EQ(a.normals[0], Vec3(0, 0, 1));
  Input xyz = Input::from_bytes("0 0 0\n1 2 3\n", "a.xyz");
  EXPECT_EQ(read_points(xyz).points[1], Vec3(1, 2, 3));
  std::ostringstream out;
  write_points_ply(out, a);
  Input ply = Input::from_bytes(out.str(), "a.ply");
  EXPECT_EQ(read_points(ply).points[0], Vec3(1, 2, 3));
}

TEST(Points, NanAndEmptyAreRefused) {
  for (const char* text : {"x,y,z\n1,2,nan\n", "x,y,z\n", "0 0 0\n0 0 nan\n", "a,b\n1,2\n"}) {
    Input in = Input::from_bytes(text, "a.csv");
    try {
      read_points(in);
      FAIL() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput) << text;
    }
  }
}

// The tree against looking at every face.
TEST(SurfaceTree, FindsTheNearestPoint) {
  Random random(3);
  Surface s;
  for (int i = 0; i < 300; ++i) {
    const Vec3 at(random.uniform(), random.uniform(), random.uniform());
    const int first = static_cast<int>(s.vertices.size());
    for (int k = 0; k < 3; ++k) {
      s.vertices.push_back(at + 0.1 * Vec3(random.normal(), random.normal(), random.normal()));
    }
    s.faces.push_back({first, first + 1, first + 2});
  }
  const SurfaceTree tree(s);
  for (int i = 0; i < 200; ++i) {
    const Vec3 p(2 * random.uniform() - 0.5, 2 * random.uniform() - 0.5, 2 * random.uniform());
    EXPECT_NEAR(tree.nearest(p).distance, nearest_point(s, p).distance, 1e-12);
  }
  EXPECT_EQ(SurfaceTree({}).nearest({0, 0, 0}).face, -1);
}

}  // namespace
}  // namespace hapsim
