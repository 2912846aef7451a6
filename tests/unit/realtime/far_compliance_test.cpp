// What a body yields beyond a half-space: a limb bends as a beam, a thick block hardly does.
#include "realtime/far_compliance.h"

#include <gtest/gtest.h>

#include "contact/contact_library.h"
#include "realtime/place_model.h"
#include "support/block_mesh.h"

namespace hapsim {
namespace {

constexpr double kRadius = 0.004, kPoisson = 0.4;

Material soft() {
  Material material;
  material.nu = kPoisson;
  return material;
}

// Force and displacement at z = L across a beam held at z = 0: L^3 / (3 E I) + 6 L / (5 G A)
// (Timoshenko); along it L / (E A).
TEST(FarCompliance, ALimbBendsAsABeam) {
  const double a = 0.02, L = 0.18;
  const ContactBase base = make_contact_base(test::block_mesh({a, a, 0.2}, 4, 4, 40, 1));
  const FarCompliance far(base, kRadius, soft(), 1);
  const double bends = 12 * L * L * L / (3 * a * a * a * a),
               shears = 6 * L / (5 * a * a) * 2 * (1 + kPoisson);
  const Eigen::Matrix3d C = far.at({a, a / 2, L}, Vec3::UnitX());
  EXPECT_NEAR(C(0, 0) / (bends + shears), 1, 0.02);
  EXPECT_NEAR(C(1, 1) / (bends + shears), 1, 0.02);
  EXPECT_NEAR(C(0, 1) / C(0, 0), 0, 0.01);
}

// Of a block as wide and deep as twenty tools, a half-space is the most.
TEST(FarCompliance, AThickBlockIsNearlyAHalfSpace) {
  const ContactBase base = make_contact_base(test::block_mesh({0.16, 0.16, 0.08}, 8, 8, 4, 1));
  const FarCompliance far(base, kRadius, soft(), 1);
  const Eigen::Matrix3d disc = disc_compliance(1, kPoisson, kRadius, Vec3::UnitZ());
  const Eigen::Matrix3d middle = far.at({0.08, 0.08, 0.08}, Vec3::UnitZ());
  EXPECT_LT(middle.norm(), 0.1 * disc.norm());
  EXPECT_LT(middle(2, 2), 0) << "it stands on a rigid plate";
  EXPECT_GT(far.at({0.158, 0.08, 0.08}, Vec3::UnitZ())(2, 2), middle(2, 2)) << "an edge is softer";
}

// The expected stiffness is near the solved one where the body itself yields most.
TEST(FarCompliance, WithTheHalfSpaceItIsNearlyWhatContactsGive) {
  const TetMesh body = test::block_mesh({0.03, 0.03, 0.15}, 4, 4, 20, 1);
  const ContactLibrary library(body, kRadius, {});
  const auto far = std::make_shared<const FarCompliance>(library.base(), kRadius, soft(), 1);
  const PlaceViews views(library.surface(), library.bonded(), kRadius,
                         {kPoisson, [](const Vec3&) { return 1.0; }}, far);
  const std::vector<Vec3> places{{0.03, 0.015, 0.04}, {0.03, 0.015, 0.075}, {0.03, 0.015, 0.13}};
  const auto solved = library.sample(places, soft(), "", ContactLevel::kFine, false);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Eigen::Matrix3d root = views.at(places[i]).reference;
    EXPECT_LT((root * root - solved[i]->K).norm(), 0.1 * solved[i]->K.norm()) << i;
  }
}

}  // namespace
}  // namespace hapsim
