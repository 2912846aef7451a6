// What a body of finite strain bears at one displacement of its tool by the stresses of another:
// how one that relaxes remembers.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/vec3.h"
#include "nonlinear/stress_response.h"

namespace hapsim {

// Monomials of the ways v = (d, p, q) over the tool's radius: d, p, q first, then all others of
// degree 2 and more that d^i p^j q^k has with i to 6 where j + k = 0, to 4, 4, 2 and 1 where it is
// 1 to 4.
constexpr int kMemoryTerms = 53;
using MemoryVector = Eigen::Matrix<double, kMemoryTerms, 1>;
using MemoryMatrix = Eigen::Matrix<double, kMemoryTerms, kMemoryTerms>;

// Their values and gradients at v, or along the tangent from there at v + rest. Allocates and
// throws nothing.
struct MemoryPoint {
  MemoryVector m;
  Eigen::Matrix<double, 3, kMemoryTerms> gradient;
};
MemoryPoint memory_point(const Vec3& v, const Vec3& rest = Vec3::Zero()) noexcept;

// W(u; v) = m(u)' C m(v) is the work, over k a^2, that the stresses S of the static body at v do
// along its strains at u: integral of S(v) : E(u). What a tool at u needs to hold a body that bears
// those stresses is dW/du, to first order in the departure from the static body's inside, which is
// in equilibrium. The stresses of a generalised Maxwell body at finite strain are (ToolBody) sums
// of hereditary integrals of S over its past, so its force is m'(u)' C h with the same integrals h
// of m over the tool's past.
//
// Where what is remembered is not a multiple of what is now, the inside departs from the static
// body's, by y = -K^-1 r of the residual forces r, and the force changes by the geometric stiffness
// of those stresses with it. Of stresses s(v) = sum of s_b v_b, straight in v by least squares,
// that is sum of Q_abc(u) x_b x_c, Q a polynomial in the kSecondTerms monomials of degree 3 and
// less, x the linear memories less what they would be of the present v.
constexpr int kSecondTerms = 20;
using SecondMatrix = Eigen::Matrix<double, 27, kSecondTerms>;  // rows: 9 b + 3 c + a
struct StrainMemory {
  MemoryMatrix C = MemoryMatrix::Zero();
  SecondMatrix Q = SecondMatrix::Zero();
};
// Of the second order alone, over k a; in axes of v. Twice what elements do at most (the stresses
// stiffen the inside against y) and not zero where all is a multiple of what is now: a measure of
// what the first order leaves, not a correction.
Vec3 second_force(const SecondMatrix& Q, const MemoryPoint& at, const Vec3& x) noexcept;

// As in axes that are turned about the first: with v -> R v, R = 1 along d and orthogonal across
// it. Allocates and throws nothing.
void add_turned(const StrainMemory& of, const Eigen::Matrix3d& R, double weight,
                StrainMemory& sum) noexcept;

// What the solved states of one place say of it.
class StressStates {
 public:
  // The body's directions are taken to those of v by `frame` (rows); `radius`, the tool's, is the
  // unit of v [m]; `unit` the work that W is over [J].
  StressStates(const Eigen::Matrix3d& frame, double radius, double unit)
      : frame_(frame), radius_(radius), unit_(unit) {}
  // With couplings of three modes by v where C's second order is asked for.
  void add(const Vec3& v, const StressResponse& response);
  // The force at each state (3 rows) by the stresses of each (4 columns: these, and their
  // derivatives by v), over unit / radius.
  Eigen::MatrixXd forces() const;
  // W by integration, of strains at row's state and stresses at the column's.
  Eigen::MatrixXd works() const;
  // Least squares over all pairs of states; `error`: of the forces, over each (floor 5 % of
  // the largest below), rms.
  StrainMemory fit(double& error) const;

 private:
  Eigen::Matrix3d frame_;
  double radius_, unit_;
  std::vector<Vec3> v_;
  std::vector<Eigen::MatrixXf> stress_, work_;  // n x 4 and n x 3
  std::vector<Eigen::VectorXf> strain_;
  std::vector<Eigen::Matrix<double, 27, 1>> coupling_;
};

// Stresses s_b of least squares, s(v) = sum of s_b v_b: n x 3.
Eigen::MatrixXd stress_modes(const std::vector<Vec3>& v, const std::vector<Eigen::VectorXd>& s);

}  // namespace hapsim
