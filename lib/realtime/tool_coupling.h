// How the surface of a body moves under one tool when another presses.
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "contact/rigid_stiffness.h"
#include "mesh/signed_distance.h"
#include "model/model.h"

namespace hapsim {

// Motion and turn of one flat tool's patch, free of load, by a force and moment on another's (6 x
// 6). A half-space's (half_space_surface.h), taken over rings that stand for the discs' tractions
// (1/sqrt(a^2 - r^2) for forces, r/sqrt(a^2 - r^2) for moments, exact to the third power of radius
// over distance), plus what the body is beyond a half-space: on its own mesh, of second order where
// it is small, the compliances of all pairs of surface corners less the half-space's between the
// same points, which is smooth and interpolated in both places.
class ToolCoupling {
 public:
  // `body`: its corners; made ready by one factorisation and condensation. Zones of the model are
  // in it. Error(kBadInput): the body has moved or stands on a support of
  // its own, which its mesh does not show; a body without a closed surface. Error(kNoConvergence):
  // not held.
  ToolCoupling(const TetMesh& body, const Model& model, double tool_radius, int threads = 1);

  // A tool's patch as pairs of it are asked for.
  struct Patch {
    Vec3 point = Vec3::Zero(), normal = Vec3::UnitZ();
    double modulus = 1;         // that a contact feels there [Pa]
    std::array<int, 3> vertex;  // corners about it, with the patch's motion by each corner's
    std::array<Eigen::Matrix<double, 6, 3>, 3> of_corner;
    std::array<Eigen::Matrix<double, 6, 3>, 8> of_ring;
    std::array<Vec3, 8> ring;
  };
  // `normal` outward, unit; `modulus` that a contact feels there [Pa]. Allocates and throws
  // nothing.
  Patch patch(const Vec3& point, const Vec3& normal, double modulus) const noexcept;
  // Of `a` by what acts on `b` [m/N, 1/N, 1/(N m)]. Allocates and throws nothing; some
  // microseconds.
  Matrix6 between(const Patch& a, const Patch& b) const noexcept;

  double tool_radius() const { return radius_; }
  std::size_t corners() const { return corner_modulus_.size(); }
  bool second_order() const { return second_order_; }

 private:
  Eigen::Matrix3d beyond_half_space(int i, int j) const noexcept {
    return beyond_.block<3, 3>(3 * static_cast<Eigen::Index>(i), 3 * static_cast<Eigen::Index>(j));
  }

  double nu_ = 0, radius_ = 0;
  bool apart_ = false;  // a contact feels its own modulus, as if the whole body had it
  bool second_order_ = false;
  std::unique_ptr<SignedDistance> surface_;  // the mesh's own boundary
  std::vector<double> corner_modulus_;       // of the condensed body there [Pa]
  Eigen::MatrixXd beyond_;                   // 3 corners x 3 corners [m/N]
};

}  // namespace hapsim
