// What a material law gives at one point: energy, stress, tangent, and their derivatives by its
// constants.
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "base/vec3.h"

namespace hapsim {

// Symmetric tensors as 11, 22, 33, 12, 23, 13; of strains, the last three are doubled (engineering
// shear), so stress . strain is the work.
using Voigt = Eigen::Matrix<double, 6, 1>;
using VoigtMatrix = Eigen::Matrix<double, 6, 6>;
inline constexpr int kVoigtPairs[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}};
Voigt to_voigt(const Eigen::Matrix3d& symmetric);  // off-diagonals once
// Of a symmetric A: (A o A)_ijkl = (A_ik A_jl + A_il A_jk) / 2, minus the derivative of an inverse.
VoigtMatrix symmetric_product(const Eigen::Matrix3d& a);
// Turns stresses as Voigt vectors from the frame with columns R to the body's; stiffnesses turn as
// T D T'.
VoigtMatrix stress_rotation(const Eigen::Matrix3d& R);

// Energy w per reference volume [J/m^3], second Piola-Kirchhoff stress S = dw/dE [Pa] and tangent
// D = dS/dE [Pa], E = (C - 1)/2 the Green-Lagrange strain.
struct PointResponse {
  double energy = 0;
  Voigt S = Voigt::Zero();
  VoigtMatrix D = VoigtMatrix::Zero();
};

// U(theta), U', U'' [Pa].
struct VolumeResponse {
  double energy = 0, first = 0, second = 0;
};

struct LawConstant {
  std::string name, unit, meaning;
  double value = 0;
};

// The energy of a material per reference volume is w(C) + U(theta): theta is the ratio of the
// volumes, by itself (J = sqrt(det C)) or averaged over a few elements (dilatation.h). C is the
// right Cauchy-Green tensor, which no rotation of space changes. A law of small strain takes
// C = 1 + 2 eps and theta = 1 + tr eps instead, and its S is the engineering stress.
class MaterialLaw {
 public:
  explicit MaterialLaw(std::vector<LawConstant> constants) : constants_(std::move(constants)) {}
  virtual ~MaterialLaw() = default;
  virtual bool small_strain() const { return false; }
  // `tangent` false leaves D unset. Not finite where the law overflows: the caller shortens its
  // step.
  virtual PointResponse respond(const Eigen::Matrix3d& C, bool tangent) const = 0;
  virtual VolumeResponse volume(double theta) const = 0;
  // dS/dc and dU'/dc by each constant, in the order of constants().
  virtual std::vector<Voigt> stress_by_constants(const Eigen::Matrix3d& C) const = 0;
  virtual std::vector<double> pressure_by_constants(double theta) const = 0;

  const std::vector<LawConstant>& constants() const { return constants_; }

 protected:
  double constant(int k) const { return constants_[static_cast<std::size_t>(k)].value; }

 private:
  std::vector<LawConstant> constants_;
};

using LawPointer = std::shared_ptr<const MaterialLaw>;

// Stress in uniform deformations, for closed forms and fits: first Piola-Kirchhoff stress P = F S
// [Pa] with theta = det F (1 + tr(F - 1) at small strain).
Eigen::Matrix3d nominal_stress(const MaterialLaw& law, const Eigen::Matrix3d& F);

}  // namespace hapsim
