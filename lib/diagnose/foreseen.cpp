#include "diagnose/foreseen.h"

#include <Eigen/Dense>
#include <algorithm>

namespace hapsim {

double foreseen_squares(const Eigen::VectorXd& residual, const std::vector<Eigen::Index>& lengths) {
  constexpr Eigen::Index kOrder = 8;
  using Normal = Eigen::Matrix<double, kOrder, kOrder>;
  Normal H = Normal::Zero();
  Eigen::Matrix<double, kOrder, 1> b = Eigen::Matrix<double, kOrder, 1>::Zero();
  double squares = 0, count = 0;
  Eigen::Index at = 0;
  for (const Eigen::Index n : lengths) {
    for (Eigen::Index i = kOrder; n > 2 * kOrder && i < n; ++i)
      for (Eigen::Index k = 0; k < 3; ++k) {
        Eigen::Matrix<double, kOrder, 1> past;
        for (Eigen::Index lag = 1; lag <= kOrder; ++lag)
          past[lag - 1] = residual[3 * (at + i - lag) + k];
        const double now = residual[3 * (at + i) + k];
        H += past * past.transpose();
        b += now * past;
        squares += now * now;
        ++count;
      }
    at += n;
  }
  if (!(squares > 0)) return 0;
  H.diagonal().array() += 1e-9 * H.trace() / kOrder;
  const double taken = b.dot(H.ldlt().solve(b));
  const double by_chance = kOrder * (squares - taken) / count;
  // The first samples of each stretch, which nothing comes before, as the others.
  return std::max(0.0, taken - by_chance) * residual.squaredNorm() / squares;
}

}  // namespace hapsim
