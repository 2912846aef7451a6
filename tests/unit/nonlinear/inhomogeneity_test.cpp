// Shares of elements inside boundaries, and forces that follow a boundary smoothly.
#include "solid/inhomogeneity.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "expect_error.h"
#include "material/hooke_law.h"
#include "nonlinear/nonlinear_body.h"
#include "solid/elastic_body.h"
#include "support/block_mesh.h"

namespace hapsim {
namespace {

Surface box_surface(const Vec3& low, const Vec3& high) {
  Surface s = boundary_surface(test::block_mesh(high - low, 1, 1, 1, 1));
  for (Vec3& v : s.vertices) v += low;
  return s;
}

double inside_volume(const TetMesh& mesh, const std::vector<double>& share) {
  double sum = 0;
  for (std::size_t t = 0; t < share.size(); ++t) sum += share[t] * tet_volume(mesh, t);
  return sum;
}

TEST(LevelSet, RayCountingTellsInsideFromOutside) {
  const std::vector<Vec3> l_shape{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
  EXPECT_TRUE(inside_polygon(l_shape, {0.5, 1.5, 9}));
  EXPECT_TRUE(inside_polygon(l_shape, {1.5, 0.5, -3}));
  EXPECT_FALSE(inside_polygon(l_shape, {1.5, 1.5, 0}));
  EXPECT_FALSE(inside_polygon(l_shape, {-0.1, 1, 0}));
  const Surface box = box_surface({0, 0, 0}, {1, 2, 3});
  Random random(3);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p(2 * random.uniform() - 0.5, 3 * random.uniform() - 0.5,
                 4 * random.uniform() - 0.5);
    const bool inside = p.minCoeff() > 0 && p.x() < 1 && p.y() < 2 && p.z() < 3;
    ASSERT_EQ(inside_polyhedron(box, p), inside) << p.transpose();
  }
  // Rays that meet edges and corners are turned.
  EXPECT_TRUE(inside_polyhedron(box, {0.5, 1, 1.5}));
}

TEST(LevelSet, DerivativesAreTheDifferences) {
  const Vec3 p(0.3, 0.45, 0.6);
  const std::vector<double> start{0.1, 0.2, 0.3, 0.5, 0.7, 0.4};
  const auto ellipsoid = [&](const std::vector<double>& v) {
    return ellipsoid_level({v[0], v[1], v[2]}, {v[3], v[4], v[5]})(p);
  };
  const std::vector<double> corners{0.1, 0.1, 0.9, 0.2, 0.6, 0.8};
  const auto polygon = [&](const std::vector<double>& v) {
    return polygon_level({{v[0], v[1], 0}, {v[2], v[3], 0}, {v[4], v[5], 0}})(p);
  };
  const auto check = [](const auto& level, const std::vector<double>& at) {
    const LevelValue given = level(at);
    for (std::size_t k = 0; k < at.size(); ++k) {
      std::vector<double> up = at, down = at;
      up[k] += 1e-6;
      down[k] -= 1e-6;
      EXPECT_NEAR((level(up).value - level(down).value) / 2e-6,
                  given.by_parameters[static_cast<Eigen::Index>(k)], 1e-7)
          << k;
    }
  };
  check(ellipsoid, start);
  check(polygon, corners);
  // On the boundary the level is zero, near it the distance.
  EXPECT_NEAR(ellipsoid_level({0, 0, 0}, {1, 2, 3})({1, 0, 0}).value, 0, 1e-12);
  EXPECT_NEAR(ellipsoid_level({0, 0, 0}, {1, 2, 3})({0, 2.01, 0}).value, 0.01, 1e-4);
  EXPECT_THROW(polygon_level({{0, 0, 0}}), Error);
}

TEST(Inhomogeneity, CutIsExactAndSoAreItsDerivatives) {
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    std::array<double, 4> v;
    for (double& x : v) x = random.normal();
    const CutShare cut = cut_share(v);
    // By the formula for all corner signs at once: sum of v_i^3 / prod (v_i - v_j) over negative i.
    double exact = 0;
    for (int a = 0; a < 4; ++a) {
      if (v[a] >= 0) continue;
      double term = v[a] * v[a] * v[a];
      for (int b = 0; b < 4; ++b)
        if (b != a) term /= v[a] - v[b];
      exact += term;
    }
    EXPECT_NEAR(cut.share, exact, 1e-9);
    for (int k = 0; k < 4; ++k) {
      std::array<double, 4> up = v, down = v;
      const double h = 1e-6 * std::abs(v[k]);
      up[k] += h;
      down[k] -= h;
      const double difference = (cut_share(up).share - cut_share(down).share) / (2 * h);
      EXPECT_NEAR(difference, cut.by_value[k], 1e-5 * (1 + std::abs(cut.by_value[k])));
    }
  }
}

TEST(Inhomogeneity, VolumesAreTheBoundarys) {
  const TetMesh mesh = test::block_mesh({1, 1, 1}, 8, 8, 8, 1, 0.2);
  const double exact = 4.0 / 3 * M_PI * 0.3 * 0.25 * 0.2;
  double error[3];
  for (int s = 0; s < 3; ++s)
    error[s] =
        inside_volume(
            mesh,
            inside_shares(mesh, ellipsoid_level({0.5, 0.5, 0.5}, {0.3, 0.25, 0.2}), s).share) /
            exact -
        1;
  std::printf("ellipsoid's volume errs by %.2g, %.2g, %.2g\n", error[0], error[1], error[2]);
  EXPECT_LT(std::abs(error[2]), 0.02);
  EXPECT_GT(std::log2(error[0] / error[1]), 1.6);  // second order in the part's edge
  EXPECT_GT(std::log2(error[1] / error[2]), 1.6);
  // Flat boundaries are exact but for corners.
  const LevelSet half = polygon_level({{-1, -1, 0}, {0.437, -1, 0}, {0.437, 2, 0}, {-1, 2, 0}});
  EXPECT_NEAR(inside_volume(mesh, inside_shares(mesh, half).share), 0.437, 1e-12);
  const LevelSet box = polyhedron_level(box_surface({-1, -1, 0.3}, {2, 2, 0.713}));
  EXPECT_NEAR(inside_volume(mesh, inside_shares(mesh, box).share), 0.413, 1e-3);
  const LevelSet skin = layer_level(boundary_surface(mesh), 0.1);
  EXPECT_NEAR(inside_volume(mesh, inside_shares(mesh, skin, 2).share), 1 - 0.8 * 0.8 * 0.8, 5e-3);
}

// A stiff half under a press: as its border moves over the mesh the force follows smoothly, where
// centroids make it jump; the derivative by the border's place is the difference.
TEST(Inhomogeneity, ForceFollowsTheBoundarySmoothly) {
  const TetMesh mesh = test::block_mesh({0.06, 0.05, 0.03}, 6, 5, 4, 2, 0.1);
  std::vector<int> handle(mesh.nodes.size(), kFreeNode);
  for (std::size_t i = 0; i < handle.size(); ++i) {
    if (mesh.fixed[i]) handle[i] = kHeldNode;
    if ((mesh.nodes[i] - Vec3(0.03, 0.025, 0.03)).norm() < 0.011) handle[i] = 0;
  }
  NonlinearBody body(BodyModel{&mesh, {isotropic_law(1e4, 0.4)}}, handle);
  const double ratio = 3;
  const auto border = [](double x) {
    return polygon_level({{x, -1, 0}, {1, -1, 0}, {1, 1, 0}, {x, 1, 0}});
  };
  const auto force = [&](const std::vector<double>& factors) {
    body.set_scale(factors);
    EXPECT_TRUE(body.solve(Vec3(0, 0, -0.001)).ok());
    return -body.reaction()[2];
  };
  const auto smooth = [&](double x) {
    return force(stiffness_factors(inside_shares(mesh, border(x), 0).share, ratio));
  };
  const auto jumping = [&](double x) {
    const std::vector<int> inside = inside_by_centroid(mesh, border(x));
    return force(stiffness_factors({inside.begin(), inside.end()}, ratio));
  };
  double rough_smooth = 0, rough_jumping = 0, mean = 0;
  std::vector<double> a, b;
  for (int k = 0; k <= 20; ++k) {
    a.push_back(smooth(0.024 + 0.0005 * k));
    b.push_back(jumping(0.024 + 0.0005 * k));
  }
  for (std::size_t k = 1; k < a.size(); ++k) {
    EXPECT_LT(a[k], a[k - 1]);  // less stiff material, less force
    mean += (a[k - 1] - a[k]) / 20;
    rough_smooth = std::max(rough_smooth, a[k - 1] - a[k]);
    rough_jumping = std::max(rough_jumping, b[k - 1] - b[k]);
  }
  std::printf("largest step over the mean one: shares %.2f, centroids %.2f\n", rough_smooth / mean,
              rough_jumping / mean);
  EXPECT_LT(rough_smooth, 2 * mean);
  EXPECT_GT(rough_jumping, 4 * mean);

  const double x = 0.0283, h = 1e-7;
  const InsideShares shares = inside_shares(mesh, border(x), 0);
  force(stiffness_factors(shares.share, ratio));
  const Eigen::MatrixXd d = by_inhomogeneity(body.linearise(true).by_scale, shares, ratio);
  const double by_x = -(d(2, 1) + d(2, 7));  // x of the first and of the last corner
  EXPECT_NEAR(by_x, (smooth(x + h) - smooth(x - h)) / (2 * h), 1e-6 * std::abs(by_x));
  const double by_ratio = (force(stiffness_factors(shares.share, ratio + 1e-4)) -
                           force(stiffness_factors(shares.share, ratio - 1e-4))) /
                          2e-4;
  EXPECT_NEAR(-d(2, 0), by_ratio, 1e-6 * by_ratio);
}

}  // namespace
}  // namespace hapsim
