#include "estimate/sign_flip.h"

#include <Eigen/Dense>
#include <algorithm>
#include <limits>

namespace hapsim {

std::vector<double> sign_flip_p_values(const std::vector<CandidateScores>& candidates, int flips,
                                       Random& random) {
  if (candidates.empty()) return {};
  const Eigen::Index groups = candidates.front().by_group.cols();
  std::vector<Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>> inverse;
  inverse.reserve(candidates.size());
  for (const auto& c : candidates) inverse.emplace_back(c.information);
  const auto gain = [&](std::size_t c, const Eigen::VectorXd& signs) {
    const Eigen::VectorXd s = candidates[c].by_group * signs;
    return s.dot(inverse[c].solve(s)) - candidates[c].penalty;
  };
  std::vector<double> observed(candidates.size());
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(groups);
  for (std::size_t c = 0; c < candidates.size(); ++c) observed[c] = gain(c, ones);
  std::vector<int> reached(candidates.size(), 0);
  Eigen::VectorXd signs(groups);
  for (int flip = 0; flip < flips; ++flip) {
    for (Eigen::Index g = 0; g < groups; ++g) signs[g] = random.coin() ? 1 : -1;
    double best = -std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < candidates.size(); ++c) best = std::max(best, gain(c, signs));
    for (std::size_t c = 0; c < candidates.size(); ++c) reached[c] += best >= observed[c];
  }
  std::vector<double> p(candidates.size());
  for (std::size_t c = 0; c < candidates.size(); ++c)
    p[c] = (1.0 + reached[c]) / (1.0 + flips);  // the observed arrangement counts as one flip
  return p;
}

}  // namespace hapsim
