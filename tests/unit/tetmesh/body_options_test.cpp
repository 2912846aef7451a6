// What hs-tetmesh can be asked for: regions, contacts, supports, curved edges, plain meshes,
// inputs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "formats/body_input.h"
#include "formats/surface_io.h"
#include "mesh/quality.h"
#include "support/shapes.h"
#include "support/told.h"
#include "tetmesh/body_mesh.h"
#include "tetmesh/body_words.h"
#include "tetmesh/curve_edges.h"
#include "tetmesh/given_mesh.h"
#include "tetmesh/tetgen.h"

namespace hapsim {
namespace {

using test::error_of;
const Vec3 kSize(0.06, 0.05, 0.04);

Surface moved(Surface surface, const Vec3& by) {
  for (Vec3& p : surface.vertices) p += by;
  return surface;
}

double region_volume(const TetMesh& mesh, int region) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    if (mesh.region[t] == region) sum += tet_volume(mesh, t);
  return sum;
}

TEST(BodyOptions, RegionsEndAtTheirSurfaces) {
  BodyOptions options;
  options.edge = 0.01;
  options.inner = {{moved(test::box({0.02, 0.02, 0.02}, 2), {0.005, 0.01, 0.01}), "a.stl"},
                   {moved(test::dome(0.01, 6), {0.043, 0.025, 0.01}), "b.stl"}};
  BodyReport report;
  const TetMesh mesh = make_body_mesh(test::box(kSize), options, "", &report);
  EXPECT_TRUE(report.notes.empty());
  EXPECT_NEAR(region_volume(mesh, 1), 8e-6, 1e-15);
  EXPECT_NEAR(region_volume(mesh, 2), signed_volume(options.inner[1].surface), 1e-15);
  EXPECT_NEAR(volume(mesh), kSize.prod(), 1e-12);
  EXPECT_EQ(boundary_faces(mesh).size(), mesh.faces.size());

  // One inside the other: the later wins.
  options.inner[1].surface = moved(test::box({0.01, 0.01, 0.01}), {0.01, 0.015, 0.015});
  const TetMesh nested = make_body_mesh(test::box(kSize), options);
  EXPECT_NEAR(region_volume(nested, 2), 1e-6, 1e-15);
  EXPECT_NEAR(region_volume(nested, 1), 7e-6, 1e-15);
}

TEST(BodyOptions, RegionsThatTouchAreColouredAndSaidSo) {
  BodyOptions options;
  options.edge = 0.004;
  options.inner = {{moved(test::box({0.03, 0.05, 0.04}), {0, 0, 0}), "half.stl"}};
  BodyReport report;
  const TetMesh mesh = make_body_mesh(test::box(kSize), options, "", &report);
  ASSERT_EQ(report.notes.size(), 1u);
  EXPECT_NE(report.notes[0].find("half.stl"), std::string::npos);
  EXPECT_NEAR(region_volume(mesh, 1), 6e-5, 6e-6);

  options.inner[0] = {moved(test::box({0.01, 0.01, 0.01}), {1, 0, 0}), "away.stl"};
  const auto [code, what] = error_of([&] { make_body_mesh(test::box(kSize), options); });
  EXPECT_EQ(code, 3);
  EXPECT_EQ(what.rfind("away.stl: ", 0), 0u) << what;
  options.inner[0].surface.faces.pop_back();
  EXPECT_EQ(error_of([&] { make_body_mesh(test::box(kSize), options); }).first, 3);
}

TEST(BodyOptions, EachContactIsANode) {
  BodyOptions options;
  options.contacts = {{0.0123, 0.0311, 0.0402},
                      {0.03, 0.025, 0.04},
                      {0.06, 0.02, 0.02},
                      {0.06, 0.05, 0.04},
                      {0.0301, 0.025, 0.04}};
  options.tool_radius = 0.004;
  options.contact_size = 0.0015;
  BodyReport report;
  const TetMesh mesh = make_body_mesh(test::box(kSize, 5), options, "", &report);
  ASSERT_EQ(report.contact_node.size(), 5u);
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 on = options.contacts[i].cwiseMin(kSize);
    EXPECT_LT((mesh.nodes[static_cast<std::size_t>(report.contact_node[i])] - on).norm(), 1e-12)
        << i;
  }
  EXPECT_NEAR(volume(mesh), kSize.prod(), 1e-10);
  // Sizes are about the asked one at the contact and grow from there.
  double near = 0, far = 0;
  int near_count = 0, far_count = 0;
  for (const auto& t : mesh.tets)
    for (const auto& e : kTetEdges) {
      const Vec3 &a = mesh.nodes[t[e[0]]], &b = mesh.nodes[t[e[1]]];
      const double d = (0.5 * (a + b) - Vec3(0.0123, 0.0311, 0.04)).norm();
      if (d < 0.004) near += (a - b).norm(), ++near_count;
      if (a.z() < 0.01 && b.z() < 0.01) far += (a - b).norm(), ++far_count;
    }
  EXPECT_NEAR(near / near_count, 0.0015, 0.0006);
  EXPECT_GT(far / far_count, 2 * near / near_count);
  options.contacts = {{0.03, 0.025, 0.09}};
  EXPECT_EQ(error_of([&] { make_body_mesh(test::box(kSize), options); }).first, 3);
}

