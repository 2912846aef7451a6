#include "simulate/regional_relaxation.h"

#include <algorithm>

namespace hapsim {

std::vector<PositionStiffness> regional_stiffness(const std::vector<RegionRelaxation>& regions,
                                                  const MaterialSpec& material,
                                                  const SolveMaterial& solve, double& misfit) {
  const RelaxationSpectrum spectrum(regions);
  Eigen::MatrixXd values;  // samples x 9 positions
  for (std::size_t k = 0; k < spectrum.moduli().size(); ++k) {
    MaterialSpec sample = material;
    sample.modulus = spectrum.moduli()[k];
    const std::vector<Eigen::Matrix3d> K = solve(sample);
    if (k == 0)
      values.resize(static_cast<Eigen::Index>(spectrum.moduli().size()),
                    9 * static_cast<Eigen::Index>(K.size()));
    for (std::size_t p = 0; p < K.size(); ++p)
      values.block<1, 9>(static_cast<Eigen::Index>(k), 9 * static_cast<Eigen::Index>(p)) =
          K[p].reshaped().transpose();
  }
  const Eigen::MatrixXd parts = spectrum.parts(values);
  std::vector<PositionStiffness> result(static_cast<std::size_t>(values.cols()) / 9);
  misfit = 0;
  for (std::size_t p = 0; p < result.size(); ++p) {
    const auto column = 9 * static_cast<Eigen::Index>(p);
    result[p].K = values.block<1, 9>(0, column).reshaped(3, 3);
    for (std::size_t j = 0; j < spectrum.times().size(); ++j)
      result[p].relaxing.push_back(
          {parts.block<1, 9>(static_cast<Eigen::Index>(j), column).reshaped(3, 3),
           spectrum.times()[j]});
    for (const Eigen::Index diagonal : {0, 4, 8})
      misfit = std::max(
          misfit, spectrum.misfit(values.col(column + diagonal), parts.col(column + diagonal)));
  }
  return result;
}

}  // namespace hapsim
