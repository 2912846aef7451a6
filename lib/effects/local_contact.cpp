#include "effects/local_contact.h"

#include <Eigen/Dense>
#include <cmath>

#include "base/error.h"

namespace hapsim {
namespace {

// A far field may be stiffer than the half-space's by this factor: with less a body's modulus and
// Poisson's ratio would be drawn away, with more a law that stiffens tenfold has no equilibrium.
constexpr double kStiffer = 1.1;

}  // namespace

DiscStiffness bonded_disc(double modulus, double nu, double radius) {
  // 4 mu a log(3 - 4 nu)/(1 - 2 nu), with e = 1 - 2 nu so that nothing cancels near nu = 1/2.
  const double e = 1 - 2 * nu;
  const double ratio = e > 0 ? std::log1p(2 * e) / e : 2;
  const double ratio_by_e = e > 1e-8 ? (2 / (1 + 2 * e) - ratio) / e : -2;
  const double mu4a = 2 * modulus * radius / (1 + nu);
  DiscStiffness disc;
  disc.normal = mu4a * ratio;
  disc.normal_by_nu = -disc.normal / (1 + nu) - 2 * mu4a * ratio_by_e;
  disc.tangential = 2 * mu4a / (2 - nu);
  disc.tangential_by_nu = disc.tangential * (1 / (2 - nu) - 1 / (1 + nu));
  return disc;
}

LocalContact::LocalContact(const ContactStiffness& contact, const Vec3& normal, double radius,
                           bool stiff)
    : contact_(contact),
      normal_(normal),
      disc_(bonded_disc(contact_.modulus, contact_.nu, radius)),
      along_(normal_ * normal_.transpose()),
      across_(Eigen::Matrix3d::Identity() - along_) {
  if (stiff) {
    // The largest g of K v = g C^-1 v, v' C^-1 v = 1.
    const Eigen::Matrix3d half_space = disc_.normal * along_ + disc_.tangential * across_;
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix3d> modes(
        0.5 * (contact_.K + contact_.K.transpose()), half_space);
    if (modes.eigenvalues()[2] > kStiffer) {
      gain_ = modes.eigenvalues()[2] / kStiffer;
      way_ = modes.eigenvectors().col(2);
    }
    disc_.normal *= gain_;
    disc_.tangential *= gain_;
  }
  C_ = along_ / disc_.normal + across_ / disc_.tangential;
  rest_ = Eigen::Matrix3d::Identity() - contact_.K * C_;
}

void LocalContact::no_equilibrium() {
  fail_numerics("contact law", "no equilibrium is found under the tool",
                "give the parameters of tip and hyperelastic less extreme values or bounds");
}

LocalContact::Derivatives LocalContact::derivatives(const LocalForce& force, const Vec3& u,
                                                    const Vec3& x, const Eigen::MatrixXd& du,
                                                    const Eigen::MatrixXd& explicit_dF,
                                                    const DiscByColumns& disc) const {
  const Eigen::Matrix3d& K = contact_.K;
  const Vec3 way = C_ * force.F;
  const Eigen::Matrix<double, 3, 2> by = way_by_disc(force.F);
  Eigen::MatrixXd right = -rest_ * explicit_dF;
  right.noalias() -= (K * by.col(0)) * disc.normal;
  right.noalias() -= (K * by.col(1)) * disc.tangential;
  if (du.cols() > 0) right.noalias() += K * du;
  for (const auto& [column, dK] : contact_.by_column) right.col(column) -= dK * (x - u - way);
  Derivatives d;
  d.dx.noalias() = (K + rest_ * force.tangent).inverse() * right;
  d.dF = explicit_dF;
  d.dF.noalias() += force.tangent * d.dx;
  return d;
}

Eigen::RowVectorXd LocalContact::by_columns(double of_half_space, double by_nu,
                                            Eigen::Index columns) const {
  Eigen::RowVectorXd d = Eigen::RowVectorXd::Zero(columns);
  for (const auto& [column, slope] : contact_.log_modulus_by_column)
    d[column] += gain_ * of_half_space * slope;
  if (contact_.nu_column >= 0) d[contact_.nu_column] += gain_ * by_nu;
  if (gain_ == 1) return d;
  // dg = v' (dK / kStiffer - g d(C^-1)) v; the disc's part by E is -g/E, as v' C^-1 v = 1.
  for (const auto& [column, dK] : contact_.by_column)
    d[column] += of_half_space / kStiffer * way_.dot(dK * way_);
  for (const auto& [column, slope] : contact_.log_modulus_by_column)
    d[column] -= of_half_space * gain_ * slope;
  if (contact_.nu_column >= 0)
    d[contact_.nu_column] -= of_half_space * gain_ *
                             (disc_.normal_by_nu * way_.dot(along_ * way_) +
                              disc_.tangential_by_nu * way_.dot(across_ * way_));
  return d;
}

LocalContact::DiscByColumns LocalContact::disc_by_columns(Eigen::Index columns) const {
  if (columns == 0) return {};
  return {by_columns(disc_.normal / gain_, disc_.normal_by_nu, columns),
          by_columns(disc_.tangential / gain_, disc_.tangential_by_nu, columns)};
}

Eigen::Matrix<double, 3, 2> LocalContact::way_by_disc(const Vec3& F) const {
  Eigen::Matrix<double, 3, 2> by;
  by << along_ * F / (disc_.normal * disc_.normal),
      across_ * F / (disc_.tangential * disc_.tangential);
  return by;
}

Eigen::MatrixXd LocalContact::disc_way_derivative(const Vec3& F, const Eigen::MatrixXd& dF,
                                                  const DiscByColumns& disc) const {
  const Eigen::Matrix<double, 3, 2> by = way_by_disc(F);
  Eigen::MatrixXd d = C_ * dF;
  d.noalias() -= by.col(0) * disc.normal;
  d.noalias() -= by.col(1) * disc.tangential;
  return d;
}

}  // namespace hapsim