TEST(BodyOptions, ContactsOnACurvedSurfaceLieOnIt) {
  const Surface dome = test::dome(0.05, 24);
  BodyOptions options;
  options.contacts = {{0.01, 0.02, 0.044}, {-0.03, 0.01, 0.038}, {0, 0, 0.05}};
  options.tool_radius = 0.004;
  BodyReport report;
  const TetMesh mesh = make_body_mesh(dome, options, "", &report);
  for (std::size_t i = 0; i < options.contacts.size(); ++i) {
    const Vec3& p = mesh.nodes[static_cast<std::size_t>(report.contact_node[i])];
    EXPECT_LT((p - nearest_point(dome, options.contacts[i]).point).norm(), 1e-4);
    EXPECT_LT(nearest_point(dome, p).distance, 1e-5);
  }
  EXPECT_EQ(tet_quality(mesh).inverted, 0u);
}

TEST(BodyOptions, SupportsByBoxPlaneAndFile) {
  const Surface surface = test::box(kSize, 5);
  BodyOptions options;
  const auto fixed = [&](const std::string& text) {
    options.support = parse_support(text);
    const TetMesh mesh = make_body_mesh(surface, options);
    std::vector<Vec3> nodes;
    for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
      if (mesh.fixed[n]) nodes.push_back(mesh.nodes[n]);
    return nodes;
  };
  for (const Vec3& p : fixed("plane:2,0,0,0.12")) EXPECT_NEAR(p.x(), 0.06, 1e-4);
  for (const Vec3& p : fixed("box:-1,-1,-1,0.024001,0.0200001,0.0001")) {
    EXPECT_LE(p.x(), 0.0241);
    EXPECT_NEAR(p.z(), 0, 1e-9);
  }
  bool low = false, high = false;
  for (const Vec3& p : fixed("bottom+plane:0.04")) {
    low = low || p.z() < 1e-9;
    high = high || p.z() > 0.04 - 1e-9;
  }
  EXPECT_TRUE(low && high);
  const test::TemporaryFile points("x,y,z\n0,0,0\n0.06,0.05,0.04\n");
  EXPECT_EQ(fixed("file:" + points.path()).size(), 2u);
  const test::TemporaryFile far("x,y,z\n9,0,0\n");
  EXPECT_EQ(error_of([&] { fixed("file:" + far.path()); }).first, 3);
  const test::TemporaryFile numbers("node\n0\n1e9\n");
  EXPECT_EQ(error_of([&] { fixed("file:" + numbers.path()); }).first, 3);
  const Support box = parse_support("box:0,0,-1mm,6cm,50 mm,0.04");  // lengths have units
  EXPECT_EQ(box.low, Vec3(0, 0, -0.001));
  EXPECT_EQ(box.high, Vec3(0.06, 0.05, 0.04));
  EXPECT_EQ(parse_support("none+below:4mm").also.at(0).z, 0.004);
  EXPECT_EQ(parse_support("plane:0,0,2,8mm").z, 0.004);  // a normal has none
  for (const char* wrong : {"below:4parsec", "plane:0,0,2mm,8mm", "box:1,2", "plane:0,0,0,1",
                            "bottom+", "bottom+x", "file:", "plane:1,2"})
    EXPECT_EQ(error_of([&] { parse_support(wrong); }).first, 2) << wrong;
}

