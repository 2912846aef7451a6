// A law of what happens under the tool, in series with the rest of the body.
#pragma once

#include <Eigen/LU>
#include <algorithm>

#include "effects/effect.h"

namespace hapsim {

// Stiffness of a half-space against a rigid disc bonded to it, along its normal (Mossakowski, J.
// Appl. Math. Mech. 18, 1954; Spence, Proc. R. Soc. A 305, 1968: exact) and along its surface
// (Mindlin, J. Appl. Mech. 16, 1949: exact for nu = 1/2, within 2 % below) [N/m].
struct DiscStiffness {
  double normal = 0, tangential = 0;
  double normal_by_nu = 0, tangential_by_nu = 0;
};
DiscStiffness bonded_disc(double modulus, double nu, double radius);

// The force F(x) that moves the tool by x against the material under it [N], and its tangent.
struct LocalForce {
  Vec3 F = Vec3::Zero();
  Eigen::Matrix3d tangent = Eigen::Matrix3d::Zero();
};

// The tool's way u is that into the material under it, x, and what the body gives way far from it:
//   u = x + (K^-1 - C) F(x),
// K the body's stiffness against the flat bonded tool and C the compliance of the disc on a
// half-space, which the law replaces: with F = C^-1 x the force is K u. What the far field adds to
// a compliance does not depend on the contact's radius, to first order in that over the body's
// size.
class LocalContact {
 public:
  // `stiff`: a body that is stiffer than the half-space (a thin one, on its support) by more than a
  // tenth has a stiffer disc, so that laws that stiffen find an equilibrium there too.
  // `contact` outlives it; `normal` outward, the tool's radius [m].
  LocalContact(const ContactStiffness& contact, const Vec3& normal, double radius,
               bool stiff = false);

  // x for a tool at u and the force of the law there, a LocalForce law(x); `x` holds the start.
  // False: Newton's method fails, which no convex law lets it. Allocates and throws nothing.
  template <class Law>
  bool find(const Law& law, const Vec3& u, Vec3& x, LocalForce& force) const noexcept;
  // The same; Error(kNoConvergence) instead of false.
  template <class Law>
  LocalForce solve(const Law& law, const Vec3& u, Vec3& x) const {
    LocalForce force;
    if (!find(law, u, x, force)) no_equilibrium();
    return force;
  }

  // How many times as large, relative to the force, an error of K is in it: one for the linear law,
  // more where the law has become so stiff that what lies beyond the disc gives way most.
  double share_of_stiffness(const LocalForce& force) const noexcept {
    const double size = force.F.norm();
    if (size <= 0) return 1;
    const Eigen::Matrix3d& T = force.tangent;
    return (T * ((contact_.K + rest_ * T).inverse() * force.F)).norm() / size;
  }

  // Derivatives of the disc's stiffnesses by the columns: made once, used for every sample.
  struct DiscByColumns {
    Eigen::RowVectorXd normal, tangential;
  };
  DiscByColumns disc_by_columns(Eigen::Index columns) const;

  // Derivatives by the columns, given those of the motion (no columns: none) and those of F at
  // fixed x by all but the motion.
  struct Derivatives {
    Eigen::MatrixXd dx, dF;  // 3 x columns
  };
  Derivatives derivatives(const LocalForce& force, const Vec3& u, const Vec3& x,
                          const Eigen::MatrixXd& du, const Eigen::MatrixXd& explicit_dF,
                          const DiscByColumns& disc) const;

  const DiscStiffness& disc() const { return disc_; }
  // C F and, as 3 x columns, its derivative for a given one of F.
  Vec3 disc_way(const Vec3& F) const { return C_ * F; }
  Eigen::MatrixXd disc_way_derivative(const Vec3& F, const Eigen::MatrixXd& dF,
                                      const DiscByColumns& disc) const;

 private:
  [[noreturn]] static void no_equilibrium();
  // What C F loses for each N/m that the disc gains along the normal and across it.
  Eigen::Matrix<double, 3, 2> way_by_disc(const Vec3& F) const;
  Eigen::RowVectorXd by_columns(double of_half_space, double by_nu, Eigen::Index columns) const;

  const ContactStiffness& contact_;
  Vec3 normal_;
  DiscStiffness disc_;
  double gain_ = 1;                            // of the disc over that on a half-space
  Vec3 way_ = Vec3::Zero();                    // in which the body is stiffest, of unit energy
  Eigen::Matrix3d along_, across_, C_, rest_;  // projections; rest: 1 - K C
};

template <class Law>
bool LocalContact::find(const Law& law, const Vec3& u, Vec3& x, LocalForce& force) const noexcept {
  constexpr int kMost = 100;
  const Eigen::Matrix3d& K = contact_.K;
  const double scale = std::max(u.norm(), 1e-12);
  force = law(x);
  Vec3 residual = K * (x - u) + rest_ * force.F;
  for (int k = 0; k < kMost; ++k) {
    Vec3 step = -(K + rest_ * force.tangent).inverse() * residual;
    // Halved while the residual grows: laws have corners where the contact opens or closes.
    const double before = residual.norm();
    Vec3 next = x + step;
    force = law(next);
    residual = K * (next - u) + rest_ * force.F;
    for (int halvings = 0; residual.norm() > before && step.norm() > 1e-11 * scale && halvings < 30;
         ++halvings) {
      step /= 2;
      next = x + step;
      force = law(next);
      residual = K * (next - u) + rest_ * force.F;
    }
    x = next;
    if (step.norm() <= 1e-11 * scale) return true;
  }
  return false;
}

}  // namespace hapsim
