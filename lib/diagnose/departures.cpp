#include "diagnose/departures.h"

#include <Eigen/Dense>
#include <cmath>

namespace hapsim {

bool Departures::anywhere() const {
  return total > freedom + 3 * std::sqrt(2 * freedom);
}

Departures stiffness_departures(const Fit& fitted, const TrialGround& g) {
  const Selection all = all_episodes(g.dataset);
  const Eigen::VectorXd f = model_forces(fitted, g.experiment, all, false).f;
  Eigen::VectorXd residual = measured_forces(g.dataset, all) - f;
  Weights(g.dataset, all, f, g.allowance.noise, g.allowance.floor).whiten(residual);
  Departures d;
  const std::vector<GainBlock> blocks = gain_directions(g.dataset, all, f);
  for (std::size_t p = 0; p < blocks.size(); ++p) {
    // The weights map the span of these directions on itself.
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(blocks[p].Z);
    const Eigen::VectorXd r = qr.householderQ().transpose() * residual(blocks[p].rows);
    const double square = r.head(qr.rank()).squaredNorm();
    d.total += square;
    d.freedom += static_cast<double>(qr.rank());
    if (square <= d.largest) continue;
    d.largest = square;
    d.where = g.dataset.positions[static_cast<std::size_t>(blocks[p].position)];
  }
  return d;
}

}  // namespace hapsim