double quadratic_volume(const TetMesh& mesh) {
  // Surface integral of x . n / 3 over the curved boundary, by the divergence theorem, as the sum
  // over tetrahedra of the map's determinant at four Gauss points.
  constexpr double a = 0.5854101966249685, b = 0.1381966011250105;
  double sum = 0;
  for (const auto& t : mesh.tets)
    for (int g = 0; g < 4; ++g) {
      double l[4] = {b, b, b, b};
      l[g] = a;
      double J[3][3] = {};
      for (int axis = 1; axis < 4; ++axis)
        for (int n = 0; n < 10; ++n) {
          const auto by = [&](int c) { return c == axis ? 1.0 : c == 0 ? -1.0 : 0.0; };
          double d = 0;
          if (n < 4) {
            d = (4 * l[n] - 1) * by(n);
          } else {
            const int p = kTetEdges[n - 4][0], q = kTetEdges[n - 4][1];
            d = 4 * (by(p) * l[q] + by(q) * l[p]);
          }
          for (int k = 0; k < 3; ++k) J[k][axis - 1] += d * mesh.nodes[t[n]][k];
        }
      sum += (J[0][0] * (J[1][1] * J[2][2] - J[1][2] * J[2][1]) -
              J[0][1] * (J[1][0] * J[2][2] - J[1][2] * J[2][0]) +
              J[0][2] * (J[1][0] * J[2][1] - J[1][1] * J[2][0])) /
             24;
    }
  return sum;
}

TEST(BodyOptions, CurvedEdgesFollowTheSmoothSurface) {
  const double exact = 2.0 / 3 * std::acos(-1.0) * std::pow(0.05, 3);
  BodyOptions options;
  options.order = 2;
  options.preserve_surface = true;
  const Surface coarse = test::dome(0.05, 8);
  const TetMesh straight = make_body_mesh(coarse, options);
  options.curved_to = test::dome(0.05, 96);
  BodyReport report;
  const TetMesh curved = make_body_mesh(coarse, options, "", &report);
  const double before = std::abs(quadratic_volume(straight) / exact - 1);
  const double after = std::abs(quadratic_volume(curved) / exact - 1);
  printf("volume error %.3g straight, %.3g curved; %s\n", before, after,
         report.notes.empty() ? "" : report.notes[0].c_str());
  EXPECT_LT(after, 0.15 * before);
  for (std::size_t n = 0; n < curved.nodes.size(); ++n)
    EXPECT_TRUE(!curved.fixed[n] || curved.nodes[n] == straight.nodes[n]);
}

TEST(BodyOptions, PlainMeshHasTheWorseShapes) {
  const Surface surface = test::dome(0.05, 12);
  BodyOptions options;
  options.preserve_surface = true;
  const TetQuality quality = tet_quality(make_body_mesh(surface, options));
  options.plain = true;
  const TetMesh plain = make_body_mesh(surface, options);
  EXPECT_EQ(plain.faces.size(), surface.faces.size());
  EXPECT_GT(tet_quality(plain).radius_edge.median, 1.5 * quality.radius_edge.median);
  EXPECT_GT(quality.smallest_dihedral_deg.median, tet_quality(plain).smallest_dihedral_deg.median);
}

TEST(BodyOptions, QualityCountsAllAndListsTheWorst) {
  const TetMesh mesh = make_body_mesh(test::dome(0.05, 12), {});
  const TetQuality q = tet_quality(mesh);
  for (const Histogram* h : {&q.radius_edge_counts, &q.dihedral_counts, &q.aspect_counts}) {
    std::size_t sum = 0;
    for (const std::size_t n : h->count) sum += n;
    EXPECT_EQ(sum, mesh.tets.size());
  }
  ASSERT_EQ(q.worst_tets.size(), 10u);
  EXPECT_EQ(q.worst_tets[0].tet, q.worst);
  EXPECT_EQ(q.worst_tets[0].smallest_dihedral_deg, q.smallest_dihedral_deg.minimum);
  EXPECT_GE(q.aspect.minimum, 1);
}

BodyInput read_text(const std::string& text) {
  Input input = Input::from_bytes(text, "in");
  return read_body_input(input, 1e-3);
}

