#include "solid/affine_sweep.h"

#include <Eigen/Dense>
#include <cassert>
#include <utility>

#include "base/error.h"

namespace hapsim {
namespace {

// What is left of a new direction beside those there were, as a share of its energy, below which it
// is rounding.
constexpr double kGone = 1e-14;

// Columns that bring a gram matrix to the identity; zero in place of those that are gone.
Eigen::Matrix3d normalising(const Eigen::Matrix3d& gram, double least) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> of(gram);
  const Eigen::Array3d energy = of.eigenvalues();
  const Eigen::Array3d scale =
      (energy > least).select(energy.max(least).sqrt().inverse(), Eigen::Array3d::Zero());
  return of.eigenvectors() * scale.matrix().asDiagonal();
}

}  // namespace

AffineSweep::AffineSweep(const ElasticBody& body, const Eigen::Matrix3d& stiffness,
                         const Fields& field, const std::function<Fields(const Fields&)>& part,
                         const std::vector<double>& judged)
    : stiffness_(stiffness) {
  assert(body.handles() == 1);
  constexpr int kMostSteps = 40;
  constexpr double kEnough = 1e-6;
  const Fields start = part(field);
  part_ = field.transpose() * start;
  const auto stiffnesses = [&] {
    std::vector<Eigen::Matrix3d> K;
    for (const double s : judged) K.push_back(at(s).K);
    return K;
  };
  std::vector<Fields> basis, forces, parts;  // `forces`: A_0 of the basis; `parts`: A_1 of it
  std::vector<Eigen::Matrix3d> before = stiffnesses();
  bool settled = judged.empty();
  for (int step = 0; !settled && step < kMostSteps; ++step) {
    Fields force = step == 0 ? start : parts.back();
    Fields fresh = body.relax(force);
    const double energy = fresh.cwiseProduct(force).sum();
    for (std::size_t k = 0; k < basis.size(); ++k) {
      const Eigen::Matrix3d shared = forces[k].transpose() * fresh;
      fresh.noalias() -= basis[k] * shared;
      force.noalias() -= forces[k] * shared;
    }
    const Eigen::Matrix3d gram = fresh.transpose() * force;
    const Eigen::Matrix3d unit = normalising(0.5 * (gram + gram.transpose()), kGone * energy);
    if ((unit.array() == 0).all()) return;  // the space holds no more: the solution is exact
    fresh *= unit;
    force *= unit;
    basis.push_back(std::move(fresh));
    forces.push_back(std::move(force));
    parts.push_back(part(basis.back()));

    const Eigen::Index n = coupling_.rows();
    coupling_.conservativeResize(n + 3, 3);
    coupling_.bottomRows<3>() = basis.back().transpose() * start;
    basis_part_.conservativeResize(n + 3, n + 3);
    for (std::size_t k = 0; k < basis.size(); ++k) {
      const Eigen::Index other = 3 * static_cast<Eigen::Index>(k);
      const Eigen::Matrix3d shared = basis.back().transpose() * parts[k];
      basis_part_.block<3, 3>(n, other) = shared;
      basis_part_.block<3, 3>(other, n) = shared.transpose();
    }
    std::vector<Eigen::Matrix3d> now = stiffnesses();
    settled = true;
    for (std::size_t k = 0; k < now.size(); ++k)
      settled = settled && (now[k] - before[k]).norm() < kEnough * now[k].norm();
    before = std::move(now);
  }
  if (!settled)
    fail_numerics("", "the stiffness does not settle along a range of materials",
                  "report this mesh");
}

AffineSweep::Solution AffineSweep::at(double s) const {
  Solution solution{stiffness_ + s * part_, part_};
  if (coupling_.rows() == 0) return solution;
  Eigen::MatrixXd reduced = s * basis_part_;
  reduced.diagonal().array() += 1;
  const Fields c = reduced.llt().solve(-s * coupling_);
  const Eigen::Matrix3d mixed = coupling_.transpose() * c;
  solution.K += s * mixed;
  solution.by_s += mixed + mixed.transpose() + c.transpose() * basis_part_ * c;
  return solution;
}

}  // namespace hapsim
