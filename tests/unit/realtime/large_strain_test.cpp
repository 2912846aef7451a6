// The response sampled at large strain: an energy, the linear body's for small displacements, the
// elements' at places that it was not sampled at, whichever way the body is turned.
#include "realtime/large_strain.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "base/error.h"
#include "expect_error.h"
#include "realtime/force_loop.h"
#include "realtime/strain_mesh.h"
#include "simulate/full_simulation.h"
#include "strained_body.h"
#include "support/allocations.h"

namespace hapsim {
namespace {

StepPlace place_at(const PreparedBody& body, const Vec3& point) {
  const SurfaceSide side = body.distance().at(point);
  return body.facts().at(side.face, side.point, side.normal);
}

// Among the samples, at none of them.
const Vec3 kBetween(0.052, 0.047, 0.06);

TEST(LargeStrain, PolynomialsHaveTheirDerivatives) {
  StrainCoefficients c;
  for (int t = 0; t < kStrainTerms; ++t) c[t] = std::sin(1.7 * t + 0.3);
  const Vec3 v(0.7, 0.4, -0.6);
  EXPECT_LT((strain_gradients(v) * c - strain_gradient(c, v)).norm(), 1e-12);
  for (int k = 0; k < 3; ++k) {
    const Vec3 h = 1e-5 * Vec3::Unit(k);
    const Vec3 difference = (strain_gradient(c, v + h) - strain_gradient(c, v - h)) / 2e-5;
    EXPECT_LT((difference - strain_hessian(c, v).col(k)).norm(), 1e-7);
  }
}

TEST(LargeStrain, AClosedWayDoesNoWork) {
  const PreparedBody& body = test::strained_body();
  const LargeStrain& strain = *body.large_strain();
  const LargeStrain::Place place = strain.at(place_at(body, kBetween));
  const double a = test::kStrainedRadius;
  double work = 0, size = 0;
  const int steps = 2000;
  const auto way = [&](int i) {
    const double angle = 2 * std::numbers::pi * i / steps;
    return Vec3(0.4 * a * std::cos(angle), 0.3 * a * std::sin(2 * angle),
                -a * (0.9 + 0.5 * std::sin(angle)));
  };
  for (int i = 0; i < steps; ++i) {
    const Vec3 step = way(i + 1) - way(i);
    const LargeStrain::Force f = strain.force(place, 0.5 * (way(i) + way(i + 1)));
    ASSERT_TRUE(f.within);
    work += f.f.dot(step);
    size += std::abs(f.f.dot(step));
  }
  EXPECT_LT(std::abs(work), 1e-5 * size);
  // And its energy is the work of coming there.
  const Vec3 u = way(300), h(1e-7, 2e-7, -1e-7);
  EXPECT_NEAR(strain.energy(place, u + h) - strain.energy(place, u - h),
              2 * strain.force(place, u).f.dot(h),
              1e-6 * strain.force(place, u).f.norm() * h.norm());
}

TEST(LargeStrain, SmallDisplacementsAreTheLinearBodys) {
  const PreparedBody& body = test::strained_body();
  const StepPlace at = place_at(body, kBetween);
  const LargeStrain::Place place = body.large_strain()->at(at);
  for (const Vec3& u : {Vec3(1e-6, 0, 0), Vec3(0, 2e-6, -1e-6), Vec3(0, 0, 1e-6)}) {
    const LargeStrain::Force f = body.large_strain()->force(place, u);
    EXPECT_LT((f.f - at.contact.K * u).norm(), 1e-3 * f.f.norm());
  }
}

TEST(LargeStrain, IsTheElementsAtAPlaceBetweenSamplesAndSaysHowWell) {
  const PreparedBody& body = test::strained_body();
  const LargeStrain& strain = *body.large_strain();
  const StepPlace at = place_at(body, kBetween);
  const LargeStrain::Place place = strain.at(at);
  const TetMesh mesh = test::strained_mesh();
  FullOptions options;
  options.rim_edge = 0.5;
  options.growth = 0.6;
  options.quarter_points = false;
  options.solve.past_instability = true;
  FullPress press(mesh, test::strained_model(), kBetween, test::kStrainedRadius, options);
  const Eigen::Matrix3d K = *press.stiffness();
  const double ratio = at.contact.K(2, 2) / K(2, 2);
  double worst = 0, linear = 0;
  int covered = 0;
  const int steps = 6;
  for (int i = 1; i <= steps; ++i) {
    const Vec3 u = test::kStrainedRadius * i * Vec3(0.09, 0.03, -0.3);
    const Vec3 f = -press.step(u, 0);
    const Vec3 beyond = ratio * (f - K * u);  // what the linear stiffness does not know
    const LargeStrain::Force found = strain.force(place, u);
    EXPECT_TRUE(found.within);
    const double off = (found.f - at.contact.K * u - beyond).norm() / found.f.norm();
    worst = std::max(worst, off);
    linear = std::max(linear, beyond.norm() / found.f.norm());
    covered += off < 1.96 * found.doubt ? 1 : 0;
  }
  EXPECT_LT(worst, 0.03);
  EXPECT_GT(linear, 0.2);  // it was needed
  EXPECT_GE(covered, steps - 1);
}

TEST(LargeStrain, GoesOnWithTheTangentBeyondWhatWasSolvedAndSaysSo) {
  const PreparedBody& body = test::strained_body();
  const LargeStrain& strain = *body.large_strain();
  const LargeStrain::Place place = strain.at(place_at(body, kBetween));
  const Vec3 end(0, 0, -place.into), step(0, 0, -1e-6);
  EXPECT_TRUE(strain.force(place, end).within);
  const LargeStrain::Force inside = strain.force(place, end - step), at = strain.force(place, end),
                           outside = strain.force(place, end + step);
  EXPECT_FALSE(outside.within);
  EXPECT_LT(((outside.f - at.f) - (at.f - inside.f)).norm(), 1e-3 * (at.f - inside.f).norm());
  EXPECT_GT(strain.force(place, 1.2 * end).doubt, at.doubt);
  ForceLoop loop(body);
  loop.begin(kBetween);
  loop.press(0, 0.5 * end);
  EXPECT_EQ(loop.beyond() & kBeyondLaw, 0);
  loop.press(0.1, 1.05 * end);
  EXPECT_NE(loop.beyond() & kBeyondLaw, 0);
}

TEST(LargeStrain, ATurnedBodyHasTurnedForces) {
  const Model model = static_part(test::strained_model());
  const TetMesh mesh =
      test::block_mesh({0.05, 0.05, 0.03}, 2, 2, 2, 1);  // smaller than strained_mesh()
  TetMesh turned = mesh;
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(0.8, Vec3(0.3, -0.5, 0.9).normalized()).toRotationMatrix();
  for (Vec3& p : turned.nodes) p = R * p;
  const auto sample = [&](const TetMesh& body, const Vec3& at) {
    std::string why;
    return solve_strain_sample(body, make_contact_base(body), model, at, test::kStrainedRadius, 1,
                               false, why);
  };
  const Vec3 place(0.026, 0.023, 0.03);
  const auto a = sample(mesh, place), b = sample(turned, R * place);
  ASSERT_TRUE(a && b);
  const double k_a = a->K(2, 2), k_b = b->frame.row(0) * b->K * b->frame.row(0).transpose();
  for (const Vec3& u : {Vec3(0, 0, -0.9), Vec3(0.5, 0.2, -0.8), Vec3(-0.3, 0.4, -1)}) {
    const Vec3 f = k_a * a->frame.transpose() * strain_gradient(a->c, a->frame * u);
    const Vec3 g = k_b * b->frame.transpose() * strain_gradient(b->c, b->frame * R * u);
    EXPECT_LT((R * f - g).norm(), 0.04 * (k_a * u).norm());  // other meshes
  }
}

TEST(LargeStrain, GoesOnFromTheSamplesOfARunThatWasEnded) {
  const PreparedBody& body = test::strained_body();
  const std::string folder = (std::filesystem::path(test::shared_cache()) / "ended").string();
  std::filesystem::create_directory(folder);
  PreparedBodyOptions options = test::strained_options();
  options.cache = folder;
  int kept = 0;
  for (const auto& file : std::filesystem::directory_iterator(test::shared_cache())) {
    const bool sample = file.path().extension() == ".strain";
    if (!sample && file.path().extension() != ".field") continue;
    if (sample && ++kept == 3) continue;  // had not come yet
    std::filesystem::copy(file.path(), folder + "/" + file.path().filename().string());
    if (sample && kept == 2)  // was cut off
      std::filesystem::resize_file(folder + "/" + file.path().filename().string(), 100);
  }
  const auto samples = [&] {
    int count = 0;
    for (const auto& file : std::filesystem::directory_iterator(folder))
      count += file.path().extension() == ".strain" && file.file_size() > 100 ? 1 : 0;
    return count;
  };
  const int before = samples();
  const PreparedBody again(test::strained_mesh(), test::strained_model(), options);
  EXPECT_EQ(samples(), before + 2);
  const Vec3 u(1e-3, 2e-3, -1e-2);
  const LargeStrain &first = *body.large_strain(), &second = *again.large_strain();
  EXPECT_EQ(first.force(first.at(place_at(body, kBetween)), u).f,
            second.force(second.at(place_at(again, kBetween)), u).f);
}

// No place was pulled beforehand.
TEST(LargeStrain, SaysThatALargePullIsTheLinearForceAlone) {
  const PreparedBody& body = test::strained_body();
  const StepPlace at = place_at(body, kBetween);
  const LargeStrain::Place place = body.large_strain()->at(at);
  const double a = test::kStrainedRadius;
  const LargeStrain::Force little = body.large_strain()->force(place, {0, 0, 0.05 * a}),
                           much = body.large_strain()->force(place, {0, 0, 0.4 * a});
  EXPECT_TRUE(little.within);
  EXPECT_LT(little.doubt, 0.1);
  EXPECT_FALSE(much.within);
  EXPECT_GT(much.doubt, 0.3);
  EXPECT_LT((much.f - at.contact.K * Vec3(0, 0, 0.4 * a)).norm(), 1e-12 * much.f.norm());
}

// A sample is doubted by what finer elements say, by all where there are none.
TEST(LargeStrain, FinerElementsDoubtASample) {
  const TetMesh mesh = test::block_mesh({0.05, 0.05, 0.03}, 2, 2, 2, 1);
  const ContactBase base = make_contact_base(mesh);
  Model model = static_part(test::strained_model());
  const double radius = 0.5 * test::kStrainedRadius;
  std::string why;
  auto sample = solve_strain_sample(mesh, base, model, {0.026, 0.023, 0.03}, radius, 1, false, why);
  ASSERT_TRUE(sample);
  const StrainMeshError own = strain_mesh_error(mesh, base, model, *sample, radius);
  sample->c *= 1.5;
  const StrainMeshError off = strain_mesh_error(mesh, base, model, *sample, radius);
  for (std::size_t i = 0; i < own.size(); ++i) EXPECT_LT(own[i], 0.04);
  EXPECT_GT(off.back(), own.back() + 0.05);
  EXPECT_GT(off.back(), off.front());
  model.find("elastic", 0, "E")->value = -2e4;
  for (const double unknown : strain_mesh_error(mesh, base, model, *sample, radius))
    EXPECT_GE(unknown, 0.2);
}

// No elements take a modulus below zero.
TEST(LargeStrain, SaysWhyAPlaceIsRefused) {
  const TetMesh mesh = test::block_mesh({0.05, 0.05, 0.03}, 2, 2, 2, 1);
  Model model = static_part(test::strained_model());
  model.find("elastic", 0, "E")->value = -2e4;
  for (const bool memory : {false, true}) {
    std::string why;
    EXPECT_FALSE(solve_strain_sample(mesh, make_contact_base(mesh), model, {0.026, 0.023, 0.03},
                                     test::kStrainedRadius, 1, memory, why));
    EXPECT_FALSE(why.empty());
  }
}

TEST(LargeStrain, IsOfModelsOfFiniteStrain) {
  const Model model = static_part(test::strained_model(8e3));
  EXPECT_FALSE(model.has("viscoelastic"));
  EXPECT_TRUE(model.has("hyperelastic"));
  Model linear = test::strained_model();
  linear.find("hyperelastic", 0, "finite")->value = 0;
  EXPECT_THROW(static_part(linear), Error);
}

// Whether it relaxes or not, at other places in every touch.
TEST(LargeStrain, TakesNoMemory) {
  for (const PreparedBody* body : {&test::strained_body(), &test::relaxing_body()}) {
    ForceLoop loop(*body);
    const long before = test::allocations;
    double largest = 0;
    for (int i = 0; i < 20000; ++i) {
      const double t = 1e-3 * i;
      const Vec3 tool =
          test::kStrainedPlace +
          Vec3(0.01 * std::sin(0.9 * t), 0.01 * std::sin(1.3 * t), 0.0005 - 0.02 * std::sin(5 * t));
      const Vec3 f = loop.step(t, tool);
      ASSERT_TRUE(f.allFinite());
      largest = std::max(largest, f.norm());
    }
    EXPECT_EQ(test::allocations - before, 0);
    EXPECT_GT(largest, 1);
  }
}

}  // namespace
}  // namespace hapsim
