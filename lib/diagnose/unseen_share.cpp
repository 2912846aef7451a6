#include "diagnose/unseen_share.h"

#include <Eigen/Dense>
#include <limits>

namespace hapsim {
namespace {

constexpr int kParts = 3;
constexpr double kRidges[] = {1e-4, 1e-2, 1};  // of a column's squares in all parts
constexpr double kNone = 1e-16;                // of all columns' squares: of those of zeros

struct Part {
  std::vector<Eigen::Index> rows;
  Eigen::MatrixXd X;
  Eigen::VectorXd y;
  Eigen::MatrixXd H;
  Eigen::VectorXd b;
};

Part part_of(int which, const Eigen::MatrixXd& columns, const Eigen::VectorXd& residual,
             const std::vector<int>& parts) {
  Part part;
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (Eigen::Index c = 0; c < 3 && parts[i] == which; ++c)
      part.rows.push_back(3 * static_cast<Eigen::Index>(i) + c);
  part.X = columns(part.rows, Eigen::all);
  part.y = residual(part.rows);
  part.H = Eigen::MatrixXd::Zero(columns.cols(), columns.cols());
  part.H.selfadjointView<Eigen::Lower>().rankUpdate(part.X.transpose());
  part.H.triangularView<Eigen::StrictlyUpper>() = part.H.transpose();
  part.b = part.X.transpose() * part.y;
  return part;
}

Eigen::VectorXd by_sample(const Eigen::VectorXd& residual) {
  return residual.reshaped(3, residual.size() / 3).colwise().squaredNorm();
}

}  // namespace

std::vector<int> press_parts(const Dataset& dataset) {
  std::vector<int> pressed(dataset.positions.size(), 0), parts;
  for (const Episode& e : dataset.episodes) {
    const int part = (e.position + pressed[static_cast<std::size_t>(e.position)]++) % kParts;
    parts.insert(parts.end(), e.rows.size(), part);
  }
  return parts;
}

Eigen::VectorXd unforetold_squares(const Eigen::MatrixXd& columns, const Eigen::VectorXd& residual,
                                   const std::vector<int>& parts) {
  std::vector<Part> each;
  for (int k = 0; k < kParts; ++k) each.push_back(part_of(k, columns, residual, parts));
  const Eigen::MatrixXd H = each[0].H + each[1].H + each[2].H;
  const Eigen::VectorXd b = each[0].b + each[1].b + each[2].b;
  Eigen::VectorXd best = by_sample(residual);
  if (!(H.trace() > 0)) return best;
  double least = std::numeric_limits<double>::infinity();
  for (const double ridge : kRidges) {
    Eigen::VectorXd left = residual;
    for (const Part& held_out : each) {
      Eigen::MatrixXd others = H - held_out.H;
      others.diagonal() += ridge * H.diagonal();
      others.diagonal().array() += kNone * H.trace();
      left(held_out.rows) -= held_out.X * others.ldlt().solve(b - held_out.b);
    }
    if (left.squaredNorm() >= least) continue;
    least = left.squaredNorm();
    best = by_sample(left);
  }
  return best;
}

}  // namespace hapsim
