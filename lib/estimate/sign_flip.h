// A test that needs no noise model beyond symmetry: flip the signs of whole presses.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/random.h"

namespace hapsim {

// Score vectors of one candidate: column g is the contribution J_g' r_g of group g (a press) to the
// whitened, projected gradient, and `information` is J'J (m x m) over all groups.
struct CandidateScores {
  Eigen::MatrixXd by_group;     // m x groups
  Eigen::MatrixXd information;  // m x m
  double penalty = 0;           // taken from the gain, e.g. m log n
};

// Under the hypothesis that nothing is missing, each group's scores are as likely with either sign.
// For every candidate the chance that the best penalised gain s'(J'J)^-1 s - penalty over ALL
// candidates, with random signs, reaches its own: family-wise by construction (Westfall and Young,
// 1993). Cost: flips x candidates x m^2.
std::vector<double> sign_flip_p_values(const std::vector<CandidateScores>& candidates, int flips,
                                       Random& random);

}  // namespace hapsim
