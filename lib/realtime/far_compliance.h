// What a body yields beyond a half-space where it is pressed: as a whole, not about the tool.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "contact/contact_stiffness.h"

namespace hapsim {

// A tool on a limb bends it, one on a thin part meets the support below: the compliance of a place
// is the half-space's under the tool plus what the body is beyond a half-space. The latter is the
// compliance between two surface points less the half-space's between them (half_space_surface.h),
// which is smooth where the body is, and is known from one mesh of the whole body, coarse against
// the tool, whose surface corners are condensed once. Features of the material are not in it.
class FarCompliance {
 public:
  // Cost: one factorisation and a dense inverse of some kCorners corners, 2 to 5 s of a processor.
  // Error(kBadInput): the coarse surface cannot be meshed. Error(kNoConvergence): body not held.
  FarCompliance(const ContactBase& base, double tool_radius, const Material& material, int threads);

  // The mean over pairs of corners about a place where the surface has this normal (outward, unit),
  // symmetric [m/N]; zero where no corner faces the same way. Thread-safe.
  Eigen::Matrix3d at(const Vec3& point, const Vec3& normal) const;

 private:
  static constexpr double kCorners = 900;
  double reach_ = 0;  // [m]
  std::vector<Vec3> corners_, normals_;
  std::vector<double> areas_;  // of the surface about each corner [m^2]
  Eigen::MatrixXd beyond_;     // 3 corners x 3 corners [m/N]; no corner by itself
};

}  // namespace hapsim
