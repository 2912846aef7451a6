// How fast contact forces and surface displacements converge, on three meshes each.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "material/hooke_law.h"
#include "nonlinear/nonlinear_body.h"
#include "nonlinear/sphere_contact.h"
#include "solid/elastic_body.h"
#include "solid/surface_load.h"
#include "support/half_space.h"

namespace hapsim {
namespace {

constexpr double kFar = 200;  // half width and depth of a half-space's block, contact radius 1

struct Convergence {
  double value = 0;  // on the finest mesh
  double limit = 0;  // value + C h^order through all three (Richardson, 1911)
  double order = 0;
};

// From values on three meshes whose edges go as `h`.
Convergence richardson(const double (&h)[3], const double (&v)[3]) {
  const auto power = [&](int k, double p) { return std::pow(h[k], p); };
  const double ratio = (v[0] - v[1]) / (v[1] - v[2]);
  double low = 0.01, high = 12;
  while (high - low > 1e-6) {
    const double p = 0.5 * (low + high);
    ((power(0, p) - power(1, p)) / (power(1, p) - power(2, p)) < ratio ? low : high) = p;
  }
  const double share = power(2, low) / (power(1, low) - power(2, low));
  return {v[2], v[2] - share * (v[1] - v[2]), low};
}

void judge(const char* what, double nu, const Convergence& r, double known, double tolerance) {
  std::printf("%s, nu %.2f: %.4f of the known on the finest mesh, limit %.4f, rate %.1f\n", what,
              nu, r.value / known, r.limit / known, r.order);
  EXPECT_NEAR(r.limit / known, 1, tolerance);
  EXPECT_GT(r.order, 1);
}

BodyModel body_of(const TetMesh& mesh, double nu) {
  BodyModel model{&mesh, {isotropic_law(1, nu)}};
  model.dilatation = Dilatation::kElement;
  return model;
}

// Forces of spheres without friction on meshes of edges `rim` at the contact's border, against a
// mesh far finer: rms over depths, for each mesh its contacts end between nodes in other ways.
void judge_sphere(const char* what, double depth_of_body, double nu, double R,
                  const std::vector<double>& depths, const std::vector<double>& known,
                  double tolerance) {
  constexpr double kRims[] = {1.0 / 3, 1.0 / 4, 1.0 / 5.5, 1.0 / 9};
  std::vector<Eigen::VectorXd> forces;
  for (const double rim : kRims) {
    const TetMesh mesh = test::half_space(rim, kFar, depth_of_body).mesh;
    SphereContact sphere(body_of(mesh, nu), mesh.fixed, Vec3::Zero(), Vec3::UnitZ(), 1.5);
    forces.emplace_back(depths.size());
    for (std::size_t k = 0; k < depths.size(); ++k)
      forces.back()[static_cast<Eigen::Index>(k)] = sphere.press(R, depths[k]).force / known[k];
  }
  double error[3];
  for (int k = 0; k < 3; ++k)
    error[k] = (forces[k] - forces[3]).norm() / std::sqrt(static_cast<double>(depths.size()));
  const double rate = std::log(error[0] / error[2]) / std::log(kRims[0] / kRims[2]);
  std::printf("%s, nu %.2f: %.4f of the known; error %.2f, %.2f, %.2f %%, rate %.1f\n", what, nu,
              forces[3].mean(), 100 * error[0], 100 * error[1], 100 * error[2], rate);
  EXPECT_NEAR(forces[3].mean(), 1, tolerance);
  EXPECT_GT(rate, 1);
}

double hertz(double nu, double R, double depth) {
  return 4.0 / 3 / (1 - nu * nu) * std::sqrt(R) * std::pow(depth, 1.5);
}

// Contact radii from 0.7 to 1.
const std::vector<double> kContactRadii{0.7, 0.75, 0.8, 0.85, 0.9, 0.95, 1};

// Hertz, 1882 (Johnson, Contact Mechanics, 4.22).
TEST(Convergence, OfASphere) {
  const double nu = 0.3, R = 20;
  std::vector<double> depths, known;
  for (const double a : kContactRadii) {
    depths.push_back(a * a / R);
    known.push_back(hertz(nu, R, depths.back()));
  }
  judge_sphere("Hertz", kFar, nu, R, depths, known, 0.01);
}

// Sneddon, Int. J. Eng. Sci. 3, 1965.
TEST(Convergence, OfADeepSphere) {
  const double nu = 0.4, R = 1 / 0.6;
  std::vector<double> depths, known;
  for (const double a : kContactRadii) {
    const double log_ratio = std::log((R + a) / (R - a));
    depths.push_back(a / 2 * log_ratio);
    known.push_back(((a * a + R * R) / 2 * log_ratio - a * R) / (1 - nu * nu));
  }
  judge_sphere("Sneddon", kFar, nu, R, depths, known, 0.01);
}

// Dimitriadis et al., Biophys. J. 82, 2002, eq. 12, whose own rest is some chi^5.
TEST(Convergence, OfASphereOnALayer) {
  const double nu = 0.45, R = 20, thickness = 1 / 0.3;
  const double a = -(1.2876 - 1.4678 * nu + 1.3442 * nu * nu) / (1 - nu);
  const double b = (0.6387 - 1.0277 * nu + 1.5164 * nu * nu) / (1 - nu);
  std::vector<double> depths, known;
  for (const double radius : kContactRadii) {
    const double t = 2 / M_PI * radius / thickness;
    depths.push_back(radius * radius / R);
    known.push_back(hertz(nu, R, depths.back()) *
                    (1 - a * t + a * a * t * t -
                     (std::pow(a, 3) + 4 * M_PI * M_PI / 15 * b) * t * t * t +
                     a * (std::pow(a, 3) + 3 * M_PI * M_PI / 5 * b) * std::pow(t, 4)));
  }
  judge_sphere("Dimitriadis", thickness, nu, R, depths, known, 0.03);
}

// A uniform pressure p on a square of side 2 b: mean displacement of the square
// (8 / pi) (log(1 + sqrt 2) - (sqrt 2 - 1) / 3) p b (1 - nu^2) / E, from Boussinesq, 1885 (Love,
// Phil. Trans. A 228, 1929). What the finite block takes away is about b / kFar of it.
TEST(Convergence, OfALoadedSquare) {
  constexpr double kFinest = 0.25;  // of the map
  const auto graded = [](double s) { return kFinest * std::sinh(std::asinh(kFar / kFinest) * s); };
  const double nu = 0.3, b = graded(0.5);
  const auto mean = [&](int cells) {
    TetMesh mesh = test::block_mesh({2, 2, 1}, cells, cells, cells / 2, 1);
    for (Vec3& p : mesh.nodes) p = {graded(p.x() - 1), graded(p.y() - 1), -graded(1 - p.z())};
    mesh = to_second_order(mesh);
    std::vector<Triangle> loaded;
    for (const Triangle& f : mesh.faces) {
      bool inside = true;
      for (const int n : f)
        inside = inside && mesh.nodes[n].z() > -1e-9 &&
                 mesh.nodes[n].head<2>().cwiseAbs().maxCoeff() < 1.001 * b;
      if (inside) loaded.push_back(f);
    }
    std::vector<int> handle(mesh.nodes.size(), kFreeNode);
    for (std::size_t i = 0; i < handle.size(); ++i)
      if (mesh.fixed[i]) handle[i] = kHeldNode;
    NonlinearBody body(body_of(mesh, nu), handle);
    const Eigen::VectorXd load = pressure_load(mesh, loaded, 1);
    body.set_load(load);
    EXPECT_TRUE(body.solve(Eigen::VectorXd()).ok());
    return load.dot(body.field()) / (4 * b * b);
  };
  const double known =
      8 / M_PI * (std::log(1 + std::sqrt(2)) - (std::sqrt(2) - 1) / 3) * b * (1 - nu * nu);
  judge("loaded square", nu,
        richardson({1.0 / 8, 1.0 / 12, 1.0 / 16}, {mean(8), mean(12), mean(16)}), known, 0.04);
}

}  // namespace
}  // namespace hapsim
