// The laws' stresses, and what they change by and do work by along given fields.
#include "nonlinear/body_point.h"

namespace hapsim {

using Eigen::Index;
using Eigen::Matrix3d;

namespace {

// Of a symmetric strain, shears doubled.
Voigt doubled(const Matrix3d& symmetric) {
  Voigt e = to_voigt(symmetric);
  e.tail<3>() *= 2;
  return e;
}

}  // namespace

Eigen::VectorXd PointStresses::numbers() const {
  const auto points = static_cast<Index>(S.size());
  Eigen::VectorXd all(6 * points + static_cast<Index>(pressure.size()));
  for (Index i = 0; i < points; ++i) all.segment<6>(6 * i) = S[static_cast<std::size_t>(i)];
  for (std::size_t g = 0; g < pressure.size(); ++g)
    all[6 * points + static_cast<Index>(g)] = pressure[g];
  return all;
}

template <int N>
void BodyAssembly::response_pass(const Eigen::MatrixXd& fields, const StressPart& part,
                                 StressResponse& r) const {
  const std::size_t tets = mesh_->tets.size(), first = tets * part.index / part.count,
                    last = tets * (part.index + 1) / part.count;
  const bool groups = part.index + 1 == part.count;
  const Index m = fields.cols(), from = 6 * static_cast<Index>(first_point_[first]),
              first_group = 6 * static_cast<Index>(first_point_[last]) - from;
  const Index n = first_group + (groups ? static_cast<Index>(groups_.size()) : 0);
  r.stress.setZero(n);
  r.strain.setZero(n);
  r.changes.setZero(n, m);
  r.work.setZero(n, m);
  for (std::size_t t = groups ? 0 : first; t < last; ++t) {
    const auto u = gather<N>(u_, t);
    for (int q = 0; q < points(t); ++q) {
      const Point p = point<N>(t, q, u);
      const Gradients<N> G(gradient_.data() + (first_point_[t] + q) * 3 * N);
      if (groups)
        for (Index j = 0; j < m; ++j) {
          const Matrix3d H = gather<N>(fields.col(j), t) * G.transpose();
          r.work(first_group + group(t, q), j) += p.weight * p.cofactor.cwiseProduct(H).sum();
        }
      if (t < first) continue;
      const PointResponse law = laws_[law_[t]]->respond(p.C, true);
      const Index at = 6 * (first_point_[t] + q) - from;
      r.stress.segment<6>(at) = scale_[t] * law.S;
      r.strain.segment<6>(at) = p.weight * doubled(0.5 * (p.C - Matrix3d::Identity()));
      for (Index j = 0; j < m; ++j) {
        const Matrix3d H = gather<N>(fields.col(j), t) * G.transpose();
        const Matrix3d FH = p.F.transpose() * H;
        const Voigt e = doubled(0.5 * (FH + FH.transpose()));
        r.changes.block<6, 1>(at, j) = scale_[t] * law.D * e;
        r.work.block<6, 1>(at, j) = p.weight * e;
      }
    }
  }
  for (std::size_t i = 0; groups && i < groups_.size(); ++i) {
    const Group& g = groups_[i];
    const VolumeResponse v = laws_[g.law]->volume(g.theta);
    const Index at = first_group + static_cast<Index>(i);
    r.stress[at] = g.weight / g.volume * v.first;
    r.strain[at] = g.volume * (g.theta - 1);
    r.changes.row(at) = g.weight / (g.volume * g.volume) * v.second * r.work.row(at);
  }
}

template <int N>
void BodyAssembly::load_pass(const Eigen::VectorXd& stress, const Eigen::VectorXd& displacement,
                             Eigen::VectorXd& force) const {
  const Index first_group = 6 * static_cast<Index>(weight_.size());
  for (std::size_t t = 0; t < mesh_->tets.size(); ++t) {
    const auto u = gather<N>(displacement, t);
    Eigen::Matrix<double, 3, N> r = Eigen::Matrix<double, 3, N>::Zero();
    for (int q = 0; q < points(t); ++q) {
      const Point p = point<N>(t, q, u);
      const Voigt S = stress.segment<6>(6 * (first_point_[t] + q));
      const Matrix3d P = p.F * to_matrix(S) + stress[first_group + group(t, q)] * p.cofactor;
      r.noalias() += p.weight * P * Gradients<N>(gradient_.data() + (first_point_[t] + q) * 3 * N);
    }
    for (int a = 0; a < N; ++a) force.segment<3>(3 * mesh_->tets[t][a]) += r.col(a);
  }
}

Eigen::VectorXd BodyAssembly::forces_of(const Eigen::VectorXd& stress,
                                        const Eigen::VectorXd& u) const {
  Eigen::VectorXd force = Eigen::VectorXd::Zero(u.size());
  if (nodes_ == 4)
    load_pass<4>(stress, u, force);
  else
    load_pass<10>(stress, u, force);
  return force;
}

StressResponse BodyAssembly::stress_response(const Eigen::MatrixXd& fields,
                                             const StressPart& part) const {
  StressResponse result;
  if (nodes_ == 4)
    response_pass<4>(fields, part, result);
  else
    response_pass<10>(fields, part, result);
  return result;
}

}  // namespace hapsim
