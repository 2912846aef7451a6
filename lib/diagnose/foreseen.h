// What a linear forecast takes off a residual: whatever has a memory, of any shape.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace hapsim {

// A linear forecast of samples by those before each, the same for all components.
struct Forecast {
  Eigen::VectorXd by;  // by the last sample, the one before it, ...
  double share = 0;    // of the squares that it takes off
  double count = 0;    // of components that were foretold
};
// By least squares; of stretches of `lengths` samples one after the other. Those of no more than
// twice `order` say nothing.
Forecast forecast(const Eigen::VectorXd& residual, const std::vector<Eigen::Index>& lengths,
                  Eigen::Index order);

// Squares of stretches of samples one after the other (three components a sample, the same law for
// all) that the eight samples before each foretell, by least squares (autoregression: Yule,
// Phil. Trans. A 226, 1927), less what as many coefficients take of white noise. Neighbours that
// err alike are foreseen, and so are a hum that is sampled at a few points a period and samples
// that err in turns, whose neighbours do not. `lengths` of the stretches, in samples; those of
// fewer than seventeen say nothing. At least 0.
double foreseen_squares(const Eigen::VectorXd& residual, const std::vector<Eigen::Index>& lengths);

}  // namespace hapsim
