#include "estimate/sign_flip.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace hapsim {
namespace {

std::vector<CandidateScores> draw(Random& random, double effect) {
  std::vector<CandidateScores> candidates;
  for (int c = 0; c < 5; ++c) {
    CandidateScores s;
    s.by_group.resize(2, 30);
    for (Eigen::Index g = 0; g < 30; ++g)
      for (int k = 0; k < 2; ++k)
        s.by_group(k, g) = random.normal() + (c == 0 && k == 0 ? effect : 0.0);
    s.information = 30 * Eigen::MatrixXd::Identity(2, 2);
    s.penalty = 2;
    candidates.push_back(s);
  }
  return candidates;
}

TEST(SignFlip, FamilyWiseErrorIsKept) {
  Random random(5);
  int alarms = 0;
  const int trials = 300;
  for (int t = 0; t < trials; ++t) {
    const auto p = sign_flip_p_values(draw(random, 0), 199, random);
    alarms += *std::min_element(p.begin(), p.end()) < 0.05;
  }
  EXPECT_LT(alarms, 0.09 * trials);  // 5 % and three standard errors
}

TEST(SignFlip, SeesARealEffect) {
  Random random(6);
  const auto p = sign_flip_p_values(draw(random, 1.5), 499, random);
  EXPECT_LT(p[0], 0.01);
  EXPECT_GT(p[1], 0.05);
}

}  // namespace
}  // namespace hapsim
