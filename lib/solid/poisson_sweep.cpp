#include "solid/poisson_sweep.h"

#include <cmath>

namespace hapsim {
namespace {

using Fields = AffineSweep::Fields;

// lambda / mu.
double ratio_of(double nu) {
  return 2 * nu / (1 - 2 * nu);
}

// The mean divergence of each element times the root of its volume, of fields of displacements:
// D' D is the volumetric part.
class MeanDivergence {
 public:
  explicit MeanDivergence(const TetMesh& mesh) : mesh_(mesh), gradient_(mesh.tets.size()) {
    for (std::size_t t = 0; t < gradient_.size(); ++t) {
      const ElementGradients element = element_gradients(mesh, t);
      gradient_[t].setZero();
      double volume = 0;
      for (int q = 0; q < element.points; ++q) {
        volume += element.weight[q];
        gradient_[t] += element.weight[q] * element.gradient[q];
      }
      gradient_[t] /= std::sqrt(volume);
    }
    nodes_ = mesh.order == 1 ? 4 : 10;
  }

  // D' D of fields.
  Fields forces(const Fields& fields) const {
    Fields result = Fields::Zero(fields.rows(), 3);
    for (std::size_t t = 0; t < gradient_.size(); ++t) {
      Eigen::RowVector3d divergence = Eigen::RowVector3d::Zero();
      for (int a = 0; a < nodes_; ++a)
        divergence.noalias() += gradient_[t].col(a).transpose() * fields.middleRows<3>(first(t, a));
      for (int a = 0; a < nodes_; ++a)
        result.middleRows<3>(first(t, a)).noalias() += gradient_[t].col(a) * divergence;
    }
    return result;
  }

 private:
  Eigen::Index first(std::size_t tet, int a) const {
    return 3 * static_cast<Eigen::Index>(mesh_.tets[tet][static_cast<std::size_t>(a)]);
  }

  const TetMesh& mesh_;
  std::vector<Eigen::Matrix<double, 3, 10>> gradient_;
  int nodes_ = 0;
};

AffineSweep by_kappa(const TetMesh& mesh, ElasticBody& body, double kappa,
                     const std::vector<double>& nus, Fields& field) {
  body.factorise(std::vector<Lame>(mesh.tets.size(), {kappa, 1}));
  const ElasticBody::Response there = body.solve(Eigen::Matrix3d::Identity());
  field = there.field;
  const MeanDivergence divergence(mesh);
  std::vector<double> judged;
  if (nus.size() > 1) judged = {ratio_of(nus.front()) - kappa, ratio_of(nus.back()) - kappa};
  return {body, there.reaction, field,
          [&](const Fields& fields) { return divergence.forces(fields); }, judged};
}

}  // namespace

PoissonSweep::PoissonSweep(const TetMesh& mesh, ElasticBody& body, const std::vector<double>& nus)
    : kappa_(ratio_of(nus[nus.size() / 2])), sweep_(by_kappa(mesh, body, kappa_, nus, field_)) {}

PoissonSweep::Solution PoissonSweep::at(double nu) const {
  const AffineSweep::Solution over_mu = sweep_.at(ratio_of(nu) - kappa_);
  const double mu = lame(1, nu).mu, mu_by_nu = lame_by_poisson(1, nu).mu;
  const double kappa_by_nu = 2 / std::pow(1 - 2 * nu, 2);
  return {mu * over_mu.K, mu_by_nu * over_mu.K + mu * kappa_by_nu * over_mu.by_s};
}

}  // namespace hapsim
