#include "diagnose/foreseen.h"

#include <Eigen/Dense>
#include <algorithm>

namespace hapsim {

Forecast forecast(const Eigen::VectorXd& residual, const std::vector<Eigen::Index>& lengths,
                  Eigen::Index order) {
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(order, order);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(order), past(order);
  double squares = 0;
  Eigen::Index at = 0;
  Forecast result{b};
  for (const Eigen::Index n : lengths) {
    for (Eigen::Index i = order; n > 2 * order && i < n; ++i)
      for (Eigen::Index k = 0; k < 3; ++k) {
        for (Eigen::Index lag = 1; lag <= order; ++lag)
          past[lag - 1] = residual[3 * (at + i - lag) + k];
        const double now = residual[3 * (at + i) + k];
        H += past * past.transpose();
        b += now * past;
        squares += now * now;
        ++result.count;
      }
    at += n;
  }
  if (!(squares > 0)) return result;
  H.diagonal().array() += 1e-9 * H.trace() / static_cast<double>(order);
  result.by = H.ldlt().solve(b);
  result.share = b.dot(result.by) / squares;
  return result;
}

double foreseen_squares(const Eigen::VectorXd& residual, const std::vector<Eigen::Index>& lengths) {
  constexpr Eigen::Index kOrder = 8;
  const Forecast found = forecast(residual, lengths, kOrder);
  if (!(found.count > 0)) return 0;
  const double by_chance = static_cast<double>(kOrder) * (1 - found.share) / found.count;
  // The first samples of each stretch, which nothing comes before, as the others.
  return std::max(0.0, found.share - by_chance) * residual.squaredNorm();
}

}  // namespace hapsim
