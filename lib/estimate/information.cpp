#include "estimate/information.h"

#include <algorithm>
#include <cmath>

namespace hapsim {

double autocorrelation_time(const Eigen::VectorXd& residual,
                            const std::vector<Eigen::Index>& lengths) {
  constexpr Eigen::Index kMost = 400;
  constexpr double kFaded = 0.05;  // what white noise of 400 samples has by chance (1/20)
  const double square = residual.squaredNorm();
  double time = 1;
  for (Eigen::Index lag = 1; lag < kMost && square > 0; ++lag) {
    double product = 0;
    Eigen::Index at = 0;
    for (const Eigen::Index n : lengths) {
      if (n > lag)
        product += residual.segment(3 * (at + lag), 3 * (n - lag))
                       .dot(residual.segment(3 * at, 3 * (n - lag)));
      at += n;
    }
    if (product < kFaded * square) break;
    time += 2 * product / square;
  }
  return time;
}

double independent_samples(const Eigen::VectorXd& residual, double memory) {
  const Eigen::Map<const Eigen::Matrix3Xd> r(residual.data(), 3, residual.size() / 3);
  const Eigen::Array3d power = r.array().square().rowwise().sum();
  const double squares = power.square().sum();
  const double components = squares > 0 ? power.sum() * power.sum() / squares : 3;
  return components * static_cast<double>(residual.size() / 3) / memory;
}

double information_criterion(double chi_square, double memory, double independent,
                             std::size_t parameters) {
  return chi_square / memory +
         static_cast<double>(parameters) * std::log(std::max(independent, 2.0));
}

}  // namespace hapsim
