#include "diagnose/unseen_share.h"

#include <Eigen/Dense>
#include <array>

namespace hapsim {
namespace {

constexpr int kParts = 3;

struct Normal {
  Eigen::MatrixXd H;
  Eigen::VectorXd b;
  double squares = 0;
  explicit Normal(Eigen::Index columns)
      : H(Eigen::MatrixXd::Zero(columns, columns)), b(Eigen::VectorXd::Zero(columns)) {}
};

}  // namespace

std::vector<int> press_parts(const Dataset& dataset) {
  std::vector<int> pressed(dataset.positions.size(), 0), parts;
  for (const Episode& e : dataset.episodes) {
    const int part = (e.position + pressed[static_cast<std::size_t>(e.position)]++) % kParts;
    parts.insert(parts.end(), e.rows.size(), part);
  }
  return parts;
}

double unforetold_squares(const Eigen::MatrixXd& columns, const Eigen::VectorXd& residual,
                          const std::vector<int>& parts, double ridge) {
  std::array<Normal, kParts> part{Normal(columns.cols()), Normal(columns.cols()),
                                  Normal(columns.cols())};
  for (int k = 0; k < kParts; ++k) {
    std::vector<Eigen::Index> rows;
    for (std::size_t i = 0; i < parts.size(); ++i)
      for (Eigen::Index c = 0; c < 3 && parts[i] == k; ++c)
        rows.push_back(3 * static_cast<Eigen::Index>(i) + c);
    const Eigen::MatrixXd X = columns(rows, Eigen::all);
    const Eigen::VectorXd y = residual(rows);
    Normal& normal = part[static_cast<std::size_t>(k)];
    normal.H.selfadjointView<Eigen::Lower>().rankUpdate(X.transpose());
    normal.H.triangularView<Eigen::StrictlyUpper>() = normal.H.transpose();
    normal.b = X.transpose() * y;
    normal.squares = y.squaredNorm();
  }
  Eigen::VectorXd shrink = Eigen::VectorXd::Zero(columns.cols());
  for (const Normal& each : part) shrink += ridge * each.H.diagonal();
  if (!(shrink.sum() > 0)) return residual.squaredNorm();
  shrink.array() += 1e-12 * shrink.sum();
  double left = 0;
  for (const Normal& held_out : part) {
    Eigen::MatrixXd H = -held_out.H;
    Eigen::VectorXd b = -held_out.b;
    for (const Normal& each : part) H += each.H, b += each.b;
    H.diagonal() += shrink;
    const Eigen::VectorXd w = H.ldlt().solve(b);
    left += held_out.squares - 2 * w.dot(held_out.b) + w.dot(held_out.H * w);
  }
  return left;
}

}  // namespace hapsim
