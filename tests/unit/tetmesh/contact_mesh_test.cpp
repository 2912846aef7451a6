// Contact meshes: the disc is where and as large as it should be, on every body and everywhere on
// it.
#include "tetmesh/contact_mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>
#include <thread>

#include "base/random.h"
#include "formats/surface_io.h"
#include "mesh/quality.h"
#include "repair/coarsen.h"
#include "repair/self_intersection.h"
#include "support/needs.h"
#include "support/shapes.h"
#include "tetmesh/body_mesh.h"
#include "tetmesh/contact_mesh_around.h"
#include "tetmesh/tetgen.h"

namespace hapsim {
namespace {

constexpr double kRadius = 0.004;

ContactBase block_base() {
  static const ContactBase base =
      make_contact_base(make_body_mesh(test::box({0.12, 0.21, 0.06}), {}));
  return base;
}

ContactBase dome_base() {
  static const ContactBase base = make_contact_base(make_body_mesh(test::dome(0.05, 24), {}));
  return base;
}

// What must hold for every contact mesh.
void expect_sound(const ContactMesh& contact, const ContactBase& base) {
  const TetMesh& mesh = contact.mesh;
  EXPECT_EQ(mesh.order, 2);
  const TetQuality quality = tet_quality(mesh);
  EXPECT_EQ(quality.inverted, 0u);
  EXPECT_NEAR(quality.volume / signed_volume(base.surface), 1, 0.005);
  EXPECT_NEAR(contact.normal.norm(), 1, 1e-12);
  EXPECT_FALSE(contact.patch_nodes.empty());
  for (const int n : contact.patch_nodes) EXPECT_FALSE(mesh.fixed[n]);
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
    EXPECT_EQ(mesh.fixed[n] != 0, std::abs(mesh.nodes[n].z()) < 1e-9) << mesh.nodes[n].transpose();
}

// By meridians and circles, as bodies of CAD are: needles about the pole.
TEST(ContactBase, CoarsensTheFanAboutAPole) {
  constexpr int kRound = 96, kUp = 32;
  constexpr double kDome = 0.05;
  ClassedSurface dome;
  std::vector<Vec3>& v = dome.surface.vertices;
  for (int j = 0; j < kUp; ++j)
    for (int i = 0; i < kRound; ++i) {
      const double up = 0.5 * M_PI * j / kUp, round = 2 * M_PI * i / kRound;
      v.push_back(kDome * Vec3(std::cos(up) * std::cos(round), std::cos(up) * std::sin(round),
                               std::sin(up)));
    }
  v.insert(v.end(), {Vec3(0, 0, kDome), Vec3::Zero()});
  const auto add = [&](int a, int b, int c, int bonded) {
    dome.surface.faces.push_back({a, b, c});
    dome.face_class.push_back(static_cast<std::uint8_t>(bonded));
  };
  for (int i = 0; i < kRound; ++i) {
    const int next = (i + 1) % kRound, top = (kUp - 1) * kRound;
    add(i, kRound * kUp + 1, next, 1);
    for (int j = 0; j + 1 < kUp; ++j) {
      const int k = j * kRound;
      add(k + i, k + next, k + kRound + next, 0);
      add(k + i, k + kRound + next, k + kRound + i, 0);
    }
    add(top + i, top + next, kRound * kUp, 0);
  }
  const ContactBase base = make_contact_base(dome, 0.008);
  for (std::size_t f = 0; f < base.surface.faces.size(); ++f) {
    if (base.fixed_face[f]) continue;
    const Triangle& t = base.surface.faces[f];
    for (int k = 0; k < 3; ++k)
      EXPECT_GT((base.surface.vertices[t[k]] - base.surface.vertices[t[(k + 1) % 3]]).norm(),
                0.003);
  }
  EXPECT_NEAR(signed_volume(base.surface) / signed_volume(dome.surface), 1, 0.005);
  EXPECT_TRUE(is_closed(base.surface));
}

TEST(ContactBase, KeepsVolumeAndSupport) {
  for (const ContactBase& base : {block_base(), dome_base()}) {
    EXPECT_NEAR(signed_volume(base.surface) / signed_volume(base.fine), 1, 0.005);
    EXPECT_TRUE(is_closed(base.surface));
    double bonded = 0, fine_bonded = 0;
    for (std::size_t f = 0; f < base.surface.faces.size(); ++f)
      if (base.fixed_face[f]) bonded += 0.5 * face_normal(base.surface, static_cast<int>(f)).norm();
    for (std::size_t f = 0; f < base.fine.faces.size(); ++f) {
      const Vec3 n = face_normal(base.fine, static_cast<int>(f));
      if (-n.z() > 0.999 * n.norm()) fine_bonded += 0.5 * n.norm();
    }
    EXPECT_NEAR(bonded / fine_bonded, 1, 0.01);
    check_self_intersection(base.surface, "base");
  }
}

TEST(ContactBase, SplitsLongEdges) {
  const ClassedSurface box{test::box({0.12, 0.21, 0.06}), std::vector<std::uint8_t>(12, 0)};
  const ClassedSurface split = split_long_edges(box, [](const Vec3&) { return 0.03; });
  EXPECT_TRUE(is_closed(split.surface));
  EXPECT_NEAR(signed_volume(split.surface), 0.12 * 0.21 * 0.06, 1e-12);
  EXPECT_EQ(split.face_class.size(), split.surface.faces.size());
  for (const Triangle& f : split.surface.faces)
    for (int k = 0; k < 3; ++k)
      EXPECT_LE((split.surface.vertices[f[k]] - split.surface.vertices[f[(k + 1) % 3]]).norm(),
                0.03);
}

TEST(ContactMesh, DiscOnAFlatFace) {
  const Vec3 centre(0.05, 0.1, 0.06);
  for (const double share : {0.25, 0.125}) {
    const ContactMesh contact =
        make_contact_mesh(block_base(), centre + Vec3(0, 0, 0.001), kRadius, share * kRadius);
    expect_sound(contact, block_base());
    EXPECT_LT((contact.point - centre).norm(), 1e-12);
    EXPECT_GT(contact.normal.z(), 1 - 1e-12);
    EXPECT_NEAR(contact.patch_area / (M_PI * kRadius * kRadius), 1, 1e-9);

    // The rim is a regular polygon of the disc's area: its corners lie on one circle.
    const int n = static_cast<int>(std::lround(2 * M_PI / share));
    const double rim = kRadius * std::sqrt(2 * M_PI / n / std::sin(2 * M_PI / n));
    int on_rim = 0;
    for (const int node : contact.patch_nodes) {
      const double r = (contact.mesh.nodes[node] - centre).norm();
      EXPECT_LT(r, rim * (1 + 1e-9));
      on_rim += std::abs(r - rim) < 1e-9;
    }
    EXPECT_EQ(on_rim, n);
    // All nodes of the disc belong to the patch, and no other.
    const std::set<int> patch(contact.patch_nodes.begin(), contact.patch_nodes.end());
    for (std::size_t i = 0; i < contact.mesh.nodes.size(); ++i) {
      const Vec3 d = contact.mesh.nodes[i] - centre;
      if (std::abs(d.z()) > 1e-9) continue;
      EXPECT_EQ(patch.count(static_cast<int>(i)) > 0, d.norm() < rim * (1 + 1e-9)) << d.transpose();
    }
    const std::size_t tets = contact.mesh.tets.size();
    EXPECT_GT(tets, share < 0.2 ? 3500u : 1800u);
    EXPECT_LT(tets, share < 0.2 ? 7000u : 3600u);
  }
}

TEST(ContactMesh, DiscOnACurvedFace) {
  const Vec3 direction = Vec3(0.5, -0.3, 0.8).normalized();
  const ContactMesh contact =
      make_contact_mesh(dome_base(), 0.05 * direction, kRadius, kRadius / 8);
  expect_sound(contact, dome_base());
  EXPECT_GT(contact.normal.dot(direction), std::cos(3 * M_PI / 180));
  // A cap of a sphere of radius R has the area pi a^2 (1 + a^2 / 4 R^2 ...).
  EXPECT_NEAR(contact.patch_area / (M_PI * kRadius * kRadius), 1, 0.01);
}

TEST(ContactMesh, SameInputSameBytesFromTwoThreads) {
  const ContactBase base = dome_base();
  const auto mesh = [&] {
    return make_contact_mesh(base, {0.01, 0.02, 0.045}, kRadius, kRadius / 4).mesh;
  };
  const TetMesh once = mesh();
  std::vector<TetMesh> results(2);
  std::thread first([&] { results[0] = mesh(); }), second([&] { results[1] = mesh(); });
  first.join();
  second.join();
  for (const TetMesh& result : results) {
    EXPECT_EQ(result.tets, once.tets);
    EXPECT_EQ(result.fixed, once.fixed);
    EXPECT_TRUE(
        std::equal(result.nodes.begin(), result.nodes.end(), once.nodes.begin(), once.nodes.end()));
  }
}

// The disc wraps an edge like a sheet, with its area; about a corner, where three right angles
// meet, a quarter of the sheet is too much.
TEST(ContactMesh, NearAndAcrossEdges) {
  const ContactBase base = block_base();
  // From the middle of the top over its edge and its corner.
  for (const double from_edge : {0.015, 0.006, 0.0045, 0.0041, 0.0039, 0.003, 0.001, 0.0}) {
    for (const Vec3& at : {Vec3(from_edge, 0.1, 0.06), Vec3(from_edge, from_edge, 0.06),
                           Vec3(0.12, 0.1, 0.06 - from_edge)}) {
      const bool corner = at.x() == at.y() && from_edge < kRadius;
      const auto [code, what] = test::error_of([&] {
        const ContactMesh contact = make_contact_mesh(base, at, kRadius, kRadius / 4);
        EXPECT_EQ(tet_quality(contact.mesh).inverted, 0u);
        EXPECT_GT(contact.patch_area, (corner ? 0.74 : 0.985) * M_PI * kRadius * kRadius);
        EXPECT_LT(contact.patch_area, 1.015 * M_PI * kRadius * kRadius);
      });
      EXPECT_EQ(code, 0) << what;
    }
  }
}

// Sharp edges stay: what the triangles cut off would be missing below the tool.
TEST(ContactMesh, KeepsTheEdgeItLiesBeside) {
  const ContactBase base = block_base();
  for (const double from_edge : {0.0, 0.0027, 0.0039, 0.0041, 0.006, 0.009}) {
    const ContactMesh contact =
        make_contact_mesh(base, {0.12 - from_edge, 0.1, 0.06}, kRadius, kRadius / 6);
    expect_sound(contact, base);
    EXPECT_NEAR(tet_quality(contact.mesh).volume / signed_volume(base.surface), 1, 2e-5)
        << from_edge;
    EXPECT_EQ(contact.normal.z() == 1, from_edge > kRadius) << contact.normal.transpose();
  }
}

TEST(ContactMesh, RefusesWhatCannotBe) {
  const ContactBase base = block_base();
  const auto error_at = [&](const Vec3& p) {
    return test::error_of([&] { make_contact_mesh(base, p, kRadius, kRadius / 4); });
  };
  auto [code, what] = error_at({0.06, 0.1, 0.1});
  EXPECT_EQ(code, 3);
  EXPECT_NE(what.find("off the surface"), std::string::npos) << what;
  std::tie(code, what) = error_at({60, 100, 60});
  EXPECT_EQ(code, 3);
  std::tie(code, what) = error_at({0.06, 0, 0.002});
  EXPECT_EQ(code, 3);
  EXPECT_NE(what.find("bonded"), std::string::npos) << what;
  std::tie(code, what) = error_at({std::nan(""), 0, 0});
  EXPECT_EQ(code, 3);
  std::tie(code, what) = test::error_of([&] {
    make_contact_mesh(base, {0.06, 0.1, 0.06}, 0.15, 0.01);
  });
  EXPECT_EQ(code, 0) << what;
  std::tie(code, what) = test::error_of([&] {
    make_contact_mesh(base, {0.06, 0.1, 0.06}, 4, 0.01);
  });
  EXPECT_EQ(code, 3);
  EXPECT_NE(what.find("covers the whole body"), std::string::npos) << what;
}

// The bonded far side of a layer lies within the tool's radius, and not under it.
TEST(ContactMesh, ADiscMayBeWiderThanALayerIsThick) {
  constexpr double kThick = 2.35e-3, kWide = 2.85e-3;
  const ContactBase base = make_contact_base(make_body_mesh(test::box({0.03, 0.03, kThick}), {}));
  const ContactMesh contact = make_contact_mesh(base, {0.015, 0.015, kThick}, kWide, kWide / 6);
  expect_sound(contact, base);
  EXPECT_NEAR(contact.patch_area / (M_PI * kWide * kWide), 1, 0.01);
  EXPECT_GT(contact.normal.z(), 0.999);
  for (const int n : contact.patch_nodes) EXPECT_NEAR(contact.mesh.nodes[n].z(), kThick, 1e-9);
}

// Between plates all of the top moves with the tool, and nothing of the sides.
TEST(ContactMesh, AToolThatCoversTheBodyCompressesIt) {
  const ContactBase base = block_base();
  const ContactMesh contact = make_contact_mesh(base, {0.06, 0.1, 0.06}, 0.15, 0.15 / 6);
  expect_sound(contact, base);
  EXPECT_NEAR(contact.patch_area / (0.12 * 0.21), 1, 1e-9);
  EXPECT_GT(contact.normal.z(), 0.999);
  std::size_t on_top = 0;
  for (const Vec3& p : contact.mesh.nodes) on_top += std::abs(p.z() - 0.06) < 1e-9;
  EXPECT_EQ(contact.patch_nodes.size(), on_top);
  // A dome touches a plate at a point.
  const auto [code, what] = test::error_of([] {
    make_contact_mesh(dome_base(), {0, 0, 0.05}, 0.06, 0.01);
  });
  EXPECT_EQ(code, 3);
  EXPECT_NE(what.find("grows between plates"), std::string::npos) << what;
}

class Independent : public ::testing::TestWithParam<const char*> {};

TEST_P(Independent, EveryPositionCanBeMeshed) {
  const std::string path = test::shared_path("independent/") + GetParam();
  HAPSIM_NEEDS_SHARED(path);
  Input input(path);
  const ContactBase base = make_contact_base(make_body_mesh(read_surface(input), {}));
  Random random(7);
  for (int i = 0; i < 40; ++i) {
    const Triangle& f = base.fine.faces[random.integer(base.fine.faces.size())];
    double a = random.uniform(), b = random.uniform();
    if (a + b > 1) a = 1 - a, b = 1 - b;
    const Vec3 p = (1 - a - b) * base.fine.vertices[f[0]] + a * base.fine.vertices[f[1]] +
                   b * base.fine.vertices[f[2]];
    if (p.z() < 1.5 * kRadius) continue;
    const auto [code, what] = test::error_of([&] {
      expect_sound(make_contact_mesh(base, p, kRadius, kRadius / (i % 2 ? 4 : 8)), base);
    });
    EXPECT_EQ(code, 0) << what;
  }
}

INSTANTIATE_TEST_SUITE_P(Bodies, Independent,
                         ::testing::Values("ball.stl", "blob.stl", "cuboid.stl"));

TEST(ContactMesh, ElementsEndAtASurfaceInside) {
  const ContactBase base = block_base();
  Surface inner = test::box({0.01, 0.012, 0.008});
  for (Vec3& v : inner.vertices) v += Vec3(0.055, 0.1, 0.045);  // 7 mm below the tool
  const ContactMesh contact =
      make_contact_mesh_around(base, {0.06, 0.105, 0.06}, kRadius, kRadius / 4, 0.4, {inner});
  expect_sound(contact, base);
  double inside = 0;
  for (const auto& n : contact.mesh.tets) {
    const auto& x = contact.mesh.nodes;
    const Vec3 middle = (x[n[0]] + x[n[1]] + x[n[2]] + x[n[3]]) / 4 - Vec3(0.055, 0.1, 0.045);
    if ((middle.array() > 0).all() && (middle - Vec3(0.01, 0.012, 0.008)).maxCoeff() < 0)
      inside += std::abs((x[n[1]] - x[n[0]]).cross(x[n[2]] - x[n[0]]).dot(x[n[3]] - x[n[0]])) / 6;
  }
  EXPECT_NEAR(inside / signed_volume(inner), 1, 1e-9);
}

}  // namespace
}  // namespace hapsim
