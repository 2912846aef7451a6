#include "imaging/ball_signal.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace hapsim {

double ball_effect(double ratio) {
  return (ratio - 1) / (1 + 0.4 * (ratio - 1));
}

Eigen::VectorXd ball_signal(const Eigen::MatrixXd& J, const FieldGrid& grid, const Vec3& centre,
                            double radius) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(J.rows());
  double volume = 0;
  const double cube = std::pow(grid.step, 3);
  std::array<int, 3> from{}, to{};
  for (int c = 0; c < 3; ++c) {
    const double at = (centre[c] - grid.low[c]) / grid.step, reach = radius / grid.step + 0.5;
    from[c] = std::max(0, static_cast<int>(std::ceil(at - reach)));
    to[c] = std::min(grid.count[c] - 1, static_cast<int>(std::floor(at + reach)));
  }
  for (int k = from[2]; k <= to[2]; ++k)
    for (int j = from[1]; j <= to[1]; ++j)
      for (int i = from[0]; i <= to[0]; ++i) {
        const std::size_t n = grid.index(i, j, k);
        const double inside = (radius - (grid.node(n) - centre).norm()) / grid.step + 0.5;
        const double share = std::clamp(inside, 0.0, 1.0);
        if (share == 0) continue;
        sum += share * J.col(static_cast<Eigen::Index>(n));
        volume += share * cube;
      }
  const double wanted = 4.0 / 3 * std::numbers::pi * std::pow(radius, 3);
  return volume > 0 ? Eigen::VectorXd(wanted / volume * sum) : sum;
}

}  // namespace hapsim
