#include "realtime/stiffness_field.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "base/error.h"
#include "base/random.h"
#include "mesh/signed_distance.h"
#include "realtime/insert_vertex.h"
#include "support/block_mesh.h"

namespace hapsim {
namespace {

const Vec3 kSize(0.06, 0.06, 0.04);
constexpr double kFieldRadius = 0.004;

// Sampled once for all tests.
struct Sampled {
  std::shared_ptr<const ContactLibrary> library;
  std::unique_ptr<const FieldSampling> sampling;
  SampledMaterial material;
};

const Sampled& sampled() {
  static const Sampled made = [] {
    Sampled s;
    ContactLibraryOptions options;
    s.library = std::make_shared<const ContactLibrary>(test::block_mesh(kSize, 4, 4, 3, 1),
                                                       kFieldRadius, options);
    s.material.field = {0.45, [](const Vec3&) { return 1.0; }};
    s.material.solid.nu = 0.45;
    FieldSamplingOptions how;
    how.tolerance = 0.05;
    how.most = 120;
    s.sampling = std::make_unique<const FieldSampling>(s.library, kFieldRadius, s.material,
                                                       std::vector<Vec3>{}, how);
    return s;
  }();
  return made;
}

StiffnessField field_with(const std::vector<KnownStiffness>& known) {
  return {sampled().library->surface(), *sampled().sampling, known, kFieldRadius, 2};
}

FieldEntry at(const StiffnessField& field, const Vec3& p) {
  const SurfacePoint place = nearest_point(field.surface(), p);
  return field.entry_at(field.locate(place.face, place.point));
}

TEST(StiffnessField, IsThatOfTheContactMeshesWhereNoneWasSampled) {
  const StiffnessField field = field_with({});
  std::vector<Vec3> places;
  Random random(9);
  for (int i = 0; i < 12; ++i)
    places.emplace_back(0.002 + 0.056 * random.uniform(), 0.002 + 0.056 * random.uniform(), 0.04);
  const auto truth =
      sampled().library->sample(places, sampled().material.solid, "", ContactLevel::kFine, false);
  double squares = 0;
  int covered = 0, count = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!truth[i]) continue;
    const FieldEntry live = at(field, places[i]);
    const double error = (live.K - truth[i]->K).norm() / truth[i]->K.norm();
    squares += error * error;
    covered += error <= 1.96 * live.uncertainty ? 1 : 0;
    ++count;
  }
  EXPECT_LT(std::sqrt(squares / count), 0.05);
  EXPECT_GE(covered, count - 2);
}

TEST(StiffnessField, HasTheKnownStiffnessWhereItIsKnown) {
  Random random(3);
  std::vector<KnownStiffness> known;
  for (const Vec3& p : {Vec3(0.03, 0.03, 0.04), Vec3(0.0301, 0.025, 0.04), Vec3(0.06, 0.03, 0.02),
                        Vec3(0.015, 0, 0.03)}) {
    Eigen::Matrix3d m = 40 * Eigen::Matrix3d::Identity();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j <= i; ++j) m(i, j) = m(j, i) = m(i, j) + 5 * random.uniform();
    known.push_back({p, Vec3::UnitZ(), m});
  }
  const StiffnessField field = field_with(known);
  for (std::size_t k = 0; k < known.size(); ++k) {
    EXPECT_LT((at(field, known[k].point).K - known[k].K).norm(), 1e-9 * known[k].K.norm());
    EXPECT_EQ(field.entries()[static_cast<std::size_t>(field.known()[k])].K, known[k].K);
  }
  EXPECT_TRUE(is_closed(field.surface()));
  EXPECT_NEAR(signed_volume(field.surface()), kSize.prod(), 1e-12);
  EXPECT_NO_THROW(SignedDistance{field.surface()});
}

TEST(StiffnessField, IsPositiveDefiniteAndStraightBetweenItsEntries) {
  const StiffnessField field = field_with({});
  Random random(4);
  for (std::size_t f = 0; f < field.surface().faces.size(); ++f) {
    const Triangle& t = field.surface().faces[f];
    for (int i = 0; i < 20; ++i) {
      const double a = std::sqrt(random.uniform()), b = random.uniform();
      const Vec3 p = (1 - a) * field.surface().vertices[t[0]] +
                     a * (1 - b) * field.surface().vertices[t[1]] +
                     a * b * field.surface().vertices[t[2]];
      const StiffnessField::Place place = field.locate(static_cast<int>(f), p);
      EXPECT_NEAR(place.weight.sum(), 1, 1e-12);
      EXPECT_GE(place.weight.minCoeff(), 0);
      const FieldEntry entry = field.entry_at(place);
      EXPECT_LT((entry.point - p).norm(), 1e-9);  // the weights are those of the entries' places
      EXPECT_EQ(Eigen::LLT<Eigen::Matrix3d>(entry.K).info(), Eigen::Success);
      EXPECT_LT((entry.K - entry.K.transpose()).norm(), 1e-9 * entry.K.norm());
    }
  }
}

TEST(StiffnessField, SaysWhereNoContactMeshCanBe) {
  const StiffnessField field = field_with({});
  EXPECT_TRUE(at(field, {0.03, 0.03, 0.04}).sampled);
  EXPECT_FALSE(at(field, {0.03, 0, 0.001}).sampled);
}

TEST(StiffnessField, ReadsBackWhatItWrote) {
  const StiffnessField field = field_with({});
  const std::string bytes = field.bytes();
  EXPECT_EQ(StiffnessField(bytes).bytes(), bytes);
  std::string damaged = bytes;
  damaged[damaged.size() / 2] = static_cast<char>(damaged[damaged.size() / 2] + 1);
  EXPECT_THROW(StiffnessField{damaged}, Error);
  EXPECT_THROW(StiffnessField{bytes.substr(0, bytes.size() / 2)}, Error);
}

TEST(StiffnessField, RefusesAContactFarOffTheBody) {
  EXPECT_ANY_THROW(field_with({{Vec3(60, 105, 60), Vec3::UnitZ(), Eigen::Matrix3d::Identity()}}));
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