TEST(BodyInput, TellsPointsFromSurfaces) {
  for (const char* points :
       {"x,y,z\n1,2,3\n", "# scan\nx;y;z;nx;ny;nz\n", "1 2 3\n4 5 6\n", "1.0,2.0,3.0\n",
        "q1,q2,q3,d\n0,0,0,1\n",
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty double x\nproperty double y\nproperty "
        "double z\nend_header\n0 0 0\n"}) {
    const auto [code, what] = error_of([&] { read_text(points); });
    EXPECT_EQ(code, 3) << points;
    EXPECT_NE(what.find("these are points"), std::string::npos) << what;
    EXPECT_NE(what.find("hs-scan2ply FILE | hs-reconstruct"), std::string::npos) << what;
  }
  EXPECT_EQ(error_of([] { read_text(""); }).first, 3);
  EXPECT_EQ(error_of([] { read_text("hello world\n"); }).first, 3);
}

TEST(BodyInput, ReadsOffAndTheBasePlane) {
  const BodyInput off = read_text(
      "OFF # a tetrahedron\n5 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n7 7 7\n3 0 2 1 255 0 0\n3 0 1 3\n3 "
      "1 2 "
      "3\n3 2 0 3\n");
  EXPECT_EQ(off.surface.vertices.size(), 4u);
  EXPECT_NEAR(signed_volume(off.surface), 1e-9 / 6, 1e-20);
  for (const char* bad : {"OFF\n5 4 0\n0 0", "OFF\n900000000 1 0\n",
                          "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 "
                          "0\n3 0 1 3\n",
                          "OFF\n1 1 0\n0 0 x\n"}) {
    const auto [code, what] = error_of([&] { read_text(bad); });
    EXPECT_EQ(code, 3) << bad;
    EXPECT_EQ(what.rfind("in:", 0), 0u) << what;
  }
  std::ostringstream ply;
  write_surface_ply(ply, test::box({1, 1, 1}), false, {"base_plane 0 0.6 0.8 2.5"});
  const BodyInput based = read_text(ply.str());
  ASSERT_TRUE(based.base.has_value());
  EXPECT_NEAR(based.base->z, 2.5e-3, 1e-15);
  EXPECT_NEAR(based.base->normal.y(), 0.6, 1e-12);
}

// A block that stands tilted: its lowest plane is no z = const.
TEST(BodyInput, TiltedBottomIsFixedByItsPlane) {
  Surface surface = test::box(kSize, 4);
  const Vec3 up = Vec3(0.3, -0.2, 0.9).normalized(), side = Vec3(0, 0.9, 0.2).normalized();
  const Vec3 x = Vec3(side - side.dot(up) * up).normalized();
  const Vec3 y(up.y() * x.z() - up.z() * x.y(), up.z() * x.x() - up.x() * x.z(),
               up.x() * x.y() - up.y() * x.x());
  for (Vec3& p : surface.vertices) p = p.x() * x + p.y() * y + (p.z() + 0.01) * up;
  BodyOptions options;
  options.support.kind = SupportKind::kPlane;
  options.support.normal = up;
  options.support.z = 0.01;
  const TetMesh mesh = make_body_mesh(surface, options);
  int fixed = 0;
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    EXPECT_EQ(mesh.fixed[n] != 0, std::abs(up.dot(mesh.nodes[n]) - 0.01) < 1e-6);
    fixed += mesh.fixed[n];
  }
  EXPECT_GT(fixed, 20);
}

TEST(Tetgen, NamesPartsThatNearlyTouch) {
  // Two vertices of a thin fold pressed onto the other side.
  Surface s = test::box({1, 1, 1}, 4);
  for (Vec3& p : s.vertices)
    if ((p - Vec3(0.5, 0.5, 1)).norm() < 1e-9) p.z() = 1e-7;
  const auto [code, what] = error_of([&] { run_tetgen({.surface = s}, {}, "x.ply"); });
  if (code != 0) {
    EXPECT_EQ(code, 3);
    EXPECT_NE(what.find("comes within"), std::string::npos) << what;
  }
}

TEST(Tetgen, BeatsWhileItRuns) {
  TetgenOptions options;
  options.max_volume = 1e-9;
  options.time_limit = 1;
  int beats = 0;
  options.heartbeat = [&] { ++beats; };
  EXPECT_EQ(error_of([&] { run_tetgen({.surface = test::box({1, 1, 1}, 4)}, options); }).first, 3);
  EXPECT_GE(beats, 2);
}

