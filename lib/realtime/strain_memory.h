// What a body of finite strain bears at one displacement of its tool by the stresses of another:
// how one that relaxes remembers.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "base/vec3.h"
#include "nonlinear/stress_response.h"
#include "realtime/inside_memory.h"
#include "realtime/memory_monomials.h"

namespace hapsim {

using MemoryMatrix = Eigen::Matrix<double, kMemoryTerms, kMemoryTerms>;

// W(u; v) = m(u)' C m(v) is the work, over k a^2, that the stresses S of the static body at v do
// along its strains at u: integral of S(v) : E(u). What a tool at u needs to hold a body that bears
// those stresses is dW/du, to first order in the departure from the static body's inside, which is
// in equilibrium; what that departure adds is of `inside`. The stresses of a generalised Maxwell
// body at finite strain are (ToolBody) sums of hereditary integrals of S over its past, so its
// force is m'(u)' C h with the same integrals h of m over the tool's past.
struct StrainMemory {
  MemoryMatrix C = MemoryMatrix::Zero();
  InsideMemory inside;
};

// As in axes that are turned about the first: with v -> R v, R = 1 along d and orthogonal across
// it. Allocates and throws nothing.
void add_turned(const StrainMemory& of, const Eigen::Matrix3d& R, double weight,
                StrainMemory& sum) noexcept;

// What the solved states of one place say of it: sums over their numbers, of which a part at a time
// need be there.
class StressStates {
 public:
  // Of states v, as far aside as strain_side() has it. The body's directions are taken to those of
  // v by `frame` (rows); `radius`, the tool's, is the unit of v [m]; `unit` the work that W is over
  // [J].
  StressStates(const Eigen::Matrix3d& frame, double radius, double unit, std::vector<Vec3> v,
               double aside);
  // Adds what `of` says of each state, the same numbers of all: in the end all parts. With the
  // fields of InsideMemory, in its order, or none. Memory: 4 bytes times 8 numbers, with the fields
  // 26, a state and number of the part.
  void add(const std::function<StressResponse(std::size_t state)>& of);
  // The force at each state (3 rows) by the stresses of each (4 columns: these, and their
  // derivatives by v), over unit / radius.
  const Eigen::MatrixXd& forces() const { return forces_; }
  // W by integration, of strains at row's state and stresses at the column's.
  const Eigen::MatrixXd& works() const { return works_; }
  // Least squares over all pairs of states; `error`: of the forces, over each (floor 5 % of
  // the largest below), rms.
  StrainMemory fit(double& error) const;

 private:
  void fit_inside(const Eigen::VectorXd& weights, InsideMemory& inside) const;

  Eigen::Matrix3d frame_;
  double radius_, unit_, aside_;
  std::vector<Vec3> v_;
  Eigen::MatrixXd forces_, works_;
  // On the fields at a state (rows, fields each) by the stresses of each, and by the fields'
  // stresses there on the strains of each.
  Eigen::MatrixXd inside_works_, inside_done_;
  std::vector<Eigen::Matrix<double, kInsideFields, kInsideFields>> stiffness_, stressed_;
};

// Of states v: weights by which their stresses sum to those of InsideMemory's fields, s_b and s_bc
// of least squares relative to v: states x fields.
Eigen::MatrixXd inside_weights(const std::vector<Vec3>& v);

}  // namespace hapsim
