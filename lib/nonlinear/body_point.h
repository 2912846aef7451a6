// The kinematics of a quadrature point, shared by the passes of BodyAssembly.
#pragma once

#include <Eigen/Dense>

#include "nonlinear/body_assembly.h"

namespace hapsim {

struct BodyAssembly::Point {
  double weight;
  Eigen::Matrix3d F, C;      // small strain: C = 1 + 2 eps, F = 1
  double theta;              // J or 1 + tr eps
  Eigen::Matrix3d cofactor;  // dtheta/dF; small strain: 1
  bool small;
};

template <int N>
Eigen::Matrix<double, 3, N> BodyAssembly::gather(const Eigen::VectorXd& field,
                                                 std::size_t tet) const {
  Eigen::Matrix<double, 3, N> u;
  for (int a = 0; a < N; ++a) u.col(a) = field.segment<3>(3 * mesh_->tets[tet][a]);
  return u;
}

template <int N>
using Gradients = Eigen::Map<const Eigen::Matrix<double, 3, N>>;

template <int N>
BodyAssembly::Point BodyAssembly::point(std::size_t tet, int q,
                                        const Eigen::Matrix<double, 3, N>& u) const {
  const std::size_t at = static_cast<std::size_t>(first_point_[tet]) + static_cast<std::size_t>(q);
  const Gradients<N> G(gradient_.data() + at * 3 * N);
  Point p;
  p.weight = weight_[at];
  p.small = laws_[law_[tet]]->small_strain();
  const Eigen::Matrix3d H = u * G.transpose();
  if (p.small) {
    p.F.setIdentity();
    p.C = Eigen::Matrix3d::Identity() + H + H.transpose();
    p.theta = 1 + H.trace();
    p.cofactor.setIdentity();
    return p;
  }
  p.F = Eigen::Matrix3d::Identity() + H;
  p.C.noalias() = p.F.transpose() * p.F;
  p.cofactor.col(0) = p.F.col(1).cross(p.F.col(2));
  p.cofactor.col(1) = p.F.col(2).cross(p.F.col(0));
  p.cofactor.col(2) = p.F.col(0).cross(p.F.col(1));
  p.theta = p.F.col(0).dot(p.cofactor.col(0));
  return p;
}

inline Eigen::Matrix3d to_matrix(const Voigt& v) {
  Eigen::Matrix3d m;
  m << v[0], v[3], v[5], v[3], v[1], v[4], v[5], v[4], v[2];
  return m;
}

}  // namespace hapsim
