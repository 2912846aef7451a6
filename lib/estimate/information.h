// What residuals say for one model against another, where neighbouring samples err together.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace hapsim {

// Residuals of stretches of samples one after the other, three components a sample: samples per
// independent one, 1 + 2 x the sum of the autocorrelations within the stretches up to where they
// fade (integrated autocorrelation time: Sokal, 1989). `lengths` of the stretches, in samples.
double autocorrelation_time(const Eigen::VectorXd& residual,
                            const std::vector<Eigen::Index>& lengths);
// Independent values in residuals of that time: as many fewer as the misfit stands in some of the
// components alone.
double independent_samples(const Eigen::VectorXd& residual, double memory);

// Chi-square plus log n a parameter (Schwarz, Annals of Statistics 6, 1978), n being the
// independent samples (quasi-likelihood: Wedderburn, Biometrika 61, 1974). The less the better; ten
// less is strong evidence.
double information_criterion(double chi_square, double memory, double independent,
                             std::size_t parameters);

}  // namespace hapsim
