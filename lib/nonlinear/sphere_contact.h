// A rigid spherical tip without friction on a linear body: the contact grows with the depth and
// never pulls.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "nonlinear/body_assembly.h"

namespace hapsim {

struct SpherePress {
  double force = 0;           // along the normal, on the tip [N]
  double stiffness = 0;       // d force / d depth [N/m]
  double by_radius = 0;       // d force / d tip radius [N/m]
  double contact_radius = 0;  // of the Hertzian pressure with the same second moment [m]; too large
                              // by about 0.18 (h/a)^2 for edges h at the contact's border
  bool fits = true;           // false: the contact reaches the rim of the prepared surface
  std::vector<Eigen::VectorXd> by_constants;  // by law: d force / d its constants
  Eigen::VectorXd field;                      // the body's displacements (3 nodes) [m]
};

// The surface about the contact carries pressures that are linear on its triangles (hats on corner
// nodes); the gap to the tip is closed in the mean over each hat, so gap >= 0, pressure >= 0 and
// their product is zero (Signorini's conditions; Wriggers, Computational Contact Mechanics, 2006,
// ch. 6 and 9), by an active set on the compliance of the hats, which one factorisation gives. The
// force obeys the body's own stiffness, layers and support included; Hertz (1882) and Sneddon (Int.
// J. Eng. Sci. 3, 1965) are its half-space limits. Small strain: contact radius and depth small
// against the body's features; the directions of all contact forces are the normal's.
class SphereContact {
 public:
  // `model`: laws of small strain. `held`: one a node, 1: displacement zero. Hats on the corner
  // nodes of boundary faces within `reach` of `point` [m] whose normal is within 60 degrees of
  // `normal` (outward, unit). Two to three edges of second order along the contact's radius
  // bring the force within 1 % of Hertz. Cost: one factorisation and one solution a hat.
  // Error(kBadInput): no face in reach, a law of finite strain; Error(kNoConvergence): nothing
  // holds the body.
  SphereContact(const BodyModel& model, const std::vector<std::uint8_t>& held, const Vec3& point,
                const Vec3& normal, double reach);
  ~SphereContact();

  int hats() const;
  // The tip of `radius` with its lowest point `depth` below `point` along the normal [m]; force
  // zero for depth <= 0. The tip's profile is the sphere's own, radius - sqrt(radius^2 - r^2).
  // Error(kNoConvergence) when the active set does not settle. Not const: the elements' state
  // serves it as scratch.
  SpherePress press(double radius, double depth);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hapsim
