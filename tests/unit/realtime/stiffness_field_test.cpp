#include "realtime/stiffness_field.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "base/random.h"
#include "contact/contact_stiffness.h"
#include "mesh/signed_distance.h"
#include "realtime/insert_vertex.h"
#include "support/block_mesh.h"

namespace hapsim {
namespace {

const Vec3 kSize(0.12, 0.21, 0.06);
constexpr double kRadius = 0.004;

TetMesh block() {
  return test::block_mesh(kSize, 5, 8, 3, 1, 0.1);
}

StiffnessField make_field(const TetMesh& mesh, double nu,
                          const std::vector<KnownStiffness>& known = {}) {
  SurfaceCompliance compliance(mesh);
  compliance.factorise(std::vector<Lame>(mesh.tets.size(), lame(1e4, nu)));
  return {mesh, compliance, {nu, [](const Vec3&) { return 1e4; }}, kRadius, known};
}

Eigen::Matrix3d at(const StiffnessField& field, const Vec3& p) {
  const SurfacePoint place = nearest_point(field.surface(), p);
  return field.at(place.face, place.point);
}

TEST(DiscCompliance, IsThePunchOnAHalfSpace) {
  const double E = 1e4, a = 0.01;
  // nu = 1/2: no bond matters, k = 2 E a / (1 - nu^2).
  const Eigen::Matrix3d soft = disc_compliance(E, 0.5, a, Vec3::UnitX());
  EXPECT_NEAR(1 / soft(0, 0), 2 * E * a / 0.75, 1e-6);
  EXPECT_NEAR(1 / disc_compliance(E, 0.4999, a, Vec3::UnitX())(0, 0), 2 * E * a / 0.75, 0.1);
  // nu = 0: k = 4 G a ln 3; across 8 G a / (2 - nu).
  const Eigen::Matrix3d cork = disc_compliance(E, 0, a, Vec3::UnitZ());
  EXPECT_NEAR(1 / cork(2, 2), 2 * E * a * std::log(3.0), 1e-9);
  EXPECT_NEAR(1 / cork(1, 1), 2 * E * a, 1e-9);
}

TEST(StiffnessField, IsNearTheFineMeshesWithoutThem) {
  const TetMesh mesh = block();
  const ContactBase base = make_contact_base(mesh);
  for (const double nu : {0.3, 0.45}) {
    const StiffnessField field = make_field(mesh, nu);
    for (const Vec3& p : {Vec3(0.06, 0.105, 0.06), Vec3(0.04, 0.06, 0.06)}) {
      const Eigen::Matrix3d fine = ContactBodies(base, p, kRadius, 0.3)
                                       .solve({nu, {1e4}, nullptr}, plan_grid(base.surface))
                                       .K;
      const Eigen::Matrix3d K = at(field, p);
      std::printf("nu %.2f at (%.3f, %.3f): normal stiffness %.1f N/m, fine %.1f\n", nu, p.x(),
                  p.y(), K(2, 2), fine(2, 2));
      EXPECT_LT((K - fine).norm(), 0.2 * fine.norm());
    }
  }
}

TEST(StiffnessField, HasTheKnownStiffnessWhereItIsKnown) {
  const TetMesh mesh = block();
  Random random(3);
  std::vector<KnownStiffness> known;
  for (const Vec3& p : {Vec3(0.06, 0.105, 0.06), Vec3(0.0601, 0.1, 0.06), Vec3(0.02, 0.05, 0.06),
                        Vec3(0.024, 0.02625, 0.06), Vec3(0.12, 0.1, 0.03), Vec3(0.03, 0, 0.04)}) {
    Eigen::Matrix3d m = 40 * Eigen::Matrix3d::Identity();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j <= i; ++j) m(i, j) = m(j, i) = m(i, j) + 5 * random.uniform();
    const Vec3 normal = p.x() == 0.12  ? Vec3(Vec3::UnitX())
                        : p.y() == 0.0 ? Vec3(-Vec3::UnitY())
                                       : Vec3(Vec3::UnitZ());
    known.push_back({p, normal, m});
  }
  const StiffnessField field = make_field(mesh, 0.4, known);
  for (const KnownStiffness& k : known)
    EXPECT_LT((at(field, k.point) - k.K).norm(), 1e-9 * k.K.norm()) << k.point.transpose();
  EXPECT_TRUE(is_closed(field.surface()));
  EXPECT_NEAR(signed_volume(field.surface()), kSize.prod(), 1e-12);
  EXPECT_NO_THROW(SignedDistance{field.surface()});
}

TEST(StiffnessField, IsPositiveDefiniteAndContinuousEverywhere) {
  const TetMesh mesh = block();
  const StiffnessField plain = make_field(mesh, 0.45);
  const Vec3 p(0.05, 0.11, 0.06);
  const StiffnessField field = make_field(mesh, 0.45, {{p, Vec3::UnitZ(), 1.3 * at(plain, p)}});
  const Surface& s = field.surface();
  for (std::size_t f = 0; f < s.faces.size(); ++f) {
    const Triangle& t = s.faces[f];
    const Vec3 centre = (s.vertices[t[0]] + s.vertices[t[1]] + s.vertices[t[2]]) / 3;
    const Eigen::Matrix3d K = field.at(static_cast<int>(f), centre);
    EXPECT_EQ(Eigen::LLT<Eigen::Matrix3d>(K).info(), Eigen::Success);
    EXPECT_LT((K - K.transpose()).norm(), 1e-9 * K.norm());
    for (int k = 0; k < 3; ++k)  // both faces at a vertex say the same
      EXPECT_LT((field.at(static_cast<int>(f), s.vertices[t[k]]) - field.at_vertex(t[k])).norm(),
                1e-9 * K.norm());
  }
  // A factor known at one place acts on all others.
  EXPECT_LT((at(field, {0.09, 0.03, 0.06}) - 1.3 * at(plain, {0.09, 0.03, 0.06})).norm(),
            1e-9 * at(plain, {0.09, 0.03, 0.06}).norm());
}

TEST(StiffnessField, RefusesAContactFarOffTheBody) {
  EXPECT_ANY_THROW(
      make_field(block(), 0.3, {{Vec3(60, 105, 60), Vec3::UnitZ(), Eigen::Matrix3d::Identity()}}));
}

TEST(InsertVertex, SplitsFacesAndEdges) {
  Surface s = boundary_surface(test::block_mesh({1, 1, 1}, 1, 1, 1, 1));
  const std::size_t faces = s.faces.size();
  const Triangle t = s.faces[0];
  const Vec3 a = s.vertices[t[0]], b = s.vertices[t[1]], c = s.vertices[t[2]];
  EXPECT_EQ(insert_vertex(s, 0, a), t[0]);
  EXPECT_EQ(s.faces.size(), faces);
  insert_vertex(s, 0, (a + b) / 2);
  EXPECT_EQ(s.faces.size(), faces + 2);
  const SurfacePoint inside = nearest_point(s, 0.3 * a + 0.3 * b + 0.4 * c);
  insert_vertex(s, inside.face, 0.31 * a + 0.29 * b + 0.4 * c);
  EXPECT_TRUE(is_closed(s));
  EXPECT_NEAR(signed_volume(s), 1, 1e-12);
}

}  // namespace
}  // namespace hapsim