TEST(GivenMesh, IsFixedWhereItSaysOrWhereItIsAsked) {
  TetMesh cube = make_body_mesh(test::box(kSize), {.edge = 0.02});
  std::fill(cube.fixed.begin(), cube.fixed.end(), 0);
  cube.fixed[3] = 1;
  const auto fixed = [](const TetMesh& mesh) {
    return std::count(mesh.fixed.begin(), mesh.fixed.end(), 1);
  };
  EXPECT_EQ(fixed(body_of_mesh(cube, true, {}, "cube")), 1);
  const TetMesh bonded = body_of_mesh(cube, false, {}, "cube");
  for (std::size_t i = 0; i < bonded.nodes.size(); ++i)
    EXPECT_EQ(bonded.fixed[i] == 1, std::abs(bonded.nodes[i].z()) < 1e-9) << i;
  const TetMesh second = body_of_mesh(cube, true, {.order = 2}, "cube");
  EXPECT_EQ(second.order, 2);
  EXPECT_NEAR(tet_quality(second).volume, kSize.prod(), 1e-12);
  BodyOptions above;
  above.support = parse_support("plane:1");
  EXPECT_NE(
      error_of([&] { body_of_mesh(cube, false, above, "cube"); }).second.find("cube: no boundary"),
      std::string::npos);
}

TEST(BodyInput, BottomsLieOnTheBaseThatTheFileTells) {
  BodyInput body;
  Support support = parse_support("bottom+below:0.01");
  put_on_base(support, body);
  EXPECT_EQ(support.kind, SupportKind::kBottom);
  body.base = parse_support("plane:0,1,0,0.02");
  put_on_base(support, body);
  EXPECT_EQ(support.kind, SupportKind::kPlane);
  EXPECT_EQ(support.normal, Vec3::UnitY());
  EXPECT_EQ(support.z, 0.02);
  EXPECT_EQ(support.also.at(0).kind, SupportKind::kBelow);
}

TEST(BodyInput, TenMetresAreMillimetres) {
  BodyInput body;
  body.surface.vertices = {Vec3(0, -9.9, 0), Vec3(1, 1, 1)};
  EXPECT_NO_THROW(require_metres(body, "box"));
  body.surface.vertices[0].y() = -10.5;
  EXPECT_NE(
      error_of([&] { require_metres(body, "box"); }).second.find("box: coordinates reach 10.5 m"),
      std::string::npos);
  EXPECT_EQ(mended_words({}), "");
  EXPECT_EQ(
      mended_words({.unused_nodes = 2, .turned = 1}),
      "mended: 2 nodes of no tetrahedron and 0 doubled tetrahedra dropped, 1 inverted ones turned");
}

TEST(BodyWords, TellTheSizesOfAMesh) {
  const TetMesh cube = make_body_mesh(test::box(kSize), {.edge = 0.02});
  const TetQuality quality = tet_quality(cube);
  BodyReport report;
  report.notes = {"a note"};
  const auto json = nlohmann::json::parse(body_json(cube, quality, report));
  EXPECT_EQ(json["tetrahedra"], cube.tets.size());
  EXPECT_NEAR(json["volume_m3"], kSize.prod(), 1e-15);
  EXPECT_EQ(json["regions"]["0"], cube.tets.size());
  EXPECT_EQ(json["inverted"], 0);
  std::size_t counted = 0;
  for (const std::size_t n : json["aspect"]["counts"]) counted += n;
  EXPECT_EQ(counted, cube.tets.size());
  const Summary few = body_summary(cube, quality, report, "mm", false);
  EXPECT_TRUE(test::tells(few, "a note"));
  EXPECT_TRUE(test::tells(few, "0.00012 m^3, unit mm")) << test::told(few);
  EXPECT_GT(test::told(body_summary(cube, quality, report, "mm", true)).size(),
            test::told(few).size());
  TetMesh loose = cube;
  std::fill(loose.fixed.begin(), loose.fixed.end(), 0);
  const Summary free = body_summary(loose, quality, {}, "m", false);
  EXPECT_EQ(free.mark, Summary::Mark::kOpen);
  EXPECT_TRUE(test::tells(free, "no node fixed"));
}

}  // namespace
}  // namespace hapsim
