// Layers, inclusions, transverse isotropy and giving supports: identities, another assembly, finite
// differences.
#include "contact/featured_body.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "material/hooke_law.h"
#include "nonlinear/nonlinear_body.h"
#include "solid/elastic_body.h"
#include "support/block_mesh.h"

namespace hapsim {
namespace {

constexpr double kFeatureRadius = 0.004;
constexpr double kFeatureNu = 0.42;

class Featured : public ::testing::Test {
 protected:
  static const ContactBase& base() {
    static const ContactBase base =
        make_contact_base(test::block_mesh({0.06, 0.05, 0.03}, 6, 6, 4, 1));
    return base;
  }
  static const ContactMesh& contact() {
    static const ContactMesh mesh =
        make_contact_mesh(base(), {0.033, 0.024, 0.03}, kFeatureRadius, kFeatureRadius / 3, 0.6);
    return mesh;
  }
  static FeaturedBody::Solution solve(const std::vector<BodyFeature>& features,
                                      double nu = kFeatureNu,
                                      const std::vector<double>& modulus = {1e4}) {
    Material material{nu, modulus, nullptr, features};
    if (modulus.size() > 1) material.group_of = [](const Vec3& p) { return p.x() > 0.033; };
    static FeaturedBody body(contact(), free_surface(base()));
    return body.solve(material);
  }
  static void expect_derivatives(const std::vector<BodyFeature>& features, double step) {
    const auto s = solve(features, kFeatureNu, {1e4, 2e4});
    const auto compare = [](const char* what, const Eigen::Matrix3d& exact,
                            const Eigen::Matrix3d& up, const Eigen::Matrix3d& down, double twice,
                            double unit) {
      const Eigen::Matrix3d difference = (up - down) / twice;
      EXPECT_LT((exact - difference).norm(), 2e-5 * (difference.norm() + unit)) << what;
    };
    const double size = s.K.norm();
    compare("nu", s.by_nu, solve(features, kFeatureNu + 1e-5, {1e4, 2e4}).K,
            solve(features, kFeatureNu - 1e-5, {1e4, 2e4}).K, 2e-5, size);
    compare("modulus 1", s.by_modulus[1], solve(features, kFeatureNu, {1e4, 2e4 + 2}).K,
            solve(features, kFeatureNu, {1e4, 2e4 - 2}).K, 4, size / 2e4);
    for (std::size_t f = 0; f < features.size(); ++f)
      for (std::size_t v = 0; v < features[f].value.size(); ++v) {
        auto up = features, down = features;
        const double h = step * std::max(std::abs(features[f].value[v]), 1e-3);
        up[f].value[v] += h;
        down[f].value[v] -= h;
        compare(std::to_string(v).c_str(), s.by_feature[f][v], solve(up, kFeatureNu, {1e4, 2e4}).K,
                solve(down, kFeatureNu, {1e4, 2e4}).K, 2 * h, size);
      }
  }
};

// The order of elimination is kept for the same system and not for another.
TEST_F(Featured, GivingBackTheMatrixChangesNoResult) {
  FeaturedBody body(contact(), free_surface(base()));
  const Material plain{kFeatureNu, {1e4}, nullptr, {}};
  const Material on_springs{kFeatureNu, {1e4}, nullptr, {{Feature::kSupport, {0.004, 0.3, 0.002}}}};
  const Eigen::Matrix3d K = body.solve(plain).K, on_K = body.solve(on_springs).K;
  EXPECT_NE(K, on_K);
  const std::size_t with_matrix = body.held_bytes();
  body.forget_system();
  EXPECT_GT(body.held_bytes(), 0U);
  EXPECT_LT(body.held_bytes(), with_matrix / 20);
  EXPECT_EQ(body.solve(on_springs).K, on_K);
  body.forget_system();
  EXPECT_EQ(body.solve(plain).K, K);
}

TEST_F(Featured, WithoutFeaturesItIsTheElasticBody) {
  std::vector<int> handle(contact().mesh.nodes.size(), kFreeNode);
  for (std::size_t n = 0; n < handle.size(); ++n)
    if (contact().mesh.fixed[n]) handle[n] = kHeldNode;
  for (const int n : contact().patch_nodes) handle[n] = 0;
  ElasticBody body(contact().mesh, handle, Dilatation::kElement);
  body.factorise(std::vector<Lame>(contact().mesh.tets.size(), lame(1e4, kFeatureNu)));
  const Eigen::Matrix3d K = body.solve(Eigen::Matrix3d::Identity()).reaction;
  const auto s = solve({});
  EXPECT_LT((s.K - K).norm(), 1e-10 * K.norm());
  EXPECT_LT((s.K - 1e4 * s.by_modulus[0]).norm(), 1e-10 * K.norm());
}

TEST_F(Featured, AtTheIdentityNothingChanges) {
  const Eigen::Matrix3d K = solve({}).K;
  const auto change = [&](Feature kind, const std::vector<double>& value) {
    return (solve({{kind, value}}).K - K).norm() / K.norm();
  };
  EXPECT_LT(change(Feature::kLayer, {0.003, 1}), 1e-10);
  EXPECT_LT(change(Feature::kInclusion, {0.03, 0.02, 0.02, 0.005, 1}), 1e-10);
  EXPECT_LT(change(Feature::kTransverse, {1, 1, 0.4, 0.7}), 1e-10);
  EXPECT_LT(change(Feature::kTension, {0}), 1e-10);
  EXPECT_LT(change(Feature::kSupport, {0, 0, 0}), 1e-3);
  EXPECT_LT(change(Feature::kSupport, {1, 0, 1}), 1e-3);  // beyond an edge that is outside
}

TEST_F(Featured, AZoneOverAllIsAnotherModulus) {
  const Eigen::Matrix3d K = solve({}).K;
  EXPECT_LT((solve({{Feature::kLayer, {1, 2.5}}}).K - 2.5 * K).norm(), 1e-10 * K.norm());
  EXPECT_LT((solve({{Feature::kInclusion, {0.03, 0.02, 0.02, 1, 2.5}}}).K - 2.5 * K).norm(),
            1e-10 * K.norm());
}

// Against BodyAssembly, which integrates the law itself point by point.
TEST_F(Featured, TransverseIsotropyIsTheLawsOwn) {
  const double ratio = 2.2, shear = 0.7, tilt = 0.9, azimuth = 0.4;
  const Vec3 axis(std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth),
                  std::cos(tilt));
  const double root = std::sqrt(ratio);
  BodyModel model;
  model.mesh = &contact().mesh;
  model.laws = {transverse_law({1e4, 1e4 * ratio, kFeatureNu, kFeatureNu * root,
                                1e4 * shear * root / (2 * (1 + kFeatureNu))},
                               axis)};
  model.law_of_tet.assign(contact().mesh.tets.size(), 0);
  model.dilatation = Dilatation::kElement;
  std::vector<int> handle(contact().mesh.nodes.size(), kFreeNode);
  for (std::size_t n = 0; n < handle.size(); ++n)
    if (contact().mesh.fixed[n]) handle[n] = kHeldNode;
  for (const int n : contact().patch_nodes) handle[n] = 0;
  const Eigen::Matrix3d K = NonlinearBody(model, handle).linearise().K;
  const Eigen::Matrix3d mine = solve({{Feature::kTransverse, {ratio, shear, tilt, azimuth}}}).K;
  EXPECT_LT((mine - K).norm(), 1e-9 * K.norm());
}

TEST_F(Featured, DerivativesAreTheDifferences) {
  expect_derivatives({{Feature::kLayer, {0.0041, 2.0}}}, 1e-5);
  expect_derivatives({{Feature::kInclusion, {0.031, 0.022, 0.021, 0.0062, 3.0}}}, 1e-6);
  expect_derivatives({{Feature::kTransverse, {1.8, 0.8, 0.6, 0.5}}}, 1e-5);
  expect_derivatives({{Feature::kSupport, {0.004, 0.3, 0.002}}}, 1e-6);
  expect_derivatives({{Feature::kTension, {8e-4}}}, 1e-6);
  expect_derivatives({{Feature::kLayer, {0.0041, 2.0}},
                      {Feature::kTransverse, {1.8, 0.8, 0.6, 0.5}},
                      {Feature::kSupport, {0.004, 0.3, 0.002}}},
                     1e-6);
}

// Where the support ends within faces, against meshes whose bonded part ends there and that have no
// springs at all: the forces' change with the edge is that of the bodies, and so is the edge that
// would be found from them.
TEST(Support, AnEdgeWithinFacesIsTheMeshThatFollowsIt) {
  const Vec3 size(0.06, 0.05, 0.02), at(0.033, 0.024, 0.02);
  const auto body_of = [&](int cells, double bonded_to) {
    TetMesh mesh = test::block_mesh(size, cells, 6, 4, 1);
    for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
      if (mesh.nodes[n].x() > bonded_to + 1e-9) mesh.fixed[n] = 0;
    return make_contact_base(mesh);
  };
  const auto stiffness = [&](const ContactBase& base, const std::vector<BodyFeature>& features) {
    const ContactMesh contact =
        make_contact_mesh(base, at, kFeatureRadius, kFeatureRadius / 3, 0.8);
    FeaturedBody body(contact, free_surface(base));
    return body.solve({kFeatureNu, {1e4}, nullptr, features}).K;
  };
  // Edges that fall between the nodes of the first body; each second body has nodes there.
  const ContactBase whole = body_of(6, 1);
  double worst = 0, sum = 0;
  int count = 0;
  for (const double edge : {0.024, 0.028, 0.032, 0.036, 0.040, 0.044}) {
    const Eigen::Matrix3d known = stiffness(body_of(15, edge), {});
    const auto found = [&](double e) {
      return stiffness(whole, {{Feature::kSupport, {10, 0, e - size.x() / 2}}});
    };
    const Eigen::Matrix3d here = found(edge),
                          slope = (found(edge + 2e-3) - found(edge - 2e-3)) / 4e-3;
    // Edge that explains the known stiffness best, to first order.
    const double shift = (known - here).cwiseProduct(slope).sum() / slope.squaredNorm();
    std::printf("edge at %.0f mm: stiffness errs by %.2f %%, edge by %.2f mm\n", 1e3 * edge,
                100 * (here - known).norm() / known.norm(), 1e3 * shift);
    worst = std::max(worst, std::abs(shift));
    sum += shift;
    ++count;
  }
  EXPECT_LT(worst, 2.5e-3);
  EXPECT_LT(std::abs(sum / count), 1e-3);
}

// A tension stiffens the tool's way into the surface, and hardly its way along it.
TEST_F(Featured, ATensionStiffens) {
  const Eigen::Matrix3d K = solve({}).K, tense = solve({{Feature::kTension, {4e-4}}}).K;
  const double into = tense(2, 2) / K(2, 2), along = tense(0, 0) / K(0, 0);
  std::printf("tension of 0.1 tool radii: %.3f into the surface, %.3f along it\n", into, along);
  EXPECT_GT(into, 1.02);
  EXPECT_GT(along, 1);
  EXPECT_LT(along - 1, 0.1 * (into - 1));
}

// A support that gives everywhere is in series with the body: more give, less stiffness, down to
// nothing.
TEST_F(Featured, AGivingSupportSoftens) {
  const double bonded = solve({}).K(2, 2);
  double before = bonded;
  for (const double give : {0.002, 0.01, 0.1, 100.0}) {
    const double k = solve({{Feature::kSupport, {give, 0, -1}}}).K(2, 2);
    EXPECT_LT(k, before) << give;
    before = k;
  }
  EXPECT_LT(before, 0.01 * bonded);
}

}  // namespace
}  // namespace hapsim
