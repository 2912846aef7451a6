// A rigid spherical tip against a surface that deforms: how far they are apart, how far they have
// slipped, and the directions in which tractions act.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cmath>
#include <limits>

#include "nonlinear/tip_surface.h"

namespace hapsim {

constexpr double kSticks = std::numeric_limits<double>::infinity();

// A radius that is infinite makes a flat punch, which fits the undeformed surface within reach.
struct SphericalTip {
  Vec3 point = Vec3::Zero();    // where its lowest point lies when it has not moved [m]
  Vec3 normal = Vec3::UnitZ();  // outward, of the surface there
  double radius = 0;            // [m]
  double reach = 0;             // faces within it may come into contact [m]
  double friction = 0;          // Coulomb's coefficient; kSticks: what touches sticks
  bool flat() const { return !std::isfinite(radius); }
};

// In the mean over each hat (mortar; Wriggers, Computational Contact Mechanics, 2006, ch. 9):
//   w_n = integral of hat gap,   w_t = integral of hat t.(change of u - change of the tip's place),
// the change since mark(). The tip does not turn. `small`: directions and profile of the undeformed
// surface, so all is linear in u: for depths and slips small against the contact radius. Else the
// gap is the distance from the sphere where the surface is now, per undeformed area.
class TipContact {
 public:
  TipContact(const TetMesh& mesh, const SphericalTip& tip, bool small);

  // At displacements u (3 nodes) with the tip moved by `motion` [m].
  void evaluate(const Eigen::VectorXd& u, const Vec3& motion);
  // Slip counts from here.
  void mark(const Eigen::VectorXd& u, const Vec3& motion);

  int hats() const { return static_cast<int>(surface_.area.size()); }
  const TipSurface& surface() const { return surface_; }
  const SphericalTip& tip() const { return tip_; }
  // 3 hats: normal and two tangential parts of each [m^3].
  const Eigen::VectorXd& apart() const { return apart_; }
  // Nodal forces (3 nodes) of unit tractions; its transpose gives the change of apart() by u.
  const Eigen::SparseMatrix<double>& directions() const { return directions_; }
  // The tip's force on the body [N].
  Vec3 force(const Eigen::VectorXd& traction) const;
  // Of the Hertzian pressure with the same second moment [m]; 0 without contact.
  double contact_radius(const Eigen::VectorXd& traction) const;
  // How far the surface gives way at most [m]: what a gap is judged by.
  double give() const { return give_; }
  // True when the contact reaches the rim of the surface.
  bool at_rim(const Eigen::VectorXd& traction) const;

 private:
  Vec3 displacement(const TipSurface::Point& p, const Eigen::VectorXd& u) const;

  SphericalTip tip_;
  bool small_;
  TipSurface surface_;
  Eigen::Index unknowns_;
  Vec3 axis_[2];           // tangents at the tip's point
  Eigen::VectorXd start_;  // u at mark()
  Vec3 start_motion_ = Vec3::Zero();
  Eigen::VectorXd apart_;
  double give_ = 0;
  Eigen::SparseMatrix<double> directions_;
};

}  // namespace hapsim
