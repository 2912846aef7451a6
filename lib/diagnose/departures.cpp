#include "diagnose/departures.h"

#include <Eigen/Dense>
#include <cmath>

#include "base/median.h"

namespace hapsim {

bool Departures::anywhere() const {
  return total > freedom + 3 * std::sqrt(2 * freedom);
}

bool Departures::at_one() const {
  constexpr double kRare = 45;   // chi-square of six degrees, 5e-8
  constexpr double kUnlike = 5;  // a model that errs a little everywhere departs everywhere
  return largest > kRare && largest > kUnlike * typical;
}

Departures stiffness_departures(const Model& model, const Workspace& w) {
  const Selection all = all_episodes(w.dataset);
  const Eigen::VectorXd f = model_forces(model, w.dataset, all, *w.body, false).f;
  Eigen::VectorXd residual = measured_forces(w.dataset, all) - f;
  Weights(w.dataset, all, f, w.noise.value, w.floor).whiten(residual);
  Departures d;
  std::vector<double> squares;
  const std::vector<GainBlock> blocks = gain_directions(w.dataset, all, f);
  for (std::size_t p = 0; p < blocks.size(); ++p) {
    // The weights map the span of these directions on itself.
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(blocks[p].Z);
    const Eigen::VectorXd r = qr.householderQ().transpose() * residual(blocks[p].rows);
    const double square = r.head(qr.rank()).squaredNorm();
    d.total += square;
    squares.push_back(square);
    d.freedom += static_cast<double>(qr.rank());
    if (square <= d.largest) continue;
    d.largest = square;
    d.where = w.dataset.positions[static_cast<std::size_t>(blocks[p].position)];
  }
  d.typical = upper_median(std::move(squares));
  return d;
}

}  // namespace hapsim
