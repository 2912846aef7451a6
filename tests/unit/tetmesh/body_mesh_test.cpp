// Bodies: volumes, second order, boundary, files; and the way from a surface to a body.
#include "tetmesh/body_mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <sstream>

#include "formats/tetmesh_io.h"
#include "mesh/quality.h"
#include "mesh/tetmesh.h"
#include "support/shapes.h"

namespace hapsim {
namespace {

using test::error_of;
using test::TemporaryFile;

TetMesh block(int order = 1) {
  BodyOptions options;
  options.edge = 0.02;
  options.order = order;
  return make_body_mesh(test::box({0.06, 0.05, 0.04}), options);
}

std::string ply(const TetMesh& mesh, bool ascii = false) {
  std::ostringstream out;
  write_body_ply(out, mesh, ascii);
  return out.str();
}

TetMesh read_back(const std::string& text) {
  const TemporaryFile file(text);
  Input input(file.path());
  return read_body(input);
}

std::string body_text(const std::string& fixed, const std::string& tet) {
  return "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\n"
         "property double z\nproperty uchar fixed\nelement tetrahedron 1\n"
         "property list uchar int vertex_indices\nend_header\n"
         "0 0 0 " +
         fixed + "\n1 0 0 " + fixed + "\n0 1 0 " + fixed + "\n0 0 1 0\n4 " + tet + "\n";
}

TEST(TetMesh, VolumeOfABlock) {
  const TetMesh mesh = block();
  EXPECT_NEAR(volume(mesh), 0.06 * 0.05 * 0.04, 1e-12);
  EXPECT_EQ(tet_quality(mesh).inverted, 0u);
  EXPECT_GT(mesh.tets.size(), 50u);
}

TEST(TetMesh, BoundaryIsClosedAndOutward) {
  const TetMesh mesh = block();
  std::vector<int> node;
  const Surface surface = boundary_surface(mesh, &node);
  EXPECT_TRUE(is_closed(surface));
  EXPECT_NEAR(signed_volume(surface), volume(mesh), 1e-12);
  EXPECT_EQ(surface.faces.size(), boundary_faces(mesh).size());
  for (std::size_t v = 0; v < node.size(); ++v) EXPECT_EQ(surface.vertices[v], mesh.nodes[node[v]]);
}

TEST(TetMesh, SecondOrderHasStraightMiddlesAndFixedOnes) {
  const TetMesh mesh = block(2);
  for (const auto& t : mesh.tets)
    for (int e = 0; e < 6; ++e) {
      const Vec3 middle = 0.5 * (mesh.nodes[t[kTetEdges[e][0]]] + mesh.nodes[t[kTetEdges[e][1]]]);
      EXPECT_LT((mesh.nodes[t[4 + e]] - middle).norm(), 1e-15);
    }
  int fixed = 0;
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    // The bottom is flat and its outline is its own: exactly the nodes at z = 0 are held.
    EXPECT_EQ(mesh.fixed[n] != 0, mesh.nodes[n].z() < 1e-9) << n;
    fixed += mesh.fixed[n];
  }
  EXPECT_GT(fixed, 20);
  const TetMesh again = to_second_order(mesh);
  EXPECT_EQ(again.nodes.size(), mesh.nodes.size());
}

TEST(TetMesh, SecondOrderOfAFirstOrderBodyKeepsTheSupport) {
  const TetMesh direct = block(2), raised = to_second_order(block(1));
  EXPECT_EQ(direct.fixed, raised.fixed);
  EXPECT_EQ(direct.tets, raised.tets);
}

TEST(TetMesh, FilesRoundTrip) {
  for (const int order : {1, 2})
    for (const bool ascii : {false, true}) {
      const TetMesh mesh = block(order);
      const TetMesh back = read_back(ply(mesh, ascii));
      EXPECT_EQ(back.order, order);
      EXPECT_EQ(back.tets, mesh.tets);
      EXPECT_EQ(back.faces, mesh.faces);
      EXPECT_EQ(back.fixed, mesh.fixed);
      EXPECT_EQ(back.region, mesh.region);
      ASSERT_EQ(back.nodes.size(), mesh.nodes.size());
      for (std::size_t n = 0; n < back.nodes.size(); ++n) EXPECT_EQ(back.nodes[n], mesh.nodes[n]);
    }
}

TEST(TetMesh, SameInputSameBytes) {
  EXPECT_EQ(ply(block()), ply(block()));
}

TEST(TetMesh, RefusesBrokenBodies) {
  const auto refuse = [](const std::string& text, const std::string& part) {
    const auto [code, what] = error_of([&] { read_back(text); });
    EXPECT_EQ(code, 3) << part;
    EXPECT_NE(what.find(part), std::string::npos) << what;
  };
  EXPECT_EQ(read_back(body_text("1", "0 1 2 3")).tets.size(), 1u);
  EXPECT_EQ(read_back(body_text("1", "0 1 2 3")).faces.size(), 4u);
  refuse(body_text("1", "0 2 1 3"), "tetrahedron 0 at (0.25, 0.25, 0.25) is inverted");
  refuse(body_text("1", "0 1 2 2"), "flat");
  refuse(body_text("1", "0 1 2 4"), "out of range");
  refuse(body_text("1", "0 1 2 -1"), "out of range");
  refuse(body_text("0", "0 1 2 3"), "no node is fixed");
  std::string two = body_text("1", "0 1 2 3");
  two.replace(two.find("0 1 0 1"), 7, "0 1 0 0");
  refuse(two, "the fixed nodes do not hold the part of the body with the node at (0, 0, 0)");
  refuse("", "empty");
  refuse("solid x\nendsolid x\n", "not a PLY");
  refuse(
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty double x\nproperty double y\n"
      "property double z\nend_header\n0 0 0\n",
      "tetrahedron");
}

TEST(TetMesh, DropsNodesWithoutTetrahedron) {
  std::string text = body_text("1", "1 2 3 4");
  text.replace(text.find("vertex 4"), 8, "vertex 5");
  text.replace(text.find("0 0 0 1\n"), 8, "9 9 9 0\n0 0 0 1\n");
  EXPECT_EQ(read_back(text).nodes.size(), 4u);
}

TEST(TetMesh, VtuHasAllCells) {
  const TetMesh mesh = block(2);
  std::ostringstream out;
  write_body_vtu(out, mesh);
  EXPECT_NE(out.str().find("NumberOfCells=\"" + std::to_string(mesh.tets.size()) + "\""),
            std::string::npos);
}

TEST(Body, SupportIsWhereItIsAsked) {
  const Surface surface = test::box({0.06, 0.05, 0.04}, 6);
  BodyOptions options;
  const auto fixed_heights = [&] {
    const TetMesh mesh = make_body_mesh(surface, options);
    std::pair<double, double> range{1, -1};
    for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
      if (mesh.fixed[n]) {
        range.first = std::min(range.first, mesh.nodes[n].z());
        range.second = std::max(range.second, mesh.nodes[n].z());
      }
    return range;
  };
  EXPECT_NEAR(fixed_heights().second, 0, 1e-9);
  options.support = parse_support("plane:0.04");
  EXPECT_NEAR(fixed_heights().first, 0.04, 1e-9);
  options.support = parse_support("below:0.021");
  EXPECT_NEAR(fixed_heights().first, 0, 1e-9);
  EXPECT_NEAR(fixed_heights().second, 0.02, 1e-9);
  options.support = parse_support("none");
  EXPECT_EQ(fixed_heights().second, -1);
  options.support = parse_support("below:-1");
  EXPECT_EQ(error_of([&] { make_body_mesh(surface, options); }).first, 3);
  for (const char* wrong : {"top", "plane", "below:", "below:x", ""})
    EXPECT_EQ(error_of([&] { parse_support(wrong); }).first, 2) << wrong;
}

TEST(Body, SizeAndContactsSetTheNumberOfTetrahedra) {
  const Surface surface = test::dome(0.05, 24);
  BodyOptions options;
  const TetMesh plain = make_body_mesh(surface, options);
  EXPECT_NEAR(volume(plain) / signed_volume(surface), 1, 0.005);
  EXPECT_GT(plain.tets.size(), 2000u);
  EXPECT_LT(plain.tets.size(), 15000u);
  options.edge = 0.01;
  const TetMesh coarse = make_body_mesh(surface, options);
  EXPECT_LT(coarse.tets.size(), plain.tets.size());
  options.contacts = {{0, 0, 0.05}};
  options.tool_radius = 0.004;
  const TetMesh refined = make_body_mesh(surface, options);
  EXPECT_GT(refined.tets.size(), coarse.tets.size());
  double nearest = 1;
  for (const Triangle& f : refined.faces)
    for (int k = 0; k < 3; ++k) {
      const Vec3 &a = refined.nodes[f[k]], &b = refined.nodes[f[(k + 1) % 3]];
      if ((0.5 * (a + b) - Vec3(0, 0, 0.05)).norm() < 0.004)
        nearest = std::min(nearest, (a - b).norm());
    }
  EXPECT_LT(nearest, 0.003);
  options.preserve_surface = true;
  EXPECT_EQ(make_body_mesh(surface, options).faces.size(), surface.faces.size());
}

}  // namespace
}  // namespace hapsim
