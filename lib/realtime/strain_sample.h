// The force of a body of finite strain at one place, as the gradient of an energy of few numbers.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <optional>
#include <string>

#include "contact/contact_stiffness.h"
#include "model/model.h"
#include "realtime/strain_memory.h"

namespace hapsim {

// Monomials d^i p^j q^k of the ways over the tool's radius, d into the surface, p and q along it,
// of degree 3 and more, so that small displacements are left to the linear stiffness: i to 6 where
// j + k = 0, to 4, 4, 2 and 1 where j + k = 1 to 4. No symmetry is taken for granted.
constexpr int kStrainTerms = 44;
using StrainCoefficients = Eigen::Matrix<double, kStrainTerms, 1>;

// P(v) = sum of c m(v): its gradient and Hessian at v = (d, p, q). Allocate and throw nothing.
Vec3 strain_gradient(const StrainCoefficients& c, const Vec3& v) noexcept;
Eigen::Matrix3d strain_hessian(const StrainCoefficients& c, const Vec3& v) noexcept;
// 3 x terms: the gradients of the monomials.
Eigen::Matrix<double, 3, kStrainTerms> strain_gradients(const Vec3& v) noexcept;

// How far along the surface a place is sampled, and holds, at a depth: both in tool radii, `aside`
// of the sample. A flat tool that is pushed sideways before it is pressed wrinkles the surface
// ahead of it.
inline double strain_side(double depth, double aside) noexcept {
  return aside * std::min(1.0, 0.25 + 0.5 * std::max(depth, 0.0));
}

// Depths at which elements are compared with finer ones: even shares of `into`.
constexpr int kStrainDepths = 6;
using StrainMeshError = std::array<double, kStrainDepths>;

struct StrainSample {
  Vec3 point = Vec3::Zero();                    // on the surface [m]
  Eigen::Matrix3d frame;                        // rows: into the surface, two ways along it
  Eigen::Matrix3d K = Eigen::Matrix3d::Zero();  // of the mesh, at no displacement [N/m]
  double into = 0;                              // depth up to which it was solved, in tool radii
  double aside = 1;                             // strain_side()
  double fit = 0;                               // relative error of the forces solved, rms
  std::optional<StrainMeshError> finer;         // strain_mesh.h, where it was asked for
  StrainCoefficients
      c;  // force that moves the tool: K u + k a P'(frame u / a), k = frame0.K frame0
  // What bodies that relax have beside (strain_memory.h), C over the same k a^2 less the linear
  // stiffness (which leaves what springs of the support bear, as these do not relax), and the
  // relative error of its forces; nothing where it was not asked for.
  std::optional<StrainMemory> memory;
  double memory_fit = 0;

  std::string bytes() const;
  static std::optional<StrainSample> read(const std::string& bytes);  // nothing: damaged
};

// Solves the body at a place (FullPress) along thirteen ways from no displacement to `into` tool
// radii, straight down and to both sides of strain_side(), and fits the energy to the forces:
// relative to each force, a floor of 5 % of the largest below. Elements of half a radius at the
// rim with straight edges: forces over the linear stiffness of the same mesh are then within 1 % of
// those of edges a third as long as far as these converge (one place of a block, s = 0.2), while
// with quarter points (FullOptions) they are 4 to 7 % off. A way that does not converge ends there,
// and the sample with the shortest. `model`: body and support effects alone, static. Nothing, and
// `why`, where the model or the place is refused, the undeformed body is not stable there, or
// nothing converges. `memory`: with what stresses of one state do at another, which takes some
// three times as long, and again as long for a narrower way: where the surface folds beside the
// tool, no polynomial tells that (of a Neo-Hookean block at 30 % of its thickness the fit of the
// memory is 29 % off with all of strain_side(), 1 % with 0.3 of it), and the sample is taken less
// far aside.
std::optional<StrainSample> solve_strain_sample(const TetMesh& body, const ContactBase& base,
                                                const Model& model, const Vec3& point,
                                                double tool_radius, double into, bool memory,
                                                std::string& why);

}  // namespace hapsim
