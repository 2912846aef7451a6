// Derivatives of the forces by the material, the foundation and the elements' factors.
#include "nonlinear/body_point.h"

namespace hapsim {

using Eigen::Index;
using Eigen::Matrix3d;

template <int N>
BodyAssembly::Derivatives BodyAssembly::derivative_pass(const Eigen::MatrixXd& fields,
                                                        bool by_scale) const {
  const Index m = fields.cols();
  Derivatives d;
  for (const LawPointer& law : laws_)
    d.constants.push_back(
        Eigen::MatrixXd::Zero(m, law ? static_cast<Index>(law->constants().size()) : 0));
  if (by_scale) d.scale = Eigen::MatrixXd::Zero(m, static_cast<Index>(mesh_->tets.size()));
  Eigen::MatrixXd change =
      Eigen::MatrixXd::Zero(m, static_cast<Index>(groups_.size()));  // b.phi of each group
  for (std::size_t t = 0; t < mesh_->tets.size(); ++t) {
    const auto u = gather<N>(u_, t);
    Eigen::MatrixXd phi(3 * N, m);
    for (int a = 0; a < N; ++a)
      phi.middleRows(3 * a, 3) = fields.middleRows(3 * mesh_->tets[t][a], 3);
    for (int q = 0; q < points(t); ++q) {
      const Point p = point<N>(t, q, u);
      const Gradients<N> G(gradient_.data() + (first_point_[t] + q) * 3 * N);
      const std::vector<Voigt> S_by = laws_[law_[t]]->stress_by_constants(p.C);
      const Voigt S = by_scale ? laws_[law_[t]]->respond(p.C, false).S : Voigt::Zero();
      for (Index j = 0; j < m; ++j) {
        const Eigen::Map<const Eigen::Matrix<double, 3, N>> field(phi.data() + 3 * N * j);
        const Matrix3d H = field * G.transpose();
        const Matrix3d FH = p.F.transpose() * H;
        Voigt e = to_voigt(0.5 * (FH + FH.transpose()));
        e.tail<3>() *= 2;
        for (std::size_t k = 0; k < S_by.size(); ++k)
          d.constants[law_[t]](j, static_cast<Index>(k)) += p.weight * scale_[t] * S_by[k].dot(e);
        if (by_scale) d.scale(j, static_cast<Index>(t)) += p.weight * S.dot(e);
        change(j, group(t, q)) += p.weight * p.cofactor.cwiseProduct(H).sum();
      }
    }
  }
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    const Group& g = groups_[i];
    const std::vector<double> p_by = laws_[g.law]->pressure_by_constants(g.theta);
    for (std::size_t k = 0; k < p_by.size(); ++k)
      d.constants[g.law].col(static_cast<Index>(k)) +=
          g.weight / g.volume * p_by[k] * change.col(static_cast<Index>(i));
  }
  for (std::size_t t = 0; by_scale && t < mesh_->tets.size(); ++t)
    for (int q = 0; q < points(t); ++q) {
      const Group& g = groups_[group(t, q)];
      d.scale.col(static_cast<Index>(t)) += weight_[first_point_[t] + q] / g.volume *
                                            laws_[g.law]->volume(g.theta).first *
                                            change.col(group(t, q));
    }
  d.foundation = Eigen::MatrixXd::Zero(m, 2);
  for (const FoundationFace& f : faces_) {
    const Index n = static_cast<Index>(f.nodes.size());
    Eigen::VectorXd u(3 * n);
    Eigen::MatrixXd phi(3 * n, m);
    for (Index a = 0; a < n; ++a) {
      u.segment<3>(3 * a) = u_.segment<3>(3 * f.nodes[a]);
      phi.middleRows(3 * a, 3) = fields.middleRows(3 * f.nodes[a], 3);
    }
    d.foundation.col(0) += phi.transpose() * (f.by_normal * u);
    d.foundation.col(1) += phi.transpose() * (f.by_tangential * u);
  }
  return d;
}

BodyAssembly::Derivatives BodyAssembly::derivatives(const Eigen::MatrixXd& fields,
                                                    bool by_scale) const {
  return nodes_ == 4 ? derivative_pass<4>(fields, by_scale) : derivative_pass<10>(fields, by_scale);
}

}  // namespace hapsim
