// Elements that do not lock: forces and displacements as Poisson's ratio tends to one half.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "material/hooke_law.h"
#include "nonlinear/nonlinear_body.h"
#include "solid/elastic_body.h"
#include "solid/surface_load.h"
#include "support/block_mesh.h"

namespace hapsim {
namespace {

struct Formulation {
  const char* name;
  int order;
  Dilatation dilatation;
};
constexpr Formulation kPlain1{"P1", 1, Dilatation::kPointwise};
constexpr Formulation kPatch1{"P1 patches", 1, Dilatation::kPatch};
constexpr Formulation kPlain2{"P2", 2, Dilatation::kPointwise};
constexpr Formulation kMean2{"P2-P0", 2, Dilatation::kElement};
constexpr double kRatios[] = {0.3, 0.45, 0.49, 0.499};

// Force that presses the top of a bonded block of 2 x 2 x 1 down by a hundredth, E = 1.
double pressed_block(const Formulation& f, int n, double nu) {
  const TetMesh mesh = test::block_mesh({2, 2, 1}, 2 * n, 2 * n, n, f.order);
  std::vector<int> handle(mesh.nodes.size(), kFreeNode);
  for (std::size_t i = 0; i < handle.size(); ++i) {
    if (mesh.fixed[i]) handle[i] = kHeldNode;
    if (mesh.nodes[i].z() > 1 - 1e-9) handle[i] = 0;
  }
  BodyModel model{&mesh, {isotropic_law(1, nu)}};
  model.dilatation = f.dilatation;
  NonlinearBody body(model, handle);
  EXPECT_TRUE(body.solve(Vec3(0, 0, -0.01)).ok());
  return -body.reaction()[2];
}

// Shear force that moves the end of a cantilever of 1 x 1 x 6 by one, E = 1.
double cantilever(const Formulation& f, int n, double nu) {
  const TetMesh mesh = test::block_mesh({1, 1, 6}, n, n, 6 * n, f.order);
  std::vector<int> handle(mesh.nodes.size(), kFreeNode);
  for (std::size_t i = 0; i < handle.size(); ++i) {
    if (mesh.fixed[i]) handle[i] = kHeldNode;
    if (mesh.nodes[i].z() > 6 - 1e-9) handle[i] = 0;
  }
  BodyModel model{&mesh, {isotropic_law(1, nu)}};
  model.dilatation = f.dilatation;
  NonlinearBody body(model, handle);
  EXPECT_TRUE(body.solve(Vec3(1, 0, 0)).ok());
  return body.reaction()[0];
}

// Against second-order elements with mean dilatation extrapolated from two meshes (they converge
// with h^2 here). An element that does not lock errs as much near nu 0.5 as at 0.3, where its error
// is that of bending and rims; `growth` bounds the change.
template <class Case>
void compare(const char* title, const Case& value, int fine, double growth1, double growth2) {
  constexpr int kCells1 = 4, kCells2 = 2;  // the same nodes
  double first_patch = 0, first_mean = 0;
  for (const double nu : kRatios) {
    const double h1 = value(kMean2, fine, nu), h2 = value(kMean2, fine / 2, nu);
    const double reference = h1 + (h1 - h2) / 3;
    const auto error = [&](const Formulation& f, int n) { return value(f, n, nu) / reference - 1; };
    const double p1 = error(kPlain1, kCells1), patch = error(kPatch1, kCells1);
    const double p2 = error(kPlain2, kCells2), mean = error(kMean2, kCells2);
    std::printf("%s nu %.3f: P1 %+6.1f %%, patches %+5.1f %%; P2 %+6.2f %%, P2-P0 %+5.2f %%\n",
                title, nu, 100 * p1, 100 * patch, 100 * p2, 100 * mean);
    if (nu == kRatios[0]) first_patch = patch, first_mean = mean;
    EXPECT_LT(std::abs(mean), 0.05);
    EXPECT_LT(std::abs(mean - first_mean), growth2);
    EXPECT_LT(std::abs(patch - first_patch), growth1);
    if (nu < 0.48) continue;
    EXPECT_LT(std::abs(mean), 0.3 * std::abs(p2)) << "little is gained over P2";
    EXPECT_LT(std::abs(patch), 0.3 * std::abs(p1)) << "little is gained over P1";
  }
}

TEST(Locking, PressedBlock) {
  compare("pressed block", pressed_block, 6, 0.12, 0.03);
}

TEST(Locking, Cantilever) {
  compare("cantilever", cantilever, 4, 0.05, 0.01);
}

// Lame's thick sphere, radii 1 and 2, pressure 1 inside (Timoshenko and Goodier, Theory of
// Elasticity, art. 136): u(r) = p a^3 r / (E (b^3 - a^3)) (1 - 2 nu + (1 + nu) b^3 / (2 r^3)).
// One twenty-fourth of it between four planes of symmetry on which it slides (very stiff springs).
double sphere_error(const Formulation& f, int n, double nu) {
  TetMesh mesh = test::block_mesh({1, 1, 1}, n, n, n, 1);
  std::vector<Vec3> parameter = mesh.nodes;
  for (Vec3& p : mesh.nodes) p = (1 + p.z()) * Vec3(p.x(), p.y(), 1).normalized();
  std::vector<Triangle> inner;
  for (const Triangle& t : mesh.faces)
    if (parameter[t[0]].z() + parameter[t[1]].z() + parameter[t[2]].z() < 1e-9) inner.push_back(t);
  if (f.order == 2) mesh = to_second_order(mesh);
  const double a3 = 1, b3 = 8;
  BodyModel model{&mesh, {isotropic_law(1, nu)}};
  model.dilatation = f.dilatation;
  const Vec3 planes[4] = {
      {1, 0, 0}, {0, 1, 0}, Vec3(1, 0, -1).normalized(), Vec3(0, 1, -1).normalized()};
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
    for (const Vec3& n_plane : planes)
      if (std::abs(mesh.nodes[i].dot(n_plane)) < 1e-9)
        model.springs.push_back({static_cast<int>(i), 1e4 * n_plane * n_plane.transpose()});
  NonlinearBody body(model, std::vector<int>(mesh.nodes.size(), kFreeNode));
  body.set_load(pressure_load(mesh, inner, 1));
  EXPECT_TRUE(body.solve(Eigen::VectorXd()).ok());
  // Mean radial displacement of the inner surface's nodes.
  double mean = 0;
  int count = 0;
  for (std::size_t i = 0; i < parameter.size(); ++i) {
    if (parameter[i].z() > 1e-9) continue;
    mean += body.field().segment<3>(3 * static_cast<Eigen::Index>(i)).dot(mesh.nodes[i]);
    ++count;
  }
  const double exact = a3 / (b3 - a3) * (1 - 2 * nu + (1 + nu) * b3 / 2);
  return mean / count / exact - 1;
}

TEST(Locking, ThickSphere) {
  for (const double nu : kRatios) {
    const double p1 = sphere_error(kPlain1, 8, nu), patch = sphere_error(kPatch1, 8, nu);
    const double p2 = sphere_error(kPlain2, 4, nu), p20 = sphere_error(kMean2, 4, nu);
    const double finer = sphere_error(kMean2, 8, nu), rate = std::log2(std::abs(p20 / finer));
    std::printf(
        "thick sphere nu %.3f: P1 %+6.2f %%, patches %+5.2f %%; P2 %+5.2f %%, P2-P0 %+5.2f %%, "
        "twice "
        "as fine %+5.2f %%, rate %.2f\n",
        nu, 100 * p1, 100 * patch, 100 * p2, 100 * p20, 100 * finer, rate);
    EXPECT_LT(std::abs(p20), 0.02);
    EXPECT_LT(std::abs(patch), 0.03);
    EXPECT_GT(rate, 1.6);  // flat facets for the sphere: h^2
  }
}

}  // namespace
}  // namespace hapsim
